#pragma once

#include <vector>

#include "tests/support/tube_metrics.h"

namespace tubetwin {

/// Which places of a true tube the views show, in bins of equal arc length.
struct SeenProfile {
  double bin_m = 0.0;
  std::vector<char> seen;  ///< [bins]
  bool At(double s_m) const;
};

/// A bin of about 5 mm is seen when it holds at least a fifth of what a bin usually holds, over all
/// tubes.
std::vector<SeenProfile> FindSeen(const std::vector<Polyline>& true_lines_N,
                                  const std::vector<TubePoint>& points);

/// Perceived crossings against those of the true curves. A true crossing between two paired tubes
/// is right when a perceived one of the same two tubes, in the same order, covers part of the same
/// run, 20 mm more or less.
/// It counts as visible when its upper tube is seen there and the lower one within four radii on
/// both sides (or ends there), as hidden otherwise. A hidden one lies on an unseen end when nothing
/// is seen of one of its tubes between it and that tube's end: no bridge leads there, the tube's
/// length and bend are all that is known.
struct CrossingScore {
  int visible = 0, visible_right = 0, visible_reversed = 0;
  int hidden = 0, hidden_right = 0, hidden_reversed = 0;
  int on_unseen_end = 0, on_unseen_end_right = 0;  ///< Of the hidden ones.
  int spurious = 0;  ///< Perceived between paired tubes, without a true one of any order near it.
};
CrossingScore ScoreCrossings(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                             const std::vector<SeenProfile>& seen, const TubeScore& pairs,
                             double radius_m);

/// Joint decisions on pairs of fragment ends. Fragments are the seen runs of the true tubes, at
/// least 15 mm long, apart by at least 10 mm; each belongs to the perceived tube that most of its
/// points are nearest to. True joints are neighbouring runs of one true tube; perceived ones are
/// neighbouring runs along one perceived tube, each with the end that faces the other.
struct JointScore {
  int truth = 0, perceived = 0, right = 0;
};
JointScore ScoreJoints(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                       const std::vector<SeenProfile>& seen);

/// Distances of found tubes' perceived curves from the true ones, every 5 mm.
struct CenterlineErrors {
  std::vector<double> seen_m, hidden_m;  ///< By whether the true place is seen.
};
CenterlineErrors MeasureErrors(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                               const std::vector<SeenProfile>& seen, const TubeScore& pairs);

}  // namespace tubetwin

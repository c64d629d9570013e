#pragma once

#include <vector>

#include "models/base/cloud/cloud.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// A point of a labelled cloud that lies on a tube. For scoring only.
struct TubePoint {
  Vector3 p_N = Vector3::Zero();
  int tube = 0;  ///< From 0, in the pile's order.
};

/// Every `stride`-th point on a tube of clouds with labels. `X_NS_true[i]` is the pose that cloud i
/// was taken from. Throws Error(kBadData) when a cloud carries no labels.
std::vector<TubePoint> TubePointsOf(const std::vector<OrganizedCloud>& clouds,
                                    const std::vector<RigidTransform>& X_NS_true, int stride);

/// Perceived tubes against true ones. Pairs are one to one, by the most shared points.
struct TubeScore {
  int true_tubes = 0;
  int predicted = 0;
  int found = 0;  ///< Pair holds >= 80 % of the true tube's points and is >= 90 % of that tube.
  double micro_recall = 1.0;         ///< Share of all tube points whose tube is the paired one.
  double centerline_median_m = 0.0;  ///< Of paired curves' distance from the true one, every mm.
  double centerline_p95_m = 0.0;
  double length_error_median_m = 0.0;
  int paired = 0;       ///< Pairs that share at least half of the true tube's points.
  int class_right = 0;  ///< Of these, class equal to that of the true curves.
  int covered_called_free = 0;
  int covered = 0;                ///< Of the paired, truly under another tube.
  std::vector<int> pair_of_true;  ///< [true_tubes] index of the perceived tube, or -1.
  std::vector<char> found_true;   ///< [true_tubes] 1 for those counted in `found`.
};

/// A visible point counts for the perceived curve nearest to it, at most 1.6 radii away.
TubeScore ScoreTubes(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                     const std::vector<TubePoint>& points, double radius_m);

/// Column of each row, or -1, of the one-to-one assignment with the largest sum (Hungarian method,
/// Kuhn 1955, with potentials). `gain[row][column]`, rows of equal length.
std::vector<int> AssignOneToOne(const std::vector<std::vector<double>>& gain);

}  // namespace tubetwin

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "models/base/polyline.h"

namespace tubetwin {

enum class TubeClass { kFree, kWeak, kStrong };
const char* ToString(TubeClass c);

/// A tube as the pipeline sees it. Frame N.
struct PerceivedTube {
  int id = 0;
  Polyline centerline_N;  ///< Nodes at most 10 mm apart, hidden parts bridged.
  double radius_m = 0.0;
  double length_m = 0.0;          ///< Of the centerline, rounded ends included.
  double visible_fraction = 0.0;  ///< Of the length.
  double confidence = 0.0;        ///< 0..1, from fit, bridges and the length prior.
  TubeClass tube_class = TubeClass::kFree;
  /// By the occluded joints of the leao2020 profile; empty in other profiles.
  std::optional<TubeClass> class_paper;
  std::vector<int> over;  ///< Ids of tubes that this one lies over, sorted, unique.
  std::vector<int> under;
  std::vector<int> hooked;         ///< Ids in both lists: each lies over the other somewhere.
  std::vector<char> node_visible;  ///< [centerline_N.size()] 1 where points were seen.
};

/// One place where tube `over` covers tube `under`.
struct Crossing {
  int over = 0, under = 0;
  double at_over_m = 0.0, at_under_m = 0.0;  ///< Arc length from the first centerline node.
  double gap_m = 0.0;                        ///< Vertical distance of axes less both radii.
  double confidence = 0.0;
  double under_from_m = 0.0, under_to_m = 0.0;  ///< The covered run, arc length of `under`.
  /// Both tubes are seen at the place, the lower one beside the run; else the crossing is inferred
  /// from bridged or completed parts.
  bool visible = true;
};

/// Whether the bin holds anything, as far as the views can say. Unseen: nothing is seen, but a tube
/// may lie where no view looked.
enum class BinContent { kEmpty, kNotEmpty, kUnseen };
const char* ToString(BinContent content);

/// Which part of the bin's floor no view covered: equal cells, row by row along x of N from the
/// corner (-half long, -half short) on.
struct UnseenFloor {
  int columns = 0, rows = 0;
  double cell_x_m = 0.0, cell_y_m = 0.0;
  std::vector<char> unseen;  ///< [rows * columns] 1 where no view saw the floor.
};

/// All that perception says about one look into the bin.
struct TubeScene {
  std::vector<PerceivedTube> tubes;
  std::vector<Crossing> crossings;
  double unseen_m3 = 0.0;  ///< Volume over the floor that no view saw into.
  double unseen_floor_m2 = 0.0;
  UnseenFloor unseen_floor;
  /// Points in the bin that belong to no tube: foreign objects, or what is left of a tube that
  /// could not be modelled. One for each cell of 5 mm that holds some.
  std::vector<Vector3> unexplained_N;
  BinContent bin_content = BinContent::kUnseen;
  std::string bin_content_reason;
  std::optional<double> radius_estimate_m;  ///< From the points alone; nothing when too few.
  std::vector<std::string> warnings;        ///< Sentences for the user, such as of a wrong part.
  struct Timing {
    double load = 0, filter = 0, segment = 0, fit = 0, join = 0, crossings = 0, total = 0;
  } timing_ms;  ///< Wall time; left out of comparisons.
  int threads = 1;
};

/// FindCrossings, from centerlines alone: a tube is under another once for each run of its samples
/// that the other covers (within r horizontally, more than r above). Used on perceived and on true
/// tubes. AssignClasses fills in the scene's crossings (`visible` and confidence from the tubes'),
/// lists of ids and classes (under others 0 times: free, once: weak, more often: strong).
std::vector<Crossing> FindCrossings(const std::vector<Polyline>& lines_N, double radius_m);
void AssignClasses(TubeScene& scene, double radius_m);

Json ToJson(const TubeScene& scene);
TubeScene TubeSceneFromJson(const JsonView& document);

}  // namespace tubetwin

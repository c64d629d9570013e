#include "planner/pick/nudge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "models/base/json.h"
#include "models/base/text.h"
#include "models/gripper_spec.h"
#include "planner/grasp/grasps.h"
#include "planner/scene_query/tube_obstacles.h"
#include "planner/scene_query/tubes.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kNear_m = 0.045;  // A wall or a tube nearer than this may block a grasp.
constexpr double kSameWay = 0.99;  // Cosine between directions that are one.
constexpr double kStep_m = 0.005;  // Between travels that are tried.
constexpr double kMaxTravel_m = 0.06;
constexpr double kMargin_m = 0.008;  // Farther than needed: tubes slip.
constexpr double kPress_m = 0.004;   // Of the fingers' edge below the crown, at most.
constexpr double kEdge_m = 0.002;    // The crown stays this far inside the fingers' lower face.
constexpr double kOffStep_m = 0.001;
constexpr double kEnd_m = 0.012;       // From the tube's ends.
constexpr double kTouchStep_m = 0.01;  // Between touching points.
constexpr double kLevel = 0.26;        // Sine of the steepest place that is touched.
constexpr double kSweep_m = 0.01;
constexpr double kOwnReach_m = 0.045;  // The tube itself is an obstacle from this arc length on.
constexpr double kOverTube_m = 0.008;  // The touched tube's own points end below this.
constexpr int kMaxStrokes = 4;
constexpr int kGraspsAsked = 3;

std::string Millimetres(double length_m) { return Number(std::round(1e3 * length_m)) + " mm"; }

// Vertical tool whose x lies along `x_N`: pads and the bars behind them touch at once.
Matrix3 ToolAlong(const Vector3& x_N) {
  Matrix3 R_NE;
  R_NE.col(0) = x_N;
  R_NE.col(2) = -Vector3::UnitZ();
  R_NE.col(1) = R_NE.col(2).cross(R_NE.col(0));
  return R_NE;
}

// A tube that strays less than its radius from a straight line rolls.
bool Rolls(const PerceivedTube& tube) {
  const Polyline chord = {tube.centerline_N.front(), tube.centerline_N.back()};
  return std::all_of(tube.centerline_N.begin(), tube.centerline_N.end(), [&](const Vector3& p) {
    return Closest(chord, p).distance_m < tube.radius_m;
  });
}

// Inward from each near wall, between two of them, away from near tubes.
std::vector<Vector3> Directions(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin) {
  std::vector<Vector3> out;
  const auto add = [&](Vector3 way) {
    way.z() = 0.0;
    if (way.norm() < 1e-6) return;
    way.normalize();
    for (int k = 0; k < 3; ++k) way[k] = way[k] == 0.0 ? 0.0 : way[k];  // No negative zeros.
    if (std::none_of(out.begin(), out.end(),
                     [&](const Vector3& other) { return other.dot(way) > kSameWay; })) {
      out.push_back(way);
    }
  };
  std::array<double, 2> low = {1e9, 1e9}, high = {1e9, 1e9};  // Room to the walls.
  for (const Vector3& p : tube.centerline_N) {
    for (int k = 0; k < 2; ++k) {
      const double half = k == 0 ? bin.half_x_m() : bin.half_y_m();
      low[k] = std::min(low[k], p[k] + half - tube.radius_m);
      high[k] = std::min(high[k], half - p[k] - tube.radius_m);
    }
  }
  std::vector<Vector3> inward;
  for (int k = 0; k < 2; ++k) {
    if (low[k] < kNear_m) inward.push_back(Vector3::Unit(k));
    if (high[k] < kNear_m) inward.push_back(-Vector3::Unit(k));
  }
  for (const Vector3& way : inward) add(way);
  for (std::size_t i = 0; i < inward.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) add(inward[i] + inward[j]);
  }
  for (const PerceivedTube& other : scene.tubes) {
    if (other.id == tube.id) continue;
    const LinePair pair = ClosestOfLines(tube.centerline_N, other.centerline_N);
    if (pair.distance_m - tube.radius_m - other.radius_m > kNear_m) continue;
    add(PointAt(tube.centerline_N, pair.s_m) - PointAt(other.centerline_N, pair.t_m));
  }
  return out;
}

TubeScene WithTubeMoved(const TubeScene& scene, int id, const Vector3& shift) {
  TubeScene moved = scene;
  for (PerceivedTube& tube : moved.tubes) {
    if (tube.id == id) tube.centerline_N = Transformed(Translation(shift), tube.centerline_N);
  }
  return moved;
}

class Nudger {
 public:
  Nudger(const PickProblem& problem, const FeasibilityFunction& grasp_feasible)
      : problem_(problem), config_(problem.config), grasp_feasible_(grasp_feasible) {}

  // Nudges of a tube along `direction`, nearest to the centre of mass first; or why there is none.
  std::vector<Nudge> Along(const PerceivedTube& tube, const Vector3& direction,
                           std::string& reason) const {
    const std::optional<double> needed_m = TravelToGrasp(tube, direction, reason);
    if (!needed_m) return {};
    Nudge nudge;
    nudge.tube = tube.id;
    nudge.direction_N = direction;
    nudge.travel_m = *needed_m;
    nudge.rolls = Rolls(tube);
    std::vector<Nudge> out;
    for (const double at_m : TouchingPoints(tube)) {
      nudge.at_m = at_m;
      nudge.strokes.clear();
      if (AddStrokes(tube, nudge, reason)) out.push_back(nudge);
    }
    return out;
  }

 private:
  // How far the tube has to go to be grasped, with a margin.
  std::optional<double> TravelToGrasp(const PerceivedTube& tube, const Vector3& direction,
                                      std::string& reason) const {
    const double room_m = MaxSlideDistance(tube, direction, problem_.bin, 0.0);
    const TubeObstacles around(problem_.scene, tube);
    for (double travel_m = kStep_m; travel_m <= kMaxTravel_m + 1e-9; travel_m += kStep_m) {
      if (travel_m > room_m) {
        reason = "another wall is in the way after " + Millimetres(room_m);
        return std::nullopt;
      }
      if (around.NewlyTouched(travel_m * direction) > 0) {
        reason = "it would meet another tube after " + Millimetres(travel_m);
        return std::nullopt;
      }
      if (!Graspable(tube, travel_m * direction)) continue;
      const double more_m = std::min(travel_m + kMargin_m, room_m);
      const bool free = around.NewlyTouched(more_m * direction) == 0;
      return free ? more_m : travel_m;
    }
    reason = "no grasp fits within " + Millimetres(kMaxTravel_m) + " either";
    return std::nullopt;
  }

  bool Graspable(const PerceivedTube& tube, const Vector3& shift) const {
    const TubeScene moved = WithTubeMoved(problem_.scene, tube.id, shift);
    const PerceivedTube& there = TubeOf(moved, tube.id);
    const std::vector<Vector3> no_points;
    const GraspInput input{moved,   no_points,           problem_.bin, problem_.gripper,
                           config_, config_.grasp_step_m};
    const CandidateMotion up = StraightUp({moved, there, problem_.bin, config_});
    const GraspSet set =
        RankGrasps(input, FindGraspSites(input, there), there, up, 0.0, there.radius_m);
    const int asked = std::min<int>(kGraspsAsked, static_cast<int>(set.grasps.size()));
    return std::any_of(set.grasps.begin(), set.grasps.begin() + asked, [&](Grasp grasp) {
      if (!grasp_feasible_(grasp, up)) return true;
      grasp.X_NG.linear() = grasp.X_NG.linear() * RotZ(kPi);
      return !grasp_feasible_(grasp, up);
    });
  }

  static std::vector<double> TouchingPoints(const PerceivedTube& tube) {
    const Vector3 centre = CurveCentre(tube.centerline_N);
    const double length = Length(tube.centerline_N);
    const int half = static_cast<int>(std::floor((0.5 * length - kEnd_m) / kTouchStep_m));
    std::vector<double> at;
    for (int k = -half; k <= half; ++k) {
      const double at_m = 0.5 * length + k * kTouchStep_m;
      if (std::abs(TangentAt(tube.centerline_N, at_m, 0.03).z()) < kLevel) at.push_back(at_m);
    }
    std::stable_sort(at.begin(), at.end(), [&](double a, double b) {
      const auto off = [&](double s) {
        // Whole millimetres, so that equal places stay in order.
        return std::round(1e3 * (PointAt(tube.centerline_N, s) - centre).head<2>().norm());
      };
      return off(a) < off(b);
    });
    return at;
  }

  // As many strokes as the travel needs; false with the reason when one does not fit.
  bool AddStrokes(const PerceivedTube& tube, Nudge& nudge, std::string& reason) const {
    const double reach_m = 0.5 * problem_.gripper.spec.pad_width_m - kEdge_m;
    double gone_m = 0.0;
    while (gone_m < nudge.travel_m - 1e-6) {
      if (static_cast<int>(nudge.strokes.size()) == kMaxStrokes) {
        reason = "more than " + std::to_string(kMaxStrokes) + " strokes would be needed";
        return false;
      }
      const Vector3 crown = PointAt(tube.centerline_N, nudge.at_m) + gone_m * nudge.direction_N +
                            Vector3(0, 0, tube.radius_m);
      std::optional<NudgeStroke> found;
      double step_m = 0.0;
      // A tube that rolls is touched as far out as the wall allows: it falls back under the
      // fingers.
      for (double off_m = nudge.rolls ? -reach_m : 0.0; off_m < reach_m - kOffStep_m && !found;
           off_m += kOffStep_m) {
        step_m = nudge.travel_m - gone_m;
        if (nudge.rolls) step_m = std::min(step_m, reach_m - off_m);
        NudgeStroke stroke;
        stroke.X_NE =
            MakeTransform(ToolAlong(nudge.direction_N),
                          crown + off_m * nudge.direction_N +
                              Vector3(0, 0, 0.5 * problem_.gripper.spec.pad_height_m - kPress_m));
        stroke.travel_N = (nudge.rolls ? 2.0 : 1.0) * step_m * nudge.direction_N;
        const std::string against = Against(tube, nudge, stroke);
        if (against.empty()) {
          found = stroke;
        } else {
          reason = against;
        }
      }
      if (!found) return false;
      nudge.strokes.push_back(*found);
      gone_m += step_m;
    }
    return true;
  }

  // What the gripper would meet on a stroke; empty when it is free.
  std::string Against(const PerceivedTube& tube, const Nudge& nudge,
                      const NudgeStroke& stroke) const {
    const double length_m = stroke.travel_N.norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kSweep_m)));
    for (int k = 0; k <= steps; ++k) {
      const RigidTransform X_NE = Translation(stroke.travel_N * k / steps) * stroke.X_NE;
      const std::string against = AgainstPose(tube, nudge, X_NE);
      if (!against.empty()) return against;
    }
    return "";
  }

  std::string AgainstPose(const PerceivedTube& tube, const Nudge& nudge,
                          const RigidTransform& X_NE) const {
    const GripperBoxes boxes = MakeGripperBoxes(problem_.gripper, 0.0, tube.radius_m, 0.0);
    const double min_m = config_.finger_clearance_m;
    OrientedBox over = boxes.fingers;  // Without the part that touches the tube.
    over.half_m.z() -= 0.5 * kOverTube_m;
    over.X_AB.translation().z() -= 0.5 * kOverTube_m;
    int points = 0;
    const std::vector<GripperGeometry::NamedBox> parts = Parts(boxes);
    for (const auto& [name, box] : parts) {
      const bool fingers = &name == &parts.front().name;
      const OrientedBox box_N = Moved(X_NE, box), upper_N = fingers ? Moved(X_NE, over) : box_N;
      if (WallClearance(box_N, problem_.bin, 2.0 * min_m) < min_m) {
        return name + " too near to a wall";
      }
      for (const PerceivedTube& other : problem_.scene.tubes) {
        if (other.id == tube.id) continue;
        if (LineBoxDistance(other.centerline_N, box_N, 2.0 * min_m + other.radius_m) <
            min_m + other.radius_m) {
          return name + " too near to tube " + std::to_string(other.id);
        }
      }
      if (MeetsOwn(tube, nudge.at_m, upper_N, min_m)) {
        return name + " too near to another part of the tube";
      }
      points +=
          static_cast<int>(std::count_if(problem_.points_N.begin(), problem_.points_N.end(),
                                         [&](const Vector3& p) { return Contains(upper_N, p); }));
    }
    if (points > config_.max_points) return "measured points in the gripper's way";
    return "";
  }

  static bool MeetsOwn(const PerceivedTube& tube, double at_m, const OrientedBox& box_N,
                       double min_m) {
    const double length = Length(tube.centerline_N);
    const auto meets = [&](double from_m, double to_m) {
      if (to_m - from_m < 1e-3) return false;
      return LineBoxDistance(SubLine(tube.centerline_N, from_m, to_m), box_N,
                             2.0 * min_m + tube.radius_m) < min_m + tube.radius_m;
    };
    return meets(0.0, at_m - kOwnReach_m) || meets(at_m + kOwnReach_m, length);
  }

  const PickProblem& problem_;
  const PlannerConfig& config_;
  const FeasibilityFunction& grasp_feasible_;
};

// Both senses of the closing direction are equal.
std::optional<std::string> TryArm(Nudge& nudge, const NudgeFeasibility& feasible) {
  const std::optional<std::string> against = feasible(nudge);
  if (!against) return std::nullopt;
  Nudge turned = nudge;
  for (NudgeStroke& stroke : turned.strokes) {
    stroke.X_NE.linear() = stroke.X_NE.linear() * RotZ(kPi);
  }
  if (feasible(turned)) return against;
  nudge = turned;
  return std::nullopt;
}

}  // namespace

NudgeResult PlanNudge(const PickProblem& problem, const FeasibilityFunction& grasp_feasible,
                      const NudgeFeasibility& feasible) {
  NudgeResult result;
  const TubeScene& scene = problem.scene;
  const Nudger nudger(problem, grasp_feasible);
  std::vector<std::vector<Nudge>> ways;  // Of one tube and direction each.
  for (const PerceivedTube& tube : scene.tubes) {
    if (tube.centerline_N.size() < 2 || Length(tube.centerline_N) <= 0.0) continue;
    if (tube.tube_class != TubeClass::kFree) {
      result.rejections.push_back({tube.id, "nudge", "", "covered tubes are not nudged"});
      continue;
    }
    std::vector<std::string> reasons;  // One for each direction.
    bool any = false;
    for (const Vector3& direction : Directions(scene, tube, problem.bin)) {
      std::string reason;
      std::vector<Nudge> nudges = nudger.Along(tube, direction, reason);
      reasons.push_back(reason);
      if (nudges.empty()) continue;
      any = true;
      ways.push_back(std::move(nudges));
    }
    if (reasons.empty()) reasons = {"no wall and no tube is near"};
    if (!any) result.rejections.push_back({tube.id, "nudge", "", Join(reasons, "; ")});
  }
  std::stable_sort(ways.begin(), ways.end(), [](const auto& a, const auto& b) {
    return a.front().travel_m < b.front().travel_m - 1e-9;
  });
  for (std::vector<Nudge>& way : ways) {
    std::optional<std::string> against;
    for (Nudge& nudge : way) {
      against = TryArm(nudge, feasible);
      if (against) continue;
      result.nudge = nudge;
      return result;
    }
    result.rejections.push_back({way.front().tube, "nudge", "", "arm: " + against.value_or("")});
  }
  return result;
}

Json ToJson(const std::optional<Nudge>& nudge) {
  if (!nudge) return nullptr;
  Json strokes = Json::array();
  for (const NudgeStroke& stroke : nudge->strokes) {
    strokes.push_back({{"X_NE", ToJson(stroke.X_NE)}, {"travel_m", ToJson(stroke.travel_N)}});
  }
  return Json{{"tube", nudge->tube},
              {"at_m", nudge->at_m},
              {"direction", ToJson(nudge->direction_N)},
              {"travel_m", nudge->travel_m},
              {"rolls", nudge->rolls},
              {"strokes", strokes}};
}

}  // namespace tubetwin

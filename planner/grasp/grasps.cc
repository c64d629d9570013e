#include "planner/grasp/grasps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "models/base/text.h"
#include "models/gripper_spec.h"
#include "planner/grasp/gripper_boxes.h"

namespace tubetwin {
namespace {

constexpr double kEnough_m = 0.020;    // More room than this is worth nothing.
constexpr double kOwnReach_m = 0.045;  // The tube itself is an obstacle from this arc length on.
constexpr double kTangentWindow_m = 0.03;
constexpr double kTurnStep_m = 0.01;  // Between poses of a motion that turns.
constexpr double kMaxTilt_deg = 35.0;
constexpr double kFloorClearance_m = 0.002;  // Between a tilted finger and the floor.
constexpr double kMinHold_m = 0.005;         // Of the pads below the tube's axis.
constexpr double kNearEnd_m = 0.012;         // Just more than half a pad.
// Room between tube and pad on either side, metres, from comfortable to what arm and camera need.
constexpr std::array<double, 6> kSideRoom_m = {0.020, 0.015, 0.011, 0.008, 0.006, 0.0045};

std::string Millimetres(double length_m) {
  return Number(std::round(length_m * 1e4) / 10.0) + " mm";
}

std::string SiteName(double at_m) { return "at " + Number(std::round(at_m * 1e3) / 1e3) + " m"; }

// A tube, or a part of the grasped one, that the gripper must keep away from.
struct GraspObstacle {
  Polyline line;
  double radius_m;
  std::string name;
};

// Everything that a grasp of one tube must keep away from.
struct GraspObstacles {
  const GraspInput& input;
  const PerceivedTube& tube;
  std::vector<GraspObstacle> others;
  std::vector<double> covered_at_m;  // Arc lengths of crossings under another tube.
  double cover_m = 0.0;              // Distance to keep from them.
};

GraspObstacles ObstaclesOf(const GraspInput& input, const PerceivedTube& tube) {
  GraspObstacles around{input, tube, {}, {}, 2.0 * tube.radius_m};
  for (const PerceivedTube& other : input.scene.tubes) {
    if (other.id == tube.id) continue;
    around.others.push_back(
        {other.centerline_N, other.radius_m, "tube " + std::to_string(other.id)});
  }
  for (const Crossing& crossing : input.scene.crossings) {
    if (crossing.under == tube.id) around.covered_at_m.push_back(crossing.at_under_m);
  }
  return around;
}

// Parts of the tube itself that are too far along it to pass between the pads.
std::vector<GraspObstacle> OwnObstacles(const PerceivedTube& tube, double at_m) {
  std::vector<GraspObstacle> own;
  const double length = Length(tube.centerline_N);
  if (at_m - kOwnReach_m > 1e-3) {
    own.push_back({SubLine(tube.centerline_N, 0.0, at_m - kOwnReach_m), tube.radius_m,
                   "the tube's own start"});
  }
  if (at_m + kOwnReach_m < length - 1e-3) {
    own.push_back({SubLine(tube.centerline_N, at_m + kOwnReach_m, length), tube.radius_m,
                   "the tube's own end"});
  }
  return own;
}

struct Fit {
  double clearance_m = 0.0;
  std::string reason;  // Empty when it fits.
};

// Of a tool from upright.
double TiltOf(const RigidTransform& X_NG) {
  return std::acos(std::clamp(-X_NG.linear()(2, 2), -1.0, 1.0));
}

Fit CheckPoints(const GraspObstacles& around, const RigidTransform& X_NG,
                const GripperBoxes& boxes) {
  const std::array<OrientedBox, 4> solid = {
      Moved(X_NG, boxes.finger[0]), Moved(X_NG, boxes.finger[1]), Moved(X_NG, boxes.chassis()),
      Moved(X_NG, boxes.above_tube)};
  // A tilted body lies aside of E.
  const double reach =
      boxes.chassis().half_m.y() + 0.02 + around.input.gripper.reach_m * std::sin(TiltOf(X_NG));
  int count = 0;
  for (const Vector3& p : around.input.points_N) {
    const Vector3 apart = p - X_NG.translation();
    if (std::abs(apart.x()) > reach || std::abs(apart.y()) > reach) continue;
    for (const OrientedBox& box : solid) {
      if (!Contains(box, p)) continue;
      ++count;
      break;
    }
  }
  if (count <= around.input.config.max_points) return {};
  return {0.0, std::to_string(count) + " measured points in the gripper's way, at most " +
                   std::to_string(around.input.config.max_points)};
}

// Does the gripper fit at this pose and opening, and with how much room?
Fit CheckFit(const GraspObstacles& around, const std::vector<GraspObstacle>& own,
             const RigidTransform& X_NG, double opening_m, double height_over_axis_m) {
  const GripperBoxes boxes =
      MakeGripperBoxes(around.input.gripper, opening_m, around.tube.radius_m, height_over_axis_m);
  const double min_m = around.input.config.finger_clearance_m;
  Fit fit{kEnough_m, ""};
  for (const auto& [name, box] : Parts(boxes)) {
    const OrientedBox box_N = Moved(X_NG, box);
    const double to_wall = WallClearance(box_N, around.input.bin, kEnough_m);
    if (to_wall < min_m) {
      return {to_wall, name + " " + Millimetres(to_wall) + " from the bin's wall"};
    }
    fit.clearance_m = std::min(fit.clearance_m, to_wall);
    for (const auto* obstacles : {&around.others, &own}) {
      for (const GraspObstacle& other : *obstacles) {
        const double gap =
            LineBoxDistance(other.line, box_N, kEnough_m + other.radius_m) - other.radius_m;
        if (gap < min_m) {
          return {gap, name + " " + Millimetres(gap) + " from " + other.name};
        }
        fit.clearance_m = std::min(fit.clearance_m, gap);
      }
    }
  }
  const Fit points = CheckPoints(around, X_NG, boxes);
  if (!points.reason.empty()) return points;
  return fit;
}

// How the tool stands at a place of the tube.
struct Stance {
  double yaw_rad = 0.0;   // Off the tube's cross direction.
  double lean_rad = 0.0;  // To a side of the tube, about its axis.
  bool square = false;    // Also along the tube, until it is square to the tangent.
};

// Vertical tool, x along `along` or against it: the one that points along B's x.
Matrix3 UprightTool(const Vector3& along, const Bin& bin) {
  Vector3 x(along.x(), along.y(), 0.0);
  x.normalize();
  const Vector3 x_B = bin.X_BN.linear() * x;
  if (x_B.x() < 0.0 || (x_B.x() == 0.0 && x_B.y() < 0.0)) x = -x;
  Matrix3 R_NG;
  R_NG.col(0) = x;
  R_NG.col(2) = -Vector3::UnitZ();
  R_NG.col(1) = R_NG.col(2).cross(R_NG.col(0));
  return R_NG;
}

// Angle about the tool's y that turns its x along a tangent, as far as a tool may tilt.
double SquareTo(const Vector3& tangent, const Matrix3& R_NG) {
  const double rise = R_NG.col(0).dot(tangent) < 0.0 ? -tangent.z() : tangent.z();
  const double max_rad = Radians(kMaxTilt_deg);
  return std::clamp(std::asin(std::clamp(rise, -1.0, 1.0)), -max_rad, max_rad);
}

double LowestPoint(const OrientedBox& box_N) {
  return box_N.X_AB.translation().z() - box_N.X_AB.linear().row(2).cwiseAbs().dot(box_N.half_m);
}

// How far back along a tilted tool E stays from the tube's axis: as upright, or more where a finger
// would come too near to the floor. Nothing when the pads would not hold the tube any more.
std::optional<double> HeightOverAxis(const GripperGeometry& gripper, const Vector3& p_NAxis,
                                     const Matrix3& R_NG, double opening_m, double radius_m) {
  const GripperSpec& spec = gripper.spec;
  double over_m = GraspHeightOverAxis(p_NAxis.z(), spec);
  const double down = -R_NG(2, 2);
  if (down == 1.0) return over_m;
  const RigidTransform X_NG = MakeTransform(R_NG, p_NAxis - over_m * R_NG.col(2));
  const double low_m =
      LowestPoint(Moved(X_NG, MakeGripperBoxes(gripper, opening_m, radius_m, over_m).fingers));
  over_m += std::max(0.0, kFloorClearance_m - low_m) / down;
  if (over_m > 0.5 * spec.pad_height_m - kMinHold_m) return std::nullopt;
  return over_m;
}

// Least distance of the gripper to the bin's walls on a motion, at most kEnough_m.
double WallClearanceAlong(const GraspInput& input, const CandidateMotion& motion,
                          const Grasp& grasp, double radius_m) {
  std::vector<RigidTransform> poses;
  if (motion.turns()) {
    const double reach_m =
        (grasp.X_NG.translation() - motion.pivot_N).norm() + input.gripper.reach_m;
    poses = PosesAlong(motion, kTurnStep_m, reach_m);
  } else {
    for (std::size_t k = 1; k < motion.waypoints_N.size(); ++k) {
      // The lower end of each leg at its farther end: walls are met there or nowhere.
      for (Vector3 shift : {motion.waypoints_N[k - 1], motion.waypoints_N[k]}) {
        shift.z() = std::min(motion.waypoints_N[k - 1].z(), motion.waypoints_N[k].z());
        poses.push_back(Translation(shift));
      }
    }
  }
  const GripperBoxes boxes = MakeGripperBoxes(input.gripper, grasp.opening_m, radius_m, 0.0);
  double to_wall = kEnough_m;
  for (const RigidTransform& pose : poses) {
    for (const auto& [name, box] : Parts(boxes)) {
      to_wall =
          std::min(to_wall, WallClearance(Moved(pose * grasp.X_NG, box), input.bin, kEnough_m));
    }
  }
  return to_wall;
}

struct SiteResult {
  std::optional<GraspSite> site;
  std::string reason;
};

// The best opening at one point of the tube and one stance.
SiteResult TrySite(const GraspObstacles& around, double at_m, const Stance& stance) {
  const PerceivedTube& tube = around.tube;
  const GripperSpec& spec = around.input.gripper.spec;
  const Vector3 axis = PointAt(tube.centerline_N, at_m);
  const Vector3 tangent = TangentAt(tube.centerline_N, at_m, kTangentWindow_m);
  Matrix3 R_NG = UprightTool(RotZ(stance.yaw_rad) * tangent, around.input.bin);
  const double square_rad = stance.square ? SquareTo(tangent, R_NG) : 0.0;
  const double slope_deg =
      Degrees(std::asin(std::min(1.0, std::abs(tangent.z()))) - std::abs(square_rad));
  if (slope_deg > around.input.config.max_slope_deg) {
    return {{},
            "slope " + Number(std::round(slope_deg)) + " degrees, at most " +
                Number(around.input.config.max_slope_deg)};
  }
  for (const double covered : around.covered_at_m) {
    if (std::abs(covered - at_m) < around.cover_m) {
      return {{}, "within two radii of a crossing under another tube"};
    }
  }
  if (stance.square || stance.lean_rad != 0.0) {
    R_NG = R_NG * RotY(square_rad) * RotX(stance.lean_rad);
    if (-R_NG(2, 2) < std::cos(Radians(kMaxTilt_deg)) - 1e-9) return {{}, "tilted too far"};
  }
  const std::vector<GraspObstacle> own = OwnObstacles(tube, at_m);
  // Half the gap that the tube fills between pads that stand oblique to it.
  const double filled = tube.radius_m / std::cos(stance.yaw_rad) +
                        0.5 * spec.pad_width_m * std::tan(std::abs(stance.yaw_rad));
  std::optional<GraspSite> best;
  double best_room = -1.0;
  std::string reason = "the tube is too thick for the gripper";
  for (const double side : kSideRoom_m) {
    const double opening = 2.0 * (filled + side);
    if (opening > spec.stroke_m) continue;
    const std::optional<double> over_axis =
        HeightOverAxis(around.input.gripper, axis, R_NG, opening, tube.radius_m);
    if (!over_axis) {
      reason = "tilted, a finger would reach into the floor";
      continue;
    }
    const RigidTransform X_NG = MakeTransform(R_NG, axis - *over_axis * R_NG.col(2));
    const Fit fit = CheckFit(around, own, X_NG, opening, *over_axis);
    reason = fit.reason;  // The narrowest opening's is reported.
    const double room = std::min(side, fit.clearance_m);
    if (!fit.reason.empty() || room <= best_room) continue;
    best_room = room;
    best = GraspSite{{tube.id, at_m, X_NG, opening, fit.clearance_m, 0.0}, axis.z()};
  }
  return {best, best ? "" : reason};
}

// Stances to try, those of a line only where none of the lines before gave a site.
std::vector<std::vector<Stance>> Stances() {
  std::vector<std::vector<Stance>> out = {{{}}, {}, {}};
  for (const double yaw_deg : {0.0, 15.0, -15.0, 30.0, -30.0}) {
    out[1].push_back({Radians(yaw_deg), 0.0, false});
  }
  for (const double lean_deg : {0.0, 12.0, -12.0, 24.0, -24.0, 35.0, -35.0}) {
    for (const bool square : {false, true}) {
      if (lean_deg != 0.0 || square) out[2].push_back({0.0, Radians(lean_deg), square});
    }
  }
  return out;
}

}  // namespace

GraspSites FindGraspSites(const GraspInput& input, const PerceivedTube& tube) {
  const GraspObstacles around = ObstaclesOf(input, tube);
  const GraspConfig& config = input.config;
  const double length = Length(tube.centerline_N);
  GraspSites out;
  // Sites at both sides of the middle at equal steps, so that reversing a tube changes nothing.
  const auto sweep = [&](double end_m, const std::vector<Stance>& stances, bool report) {
    const int half = static_cast<int>(std::floor((0.5 * length - end_m) / input.step_m));
    for (int k = -half; k <= half; ++k) {
      const double at_m = 0.5 * length + k * input.step_m;
      SiteResult first;
      bool found = false;
      for (std::size_t j = 0; j < stances.size() && !found; ++j) {
        const SiteResult result = TrySite(around, at_m, stances[j]);
        if (j == 0) first = result;
        if (!result.site) continue;
        out.sites.push_back(*result.site);
        found = true;
      }
      if (!found && report) out.rejections.push_back({tube.id, "", SiteName(at_m), first.reason});
    }
  };
  const std::vector<std::vector<Stance>> stances = Stances();
  for (std::size_t k = 0; k < stances.size() && out.sites.empty(); ++k) {
    sweep(k == 0 ? config.grasp_end_m : std::min(kNearEnd_m, config.grasp_end_m), stances[k],
          k == 0);
  }
  return out;
}

GraspSet RankGrasps(const GraspInput& input, const GraspSites& sites, const PerceivedTube& tube,
                    const CandidateMotion& motion, double displacement_m, double top_m) {
  const GraspConfig& config = input.config;
  GraspSet set;
  const Vector3 centre = CurveCentre(tube.centerline_N);
  const double half_length = 0.5 * Length(tube.centerline_N);
  const double trajectory =
      std::min(displacement_m, config.max_displacement_m) / config.max_displacement_m;
  for (const GraspSite& site : sites.sites) {
    Grasp grasp = site.grasp;
    const std::string name = SiteName(grasp.at_m);
    if (motion.forbidden_from_m <= grasp.at_m && grasp.at_m <= motion.forbidden_to_m) {
      set.rejections.push_back(
          {tube.id, motion.name, name, "this section would pass under the other tube"});
      continue;
    }
    if (std::any_of(motion.blocked_m.begin(), motion.blocked_m.end(), [&](const auto& range) {
          return range.first <= grasp.at_m && grasp.at_m <= range.second;
        })) {
      set.rejections.push_back(
          {tube.id, motion.name, name, "the gripper would run into another tube on the way"});
      continue;
    }
    const double to_wall = WallClearanceAlong(input, motion, grasp, tube.radius_m);
    if (to_wall < config.finger_clearance_m) {
      set.rejections.push_back(
          {tube.id, motion.name, name,
           "the motion brings the gripper " + Millimetres(to_wall) + " from the bin's wall"});
      continue;
    }
    const double off_centre =
        std::min(1.0, (PointAt(tube.centerline_N, grasp.at_m) - centre).norm() / half_length);
    const double low = 1.0 - std::clamp(site.height_m / std::max(top_m, 1e-6), 0.0, 1.0);
    const double tight = 1.0 - std::clamp(grasp.clearance_m / kEnough_m, 0.0, 1.0);
    grasp.cost = config.weight_height * low + config.weight_centre * off_centre +
                 config.weight_trajectory * trajectory + config.weight_clearance * tight +
                 config.weight_tilt * TiltOf(grasp.X_NG) / Radians(kMaxTilt_deg);
    set.grasps.push_back(grasp);
  }
  std::stable_sort(set.grasps.begin(), set.grasps.end(),
                   [](const Grasp& a, const Grasp& b) { return a.cost < b.cost; });
  return set;
}

}  // namespace tubetwin

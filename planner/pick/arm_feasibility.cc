#include "planner/pick/arm_feasibility.h"

#include <algorithm>

#include "models/gripper_spec.h"
#include "planner/pick/tool_path.h"

namespace tubetwin {
namespace {

constexpr double kUpright = 0.9999;           // Of the tool's axis along the vertical.
constexpr double kLeanFrom_m = 0.08;          // The cycle's default: there a tool leans over.
constexpr double kFingerClearance_m = 0.001;  // The pads end 2 mm over the floor.

}  // namespace

RigidTransform ToolPoseAtGrasp(const Grasp& grasp, double radius_m, const Bin& bin) {
  return bin.X_BN * grasp.X_NG * Translation(0, 0, PadRetreat(2.0 * radius_m));
}

FeasibilityFunction ArmFeasibility(const MotionPlanner& motion, const CellLayout& layout,
                                   const Bin& bin, double radius_m) {
  return [&motion, carry_m = layout.carry_height_m, bin, radius_m](
             const Grasp& grasp, const CandidateMotion& candidate) -> std::optional<std::string> {
    const RigidTransform X_BE = ToolPoseAtGrasp(grasp, radius_m, bin);
    const RigidTransform X_NE = bin.X_BN.inverse() * X_BE;
    const bool leans = X_NE.linear()(2, 2) > -kUpright;
    const double rise_m = leans ? kLeanFrom_m : std::max(0.0, carry_m - X_NE.translation().z());
    const RigidTransform X_NEOver = X_NE * Translation(0, 0, -rise_m);
    const std::optional<JointVector> q_over = motion.Reach(bin.X_BN * Upright(X_NEOver));
    if (!q_over) return "the place over the grasp is out of reach";
    MotionOptions options;
    options.finger_clearance_m = kFingerClearance_m;
    options.opening_m = grasp.opening_m;
    std::vector<RigidTransform> X_BE_down = {X_BE};
    if (leans) X_BE_down.insert(X_BE_down.begin(), bin.X_BN * X_NEOver);
    const MotionResult down = motion.PlanPolyline(*q_over, X_BE_down, options);
    if (const auto* refused = std::get_if<MotionRejection>(&down)) {
      return "approach: " + refused->reason;
    }

    std::vector<RigidTransform> X_BE_way = ToolPath(candidate, X_NE);
    for (RigidTransform& pose : X_BE_way) pose = bin.X_BN * pose;
    if (X_BE_way.empty()) return std::nullopt;
    options.opening_m = 2.0 * radius_m;
    options.speed_m_s = candidate.speed_m_s;
    options.turn_speed_rad_s = candidate.turn_speed_rad_s;
    const MotionResult away =
        motion.PlanPolyline(EndOf(std::get<CheckedTrajectory>(down)), X_BE_way, options);
    if (const auto* refused = std::get_if<MotionRejection>(&away)) {
      return candidate.name + ": " + refused->reason;
    }
    return std::nullopt;
  };
}

}  // namespace tubetwin

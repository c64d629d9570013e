#include "planner/pick/make_path.h"

#include "planner/motion/path_builder.h"
#include "planner/pick/tool_path.h"

namespace tubetwin {
namespace {

/// The poses as displacements from one before them, in B.
std::vector<PathGoal> From(const RigidTransform& X_NE_start,
                           const std::vector<RigidTransform>& X_NE, const Bin& bin) {
  const RigidTransform X_EN_start = X_NE_start.inverse(), X_NB = bin.X_BN.inverse();
  std::vector<PathGoal> goals;
  for (const RigidTransform& pose : X_NE) {
    goals.push_back({bin.X_BN * pose * X_EN_start * X_NB, true});
  }
  return goals;
}

}  // namespace

RigidTransform ToolPoseAtGrasp(const Grasp& grasp, double radius_m, const GripperSpec& gripper,
                               const Bin& bin) {
  return bin.X_BN * grasp.X_NG * Translation(0, 0, PadRetreat(gripper, 2.0 * radius_m));
}

PickPath MakePickPath(const Grasp& grasp, const CandidateMotion& motion,
                      const PickPathInput& input) {
  const PathConfig& config = input.config;
  const RigidTransform X_BE = ToolPoseAtGrasp(grasp, input.tube_radius_m, input.gripper, input.bin);
  const RigidTransform X_BE_above = X_BE * Translation(0, 0, -config.approach_m);
  PathBuilder path(config, 0.0);
  path.Open("opening", grasp.opening_m);
  // The tool weighs pointing down, so its own weight is taken off pointing down.
  path.Transfer("to over the grasp", Upright(X_BE_above));
  path.NextStage();
  if (!PointsDown(X_BE)) path.Line("leaning", To(X_BE_above));
  path.Line("approach", To(X_BE * Translation(0, 0, -config.guarded_m)));
  path.GuardedLine("down to the grasp", To(X_BE), config.guarded_speed_m_s, config.guard_force_N);
  path.NextStage();
  path.Close("closing", config.grip_force_N, 2.0 * input.tube_radius_m);

  const RigidTransform X_NE = input.bin.X_BN.inverse() * X_BE;
  const SplitPath tool = SplitAt(ToolPath(motion, X_NE), X_NE, config.first_lift_m);
  MotionOptions options =
      NearGrasp(motion.speed_m_s, config.transfer_acceleration_m_s2, input.ramp_s);
  options.turn_speed_rad_s = motion.turn_speed_rad_s;
  path.NextStage();
  if (!tool.first.empty())
    path.Add("first lift", options, Follow{From(X_NE, tool.first, input.bin)});
  path.NextStage();
  if (!tool.rest.empty()) {
    path.Add(motion.name, options, Follow{From(tool.first.back(), tool.rest, input.bin)});
  }
  return path.path();
}

FeasibilityFunction PathFeasibility(const MotionPlanner& planner, const Bin& bin,
                                    const PathConfig& config, double tube_radius_m) {
  return [&, tube_radius_m](const Grasp& grasp,
                            const CandidateMotion& motion) -> std::optional<std::string> {
    const PickPath path =
        MakePickPath(grasp, motion, {planner.model().gripper, bin, config, tube_radius_m, 0.0});
    const auto refusal = RefusalFromOver(planner, path);
    if (refusal) return refusal->reason;
    return std::nullopt;
  };
}

}  // namespace tubetwin

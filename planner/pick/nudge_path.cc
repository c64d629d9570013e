#include "models/gripper_spec.h"
#include "planner/motion/path_builder.h"
#include "planner/pick/nudge.h"

namespace tubetwin {
namespace {

/// The last part of the way down is slow, so that the arm stops where it meets the tube: at this
/// speed it leans on it with little more than the limit.
constexpr double kTouchSpeed_m_s = 0.002;
constexpr double kSlow_m = 0.007;  // Over the lowest place: from 3 mm over the crown.
constexpr double kOver_m = 0.015;  // The fingers are lifted this far between strokes.

void AddStroke(PathBuilder& path, const NudgeStroke& stroke, const Bin& bin,
               const PathConfig& config, const NudgeConfig& nudging) {
  const RigidTransform X_BE = bin.X_BN * stroke.X_NE;
  const auto over = [&](double height_m) { return To(Translation(0, 0, height_m) * X_BE); };
  path.NextStage();
  path.Line("over the touch", over(kOver_m));
  path.GuardedLine("down to the tube", over(kSlow_m), config.guarded_speed_m_s,
                   nudging.nudge_press_N);
  path.GuardedLine("pressing", over(0.0), kTouchSpeed_m_s, nudging.nudge_press_N);
  path.NextStage();
  path.GuardedLine("dragging", By(bin.X_BN.linear() * stroke.travel_N), nudging.nudge_speed_m_s,
                   nudging.nudge_force_N);
  path.NextStage();
  path.Line("lifting off", By(Vector3(0, 0, kOver_m)));
}

}  // namespace

int NudgeStage(int stroke, StrokeStage stage) { return 1 + 3 * stroke + static_cast<int>(stage); }

PickPath MakeNudgePath(const Nudge& nudge, const GripperSpec& gripper, const Bin& bin,
                       const PathConfig& config, const NudgeConfig& nudging) {
  PathBuilder path(config);
  path.Close("closing", gripper.min_force_N, 0.0);
  path.Transfer("to over the tube",
                Translation(0, 0, config.approach_m) * bin.X_BN * nudge.strokes.front().X_NE);
  for (const NudgeStroke& stroke : nudge.strokes) AddStroke(path, stroke, bin, config, nudging);
  return path.path();
}

NudgeFeasibility NudgePathFeasibility(const MotionPlanner& planner, const Bin& bin,
                                      const PathConfig& config, const NudgeConfig& nudging) {
  return [&](const Nudge& nudge) -> std::optional<std::string> {
    const auto refusal = RefusalFromOver(
        planner, MakeNudgePath(nudge, planner.model().gripper, bin, config, nudging));
    if (refusal) return refusal->reason;
    return std::nullopt;
  };
}

}  // namespace tubetwin

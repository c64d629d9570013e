#include "planner/motion/path_executor.h"

#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr double kPushed_rad = 0.0005;  ///< Far above the servo's own standing error.
constexpr double kSettle_s = 0.05;  ///< After a motion, before the next: the servo's lag dies out.

double JointDistance(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

StepOutcome StepOutcome::Refused(const std::string& reason) {
  return {Status::kRefused, WaitOutcome::Status::kRejected, reason};
}

StepOutcome StepOutcome::Trouble(const WaitOutcome& outcome, const std::string& what) {
  return {Status::kTrouble, outcome.status, what + ": " + outcome.reason};
}

PathExecutor::PathExecutor(Cell& cell)
    : cell_(cell), planner_(cell.model, cell.bin), fingers_(cell.gripper.State()) {
  start_.q = cell.arm.State().q;
}

PathStart PathExecutor::Start() const {
  const JointVector measured = cell_.arm.State().q;
  const bool pushed = JointDistance(measured, start_.q) > kPushed_rad && !Displaced();
  return pushed ? PathStart{measured, start_.opening_m} : start_;
}

void PathExecutor::Resync() {
  start_.q = cell_.arm.State().q;
  fingers_ = cell_.gripper.State();
  start_.opening_m = fingers_.opening_m;
}

StepOutcome PathExecutor::Run(const CheckedPath& path, int stage) {
  for (const CheckedPath::Segment& segment : path.segments()) {
    if (segment.segment.stage != stage) continue;
    StepOutcome outcome = RunSegment(segment);
    if (outcome.status != StepOutcome::Status::kDone) return outcome;
  }
  return {};
}

StepOutcome PathExecutor::Run(const CheckedPath& path) {
  StepOutcome last;
  for (int stage = 0; stage < path.num_stages(); ++stage) {
    last = Run(path, stage);
    if (!last.ok()) return last;
  }
  return last;
}

StepOutcome PathExecutor::CheckAndRun(const PickPath& path) {
  const PathCheck checked = Check(path);
  if (const MotionRejection* refusal = RefusalOf(checked)) {
    return StepOutcome::Refused(refusal->reason);
  }
  return Run(std::get<CheckedPath>(checked));
}

StepOutcome PathExecutor::RunSegment(const CheckedPath::Segment& segment) {
  if (const auto* fingers = std::get_if<MoveFingers>(&segment.segment.what)) {
    return RunFingers(segment.segment, *fingers);
  }
  if (const auto* pause = std::get_if<Pause>(&segment.segment.what)) {
    Wait(cell_, pause->duration_s);
    return {};
  }
  return RunMotion(segment);
}

StepOutcome PathExecutor::RunFingers(const PathSegment& segment, const MoveFingers& fingers) {
  const GripperOutcome moved = MoveGripper(cell_, fingers.command);
  fingers_ = moved.state;
  // Fingers that still move at the end of the wait are judged by their opening and by weight.
  if (moved.outcome.status == WaitOutcome::Status::kGripperFault ||
      moved.outcome.status == WaitOutcome::Status::kInterrupted) {
    return StepOutcome::Trouble(moved.outcome, segment.label);
  }
  const bool closing = fingers.command.opening_m < fingers.expected_opening_m;
  start_.opening_m = closing ? moved.state.opening_m : fingers.expected_opening_m;
  return {};
}

std::optional<WaitOutcome> PathExecutor::Displaced() const {
  const JointVector measured = cell_.arm.State().q;
  int worst = 0;
  const double off_rad = (measured - start_.q).cwiseAbs().maxCoeff(&worst);
  if (off_rad <= Radians(cell_.safety.deviation_deg)) return std::nullopt;
  return WaitOutcome{WaitOutcome::Status::kDeviated,
                     "joint " + std::to_string(worst + 1) + " is at " +
                         Number(Degrees(measured[worst])) + " degrees, the last motion ended at " +
                         Number(Degrees(start_.q[worst])) +
                         ": the arm was moved, or its state is wrong",
                     0.0};
}

StepOutcome PathExecutor::RunMotion(const CheckedPath::Segment& checked) {
  const PathSegment& segment = checked.segment;
  if (auto displaced = Displaced()) return StepOutcome::Trouble(*displaced, segment.label);
  start_ = Start();
  CheckedTrajectory trajectory = *checked.trajectory;
  if (JointDistance(start_.q, checked.start.q) > kPushed_rad) {
    MotionResult anew = PlanSegment(planner_, segment, start_);
    if (const auto* refusal = std::get_if<MotionRejection>(&anew)) {
      return StepOutcome::Refused(segment.label + ": " + refusal->reason);
    }
    trajectory = std::get<CheckedTrajectory>(std::move(anew));
  }
  const auto* guard = std::get_if<GuardedLine>(&segment.what);
  const WaitOutcome outcome = guard != nullptr ? RunGuarded(cell_, trajectory, guard->force_limit_N)
                                               : RunTrajectory(cell_, trajectory);
  if (outcome.status == WaitOutcome::Status::kContact) {
    Wait(cell_, kSettle_s);
    start_.q = cell_.arm.State().q;
    return {StepOutcome::Status::kContact, outcome.status, outcome.reason};
  }
  if (outcome.status != WaitOutcome::Status::kDone) {
    return StepOutcome::Trouble(outcome, segment.label);
  }
  start_.q = EndOf(trajectory);
  Wait(cell_, kSettle_s);
  return {};
}

}  // namespace tubetwin

#include "planner/cycle/pick_cycle.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "planner/cycle/cycle_context.h"
#include "planner/pick/arm_feasibility.h"
#include "planner/pick/pick_planner.h"
#include "planner/pick/tool_path.h"
#include "planner/scene_query/voxel_downsample.h"

namespace tubetwin {
namespace {

constexpr double kSameGrasp_m = 0.015;       ///< A grasp this near a failed one is the same again.
constexpr double kNothingOpening_m = 0.004;  ///< Closed fingers: nothing between them.
constexpr double kContactSlack_m = 0.004;    ///< Contact this near the grasp still closes.
constexpr double kUpright = 0.9999;          ///< Of the tool's axis along the vertical.
constexpr int kMostRecoveries = 5;           ///< Rejected motions in one round.

/// Several hang in the fingers, and the round was to end there.
struct EndAtSeveral {};

/// One round: the readable list of steps is RunPickCycle at the end of this file.
class Round {
 public:
  Round(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer)
      : c_{cell, setup, observer, MotionExecutor(cell), {}, {}, {}, {}, {}}, views_(c_) {}

  void BeginAttempt() {
    c_.report = AttemptReport();
    c_.report.attempt = attempt_;
    c_.report.strategy = ResolutionStrategyFromName(c_.setup.resolution.strategy);
    c_.attempt_began = c_.cell.clock.Now();
    c_.LetGo();
  }

  void EndAttempt(AttemptOutcome outcome, const std::string& reason) {
    c_.report.outcome = outcome;
    if (!reason.empty()) c_.report.reason = reason;
    auto& compute = c_.report.compute_s;
    compute.total = compute.modelling + compute.planning + compute.evaluator;
    c_.observer.OnAttemptEnd(c_.report);
    ++attempts_;
    if (outcome == AttemptOutcome::kPlaced) {
      attempt_ = 1;
      failed_.clear();
      expected_ = c_.report.tubes_in_bin - 1;
      views_.MarkAround(c_.report.plan->target);
      c_.cell.proven = true;
    } else {
      ++attempt_;
      views_.MarkAll();
    }
  }

  /// Looks until it is sure: an empty-looking bin is looked at whole before it is called empty.
  const TubeScene& RescanUntilConsistent() {
    c_.observer.OnStep("scanning");
    const TubeScene* scene = &views_.Look();
    // More than can be left is what an old view still shows of a tube that is gone.
    const bool too_many = expected_ >= 0 && static_cast<int>(scene->tubes.size()) > expected_;
    if ((scene->tubes.empty() || too_many) && !views_.all_fresh()) {
      views_.MarkAll();
      scene = &views_.Look();
    }
    if (scene->tubes.empty() && scene->bin_content != BinContent::kEmpty) {
      views_.MarkAll();  // What is left of a tube may be enough in another scan.
      scene = &views_.Look();
    }
    c_.report.tubes_in_bin = static_cast<int>(scene->tubes.size());
    expected_ = -1;
    if (first_count_ < 0) first_count_ = c_.report.tubes_in_bin;
    return *scene;
  }

  /// The best plan that has not failed and that the arm can run, or none.
  std::optional<PickPlan> Decide(const TubeScene& scene) {
    c_.observer.OnStep("planning");
    const double began = ComputeClock_s();
    const PlanResult result = PlanPicks(
        scene, ThinPoints(views_.views(), c_.cell.bin), c_.setup.part, c_.cell.bin,
        c_.setup.planner, c_.setup.evaluate,
        ArmFeasibility(c_.executor.planner(), c_.cell.layout, c_.cell.bin, c_.setup.part.radius_m),
        c_.setup.seed);
    c_.report.rejections = result.rejections;
    // What failed is not tried again before everything else was.
    std::optional<PickPlan> chosen;
    for (const PickPlan& plan : result.plans) {
      if (FailedBefore(plan)) continue;
      chosen = plan;
      break;
    }
    if (!chosen && !result.plans.empty()) chosen = result.plans.front();
    c_.report.compute_s.evaluator += result.evaluator_s;
    c_.report.compute_s.planning += ComputeClock_s() - began - result.evaluator_s;
    c_.observer.OnScene(scene, chosen ? &*chosen : nullptr);
    return chosen;
  }

  /// Approach, guarded descent, closing. Ends with the fingers closed, or says why not.
  bool GraspTube(const PickPlan& plan) {
    const CycleConfig& speeds = c_.setup.cycle;
    const CycleContext::Timed timed(c_, &AttemptReport::SimTime::move);
    c_.observer.OnStep("approaching tube " + std::to_string(plan.target) + " (" +
                       ToString(plan.target_class) + "), motion " + plan.motion.name);
    SetFingers(plan.grasp.opening_m, 0);
    const RigidTransform X_BG = c_.cell.bin.X_BN * plan.grasp.X_NG;
    const Vector3 back_B = -X_BG.linear().col(2);
    RigidTransform above = X_BG;
    above.translation() += speeds.approach_m * back_B;
    // The tool weighs pointing down, so its own weight is taken off pointing down.
    c_.executor.Transfer(Upright(above), speeds.transfer_speed_m_s,
                         speeds.transfer_acceleration_m_s2);
    {
      const CycleContext::Timed weighing(c_, &AttemptReport::SimTime::settle);
      Wait(c_.cell, 0.3);
      c_.reference_K = c_.MeanWrench(c_.setup.cycle.weigh_window_s);
      c_.observer.OnReference(c_.reference_K);
    }
    RigidTransform near = X_BG;
    near.translation() += speeds.guarded_m * back_B;
    if (plan.grasp.X_NG.linear()(2, 2) > -kUpright) {
      c_.executor.Line(above, speeds.approach_speed_m_s, speeds.transfer_acceleration_m_s2);
    }
    c_.executor.Line(near, speeds.approach_speed_m_s, speeds.transfer_acceleration_m_s2);
    const WaitOutcome descent =
        c_.executor.GuardedLine(X_BG, speeds.guarded_speed_m_s, speeds.guard_force_N);
    const double short_m = (c_.executor.X_BE().translation() - X_BG.translation()).norm();
    if (descent.status == WaitOutcome::Status::kContact && short_m > kContactSlack_m) {
      c_.report.reason = "met something " + std::to_string(static_cast<int>(1e3 * short_m)) +
                         " mm above the grasp";
      return false;
    }
    c_.observer.OnStep("closing");
    const GripperState held = SetFingers(0.0, 1);
    if (held.opening_m < kNothingOpening_m) {
      c_.report.reason = "the fingers closed on nothing";
      return false;
    }
    return true;
  }

  /// 3 cm lift, weigh, the rest of the motion, weigh for good.
  Detection LiftAndWeigh(const PickPlan& plan) {
    const RigidTransform& X_BN = c_.cell.bin.X_BN;
    const RigidTransform X_NE = X_BN.inverse() * c_.executor.X_BE();
    c_.cell.arm.SetPayload(c_.setup.part.mass_kg, c_.cell.layout.X_FE.translation());
    const SplitPath way = SplitAt(ToolPath(plan.motion, X_NE), X_NE, c_.setup.cycle.first_lift_m);
    const auto drive = [&](std::vector<RigidTransform> poses) {
      for (RigidTransform& pose : poses) pose = X_BN * pose;
      c_.executor.Legs(poses, plan.motion.speed_m_s, plan.motion.turn_speed_rad_s,
                       c_.setup.cycle.transfer_acceleration_m_s2);
    };
    {
      const CycleContext::Timed timed(c_, &AttemptReport::SimTime::move);
      c_.observer.OnStep("lifting 3 cm");
      drive(way.first);
    }
    c_.report.first_weighing = c_.Weigh(0.1);
    {
      const CycleContext::Timed timed(c_, &AttemptReport::SimTime::move);
      c_.observer.OnStep("lifting (" + plan.motion.name + ")");
      drive(way.rest);
    }
    c_.observer.OnStep("weighing");
    const Detection detection = c_.Weigh(c_.setup.cycle.settle_s);
    c_.report.detection = detection;
    c_.observer.OnDetection(detection);
    return detection;
  }

  AttemptOutcome FinishHeld(const PickPlan& plan, const Polyline& line_E,
                            const Detection& detection) {
    HeldOutcome held = detection.outcome;
    if (held == HeldOutcome::kSeveral) {
      c_.observer.OnSeveral(Stored(line_E));
      if (c_.setup.cycle.end_at_several) throw EndAtSeveral();
      c_.report.resolution_used = c_.report.strategy != ResolutionStrategy::kNone;
      held = Resolve(c_, detection.torque_Nm);
      if (c_.report.resolution_used) c_.report.resolution_outcome = held;
    }
    if (held == HeldOutcome::kSeveral) {
      Remember(plan);
      PutBack(c_);
      c_.report.reason = "several tubes hung in the fingers";
      return AttemptOutcome::kPutBack;
    }
    if (held == HeldOutcome::kNone) {
      Remember(plan);
      const bool lost = c_.cell.gripper.State().opening_m < kNothingOpening_m;
      PutBack(c_);
      c_.report.reason = lost ? "the tube slipped out of the fingers" : "no weight in the fingers";
      return AttemptOutcome::kNothingHeld;
    }
    const AttemptOutcome outcome = Place(c_, line_E);
    if (outcome != AttemptOutcome::kPlaced) SetFingers(GripperSpec().stroke_m, 0);
    return outcome;
  }

  /// A grasp that did not take: open, up, remember.
  void GiveUpGrasp(const PickPlan& plan) {
    const CycleContext::Timed timed(c_, &AttemptReport::SimTime::move);
    Remember(plan);
    SetFingers(plan.grasp.opening_m, 0);
    RigidTransform up = c_.executor.X_BE();
    up.translation().z() += 0.15;
    c_.executor.Line(up, c_.setup.cycle.approach_speed_m_s,
                     c_.setup.cycle.transfer_acceleration_m_s2);
  }

  Polyline HeldLine(const TubeScene& scene, const PickPlan& plan) const {
    for (const PerceivedTube& tube : scene.tubes) {
      if (tube.id == plan.target) {
        return Transformed(plan.grasp.X_NG.inverse(), tube.centerline_N);
      }
    }
    throw LogicError("the plan's target is not in the scene");
  }

  bool AttemptsLeft() const {
    return first_count_ < 0 || attempts_ < c_.setup.cycle.attempts_per_tube * first_count_ + 10;
  }

  /// A motion was rejected in the middle of an attempt: what hangs in the fingers goes back into
  /// the bin and the attempt counts as failed. False when even that cannot be done.
  bool Recover(const std::string& reason) {
    if (++recoveries_ > kMostRecoveries) return false;
    try {
      if (c_.report.plan) Remember(*c_.report.plan);
      PutBack(c_);
    } catch (const MoveFailure&) {
      return false;
    }
    EndAttempt(AttemptOutcome::kPutBack, reason);
    return true;
  }

  RoundReport EndOfRound(RoundEnd end, const std::string& reason) {
    RoundReport out;
    out.end = end;
    out.reason = reason;
    out.placed_believed = static_cast<int>(c_.placed_T.size());
    out.unseen_m3 = views_.scene().unseen_m3;
    return out;
  }

  /// Every tube that is left, with the first reason against it.
  std::string WhyNoPlan() const {
    std::string out;
    for (const PerceivedTube& tube : views_.scene().tubes) {
      out += (out.empty() ? "tube " : "; tube ") + std::to_string(tube.id) + ": ";
      const auto found = std::find_if(c_.report.rejections.begin(), c_.report.rejections.end(),
                                      [&](const Rejection& r) { return r.tube == tube.id; });
      out += found == c_.report.rejections.end() ? "no candidate" : found->reason;
    }
    return out;
  }

  /// Goes on where Stored() stood.
  void Resume(const AttemptCheckpoint& state) {
    const ResolutionStrategy strategy = c_.report.strategy;
    c_.report = state.report;
    c_.report.strategy = strategy;
    attempt_ = state.report.attempt;
    c_.reference_K = state.reference_K;
    c_.attempt_began = state.attempt_began;
    c_.placed_T = state.placed_T;
    c_.executor.Resume(state.q, state.opening_m);
    c_.Hold(state.line_E);
    c_.observer.OnReference(c_.reference_K);
    c_.observer.OnDetection(*c_.report.detection);
  }

  CycleContext& context() { return c_; }
  ViewScheduler& views() { return views_; }

 private:
  AttemptCheckpoint Stored(const Polyline& line_E) const {
    return {c_.report,   line_E,          c_.reference_K,         c_.attempt_began,
            c_.placed_T, c_.executor.q(), c_.executor.opening_m()};
  }

  GripperState SetFingers(double opening_m, int close) {
    GripperCommand command;
    command.opening_m = close ? 0.0 : opening_m;
    command.speed_m_s = c_.setup.cycle.grip_speed_m_s;
    command.force_N = c_.setup.cycle.grip_force_N;
    const GripperState state = c_.MoveFingers(command);
    c_.executor.SetOpening(close ? state.opening_m : opening_m);
    return state;
  }

  bool FailedBefore(const PickPlan& plan) const {
    return std::any_of(failed_.begin(), failed_.end(), [&](const auto& failed) {
      return failed.first == plan.motion.name &&
             (failed.second - plan.grasp.X_NG.translation()).norm() < kSameGrasp_m;
    });
  }

  void Remember(const PickPlan& plan) {
    failed_.emplace_back(plan.motion.name, plan.grasp.X_NG.translation());
  }

  CycleContext c_;
  ViewScheduler views_;
  std::vector<std::pair<std::string, Vector3>> failed_;  ///< Since the last placed tube.
  int attempt_ = 1;
  int attempts_ = 0;
  int first_count_ = -1;
  int expected_ = -1;  ///< Tubes that the next look should find at most; -1: no saying.
  int recoveries_ = 0;
};

/// One attempt from the look to the end. What ends the round is the answer, if anything does.
std::optional<RoundReport> Attempt(Round& round) {
  CycleContext& c = round.context();
  round.BeginAttempt();
  const TubeScene& scene = round.RescanUntilConsistent();
  std::optional<PickPlan> plan;
  for (;;) {
    if (scene.tubes.empty()) {
      const bool empty = scene.bin_content == BinContent::kEmpty;
      if (!c.report.nudges.empty()) {
        round.EndAttempt(AttemptOutcome::kNoPlan, "the nudged tube is not seen any more");
      }
      return round.EndOfRound(empty ? RoundEnd::kEmpty : RoundEnd::kNoPlan,
                              scene.bin_content_reason);
    }
    plan = round.Decide(scene);
    if (plan) break;
    if (!round.views().all_fresh()) {
      round.views().MarkAll();  // Look everywhere before giving up.
    } else if (const auto nudged = TryNudge(c, scene, round.views().views())) {
      round.views().MarkAround(*nudged);
    } else {
      round.EndAttempt(AttemptOutcome::kNoPlan, "no plan for any tube");
      return round.EndOfRound(RoundEnd::kNoPlan, round.WhyNoPlan());
    }
    round.RescanUntilConsistent();
  }
  c.report.plan = *plan;
  const Polyline line_E = round.HeldLine(scene, *plan);
  if (!round.GraspTube(*plan)) {
    round.GiveUpGrasp(*plan);
    round.EndAttempt(AttemptOutcome::kNothingHeld, "");
    return std::nullopt;
  }
  c.Hold(line_E);
  const Detection detection = round.LiftAndWeigh(*plan);
  round.EndAttempt(round.FinishHeld(*plan, line_E, detection), "");
  return std::nullopt;
}

}  // namespace

RoundReport RunPickCycle(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer) {
  Round round(cell, setup, observer);
  for (;;) {
    if (setup.stop_requested && setup.stop_requested()) {
      return round.EndOfRound(RoundEnd::kInterrupted, "asked to stop");
    }
    if (!round.AttemptsLeft()) {
      return round.EndOfRound(RoundEnd::kAttemptLimit, "too many attempts");
    }
    try {
      if (auto end = Attempt(round)) return *end;
    } catch (const EndAtSeveral&) {
      return round.EndOfRound(RoundEnd::kStored, "several tubes hang in the fingers");
    } catch (const MoveFailure& failure) {
      if (failure.kind == MoveFailure::Kind::kRejected && round.Recover(failure.what())) continue;
      round.EndAttempt(AttemptOutcome::kFault, failure.what());
      if (GoOnAfterStop(round.context(), failure) == Acknowledgement::kGoOn) continue;
      return round.EndOfRound(RoundEnd::kFault, failure.what());
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kDevice) throw;
      round.EndAttempt(AttemptOutcome::kFault, error.what());
      return round.EndOfRound(RoundEnd::kFault, error.what());
    }
  }
}

RoundReport ResumeAttempt(Cell& cell, const PickCycleSetup& setup, const AttemptCheckpoint& state,
                          CycleObserver& observer) {
  Round round(cell, setup, observer);
  round.BeginAttempt();
  round.Resume(state);
  const AttemptReport& report = round.context().report;
  try {
    const Detection detection = *report.detection;
    round.EndAttempt(round.FinishHeld(*state.report.plan, state.line_E, detection), "");
  } catch (const MoveFailure& failure) {
    if (failure.kind == MoveFailure::Kind::kFault || !round.Recover(failure.what())) {
      round.EndAttempt(AttemptOutcome::kFault, failure.what());
      return round.EndOfRound(RoundEnd::kFault, failure.what());
    }
  }
  return round.EndOfRound(RoundEnd::kStored, "the attempt of the stored state is over");
}

}  // namespace tubetwin

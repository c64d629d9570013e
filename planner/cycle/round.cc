#include "planner/cycle/round.h"

#include <algorithm>
#include <cmath>

#include "hw_bridge/cell/left_over.h"
#include "models/base/error.h"
#include "planner/pick/pick_planner.h"
#include "planner/pick/runnable_plan.h"
#include "planner/scene_query/tubes.h"
#include "planner/scene_query/voxel_downsample.h"

namespace tubetwin {
namespace {

constexpr double kSameGrasp_m = 0.015;     ///< A grasp this near a failed one is the same again.
constexpr double kContactSlack_m = 0.004;  ///< Contact this near the grasp still closes.
constexpr double kFirstSettle_s = 0.1;     ///< Of the load, at most, after the small lift.
constexpr int kMaxRefusals = 5;  ///< Attempts of one round that these may end with a tube held.

}  // namespace

Round::Round(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer)
    : c_(cell, setup, observer), views_(c_) {}

std::string Round::LeftOver() const {
  const Cell& cell = c_.cell;
  const std::string fingers = LeftInFingers(cell.gripper.State());
  if (!fingers.empty()) return fingers;
  return LeftOnWrist(cell.wrist.Read(), cell.arm.State().q, cell.model, cell.safety,
                     c_.setup.part.mass_kg);
}

std::optional<RoundReport> Round::Begin() {
  const std::string left = LeftOver();
  if (left.empty()) return std::nullopt;
  if (PutBackLeftOver(c_, left) == Acknowledgement::kGoOn && LeftOver().empty()) {
    return std::nullopt;
  }
  return End(RoundEnd::kFault, left +
                                   ": left there by an earlier program; take it out, or run at a "
                                   "terminal and let it be put back into the bin");
}

bool Round::AttemptsLeft() const {
  return first_count_ < 0 || attempts_ < c_.setup.cycle.attempts_per_tube * first_count_ + 10;
}

std::optional<RoundReport> Round::Attempt() {
  try {
    BeginAttempt();
    const Decision decision = Decide();
    if (!decision.step.ok()) return After({decision.step});
    if (decision.end) return decision.end;
    return After(Pick(decision));
  } catch (const Error& error) {
    // What a driver throws when its device is gone.
    if (error.kind() != ErrorKind::kDevice) throw;
    EndAttempt(AttemptOutcome::kFault, error.what());
    return End(RoundEnd::kFault, error.what());
  }
}

std::optional<RoundReport> Round::FinishStored(const AttemptCheckpoint& state) {
  BeginAttempt();
  const std::string strategy = c_.report.strategy;
  c_.report = state.report;
  c_.report.strategy = strategy;
  attempt_ = state.report.attempt;
  c_.reference_K = state.reference_K;
  c_.attempt_began = state.attempt_began;
  c_.placed_T = state.placed_T;
  c_.executor.Resume({state.q, state.opening_m});
  c_.Hold(state.line_E);
  c_.observer.OnReference(c_.reference_K);
  c_.observer.OnDetection(*c_.report.detection);
  return After(FinishHeld(*state.report.plan, state.line_E, *state.report.detection));
}

RoundReport Round::End(RoundEnd end, const std::string& reason) const {
  RoundReport out;
  out.end = end;
  out.reason = reason;
  out.placed_believed = static_cast<int>(c_.placed_T.size());
  out.unseen_m3 = views_.scene().unseen_m3;
  out.compute_s = c_.report.compute_s;
  out.compute_s.total = out.compute_s.modelling + out.compute_s.planning + out.compute_s.evaluator;
  return out;
}

void Round::BeginAttempt() {
  c_.report = AttemptReport();
  c_.report.attempt = attempt_;
  c_.report.strategy = c_.strategy.name;
  c_.attempt_began = c_.cell.clock.Now();
  c_.BeginPhases();
  c_.held = {};
}

void Round::EndAttempt(AttemptOutcome outcome, const std::string& reason) {
  c_.report.outcome = outcome;
  if (!reason.empty()) c_.report.reason = reason;
  auto& compute = c_.report.compute_s;
  compute.total = compute.modelling + compute.planning + compute.evaluator;
  c_.Enter(&AttemptReport::Phases::look);
  c_.observer.OnAttemptEnd(c_.report);
  compute = {};  // Told; what is counted from here on belongs to the round's end.
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

// Looks until it is sure: an empty-looking bin is looked at whole before it is called empty.
StepOutcome Round::RescanUntilConsistent() {
  c_.observer.OnStep("scanning");
  if (StepOutcome step = views_.Look(); !step.ok()) return step;
  // More than can be left is what an old view still shows of a tube that is gone.
  const int found = static_cast<int>(views_.scene().tubes.size());
  const bool too_many = expected_ >= 0 && found > expected_;
  if ((found == 0 || too_many) && !views_.all_fresh()) {
    views_.MarkAll();
    if (StepOutcome step = views_.Look(); !step.ok()) return step;
  }
  if (views_.scene().tubes.empty() && views_.scene().bin_content != BinContent::kEmpty) {
    views_.MarkAll();  // What is left of a tube may be enough in another scan.
    if (StepOutcome step = views_.Look(); !step.ok()) return step;
  }
  c_.report.tubes_in_bin = static_cast<int>(views_.scene().tubes.size());
  expected_ = -1;
  if (first_count_ < 0) first_count_ = c_.report.tubes_in_bin;
  return {};
}

// Looks and plans until there is a plan that the arm can run whole, or nothing is left to try: look
// everywhere, push a tube free.
Round::Decision Round::Decide() {
  for (;;) {
    if (StepOutcome step = RescanUntilConsistent(); !step.ok()) return {step, {}, {}, {}, {}};
    const TubeScene scene = views_.scene();
    if (scene.tubes.empty()) return NothingLeft(scene);
    if (auto decision = ChoosePlan(scene)) return *decision;
    if (!views_.all_fresh()) {
      views_.MarkAll();
      continue;
    }
    const std::vector<Vector3> points_N = VoxelDownsample(views_.clouds(), c_.cell.bin);
    const NudgeStep nudge = TryNudge(c_, Problem(scene, points_N));
    if (!nudge.step.ok()) return {nudge.step, {}, {}, {}, {}};
    if (!nudge.tube) {
      EndAttempt(AttemptOutcome::kNoPlan, "no plan for any tube");
      return {{}, End(RoundEnd::kNoPlan, WhyNoPlan()), {}, {}, {}};
    }
    views_.MarkAround(*nudge.tube);
  }
}

Round::Decision Round::NothingLeft(const TubeScene& scene) {
  const bool empty = scene.bin_content == BinContent::kEmpty;
  if (!c_.report.nudges.empty()) {
    EndAttempt(AttemptOutcome::kNoPlan, "the nudged tube is not seen any more");
  }
  return {
      {}, End(empty ? RoundEnd::kEmpty : RoundEnd::kNoPlan, scene.bin_content_reason), {}, {}, {}};
}

PickProblem Round::Problem(const TubeScene& scene, const std::vector<Vector3>& points_N) const {
  return {scene, points_N, c_.setup.part, c_.cell.bin, c_.gripper, c_.setup.planner, c_.motions};
}

// The best plan whose path the arm can run from where it stands: of those that have not failed
// before, else of the others. A path that is refused here costs nothing but the next plan.
std::optional<Round::Decision> Round::ChoosePlan(const TubeScene& scene) {
  c_.observer.OnStep("planning");
  const double began = WallClock_s();
  const std::vector<Vector3> points_N = VoxelDownsample(views_.clouds(), c_.cell.bin);
  const PickProblem problem = Problem(scene, points_N);
  PlanResult result = PlanPicks(
      problem, c_.setup.evaluate,
      PathFeasibility(c_.executor.planner(), c_.cell.bin, c_.setup.cycle, c_.setup.part.radius_m),
      c_.setup.seed);
  c_.report.rejections = result.rejections;
  std::stable_partition(result.plans.begin(), result.plans.end(),
                        [this](const PickPlan& plan) { return !FailedBefore(plan); });
  std::optional<Decision> decision;
  if (auto runnable = FirstRunnable(problem, result.plans, c_.executor.planner(), c_.setup.cycle,
                                    c_.executor.Start(), c_.report.rejections)) {
    PickPlan& plan = result.plans[runnable->index];
    const Polyline& line_N = TubeOf(scene, plan.target).centerline_N;
    decision = Decision{{}, {}, std::move(plan), std::move(runnable->path), line_N};
  }
  c_.report.compute_s.evaluator += result.evaluator_s;
  c_.report.compute_s.planning += WallClock_s() - began - result.evaluator_s;
  c_.observer.OnScene(scene, decision ? &decision->plan : nullptr);
  return decision;
}

Round::AttemptStep Round::Pick(const Decision& decision) {
  c_.report.plan = decision.plan;
  const GraspStep grasp = GraspTube(decision);
  if (!grasp.step.ok()) return {grasp.step};
  if (!grasp.miss.empty()) {
    c_.report.reason = grasp.miss;
    Remember(decision.plan);
    return {OpenAndRetreat(c_, decision.plan.grasp.opening_m), AttemptOutcome::kNothingHeld};
  }
  const RigidTransform X_NE = c_.cell.bin.X_BN.inverse() * c_.executor.X_BE();
  const Polyline line_E = Transformed(X_NE.inverse(), decision.line_N);
  c_.Hold(line_E);
  const Weighing weighing = LiftAndWeigh(decision);
  if (!weighing.step.ok()) return {weighing.step};
  return FinishHeld(decision.plan, line_E, weighing.detection);
}

// Approach, guarded descent, closing.
Round::GraspStep Round::GraspTube(const Decision& decision) {
  const PickPlan& plan = decision.plan;
  const CheckedPath& path = *decision.path;
  c_.observer.OnStep("approaching tube " + std::to_string(plan.target) + " (" +
                     ToString(plan.target_class) + "), motion " + plan.motion.name);
  const CycleContext::During reaching(c_, &AttemptReport::Phases::reach);
  if (StepOutcome step = c_.Run(path, kApproachStage); !step.ok()) return {step, ""};
  // The tool weighs pointing down, so its own weight is taken off pointing down.
  if (StepOutcome step = Tare(c_); !step.ok()) return {step, ""};
  const StepOutcome descent = c_.Run(path, kDescendStage);
  if (!descent.ok()) return {descent, ""};
  const RigidTransform X_BE =
      ToolPoseAtGrasp(plan.grasp, c_.setup.part.radius_m, c_.cell.model.gripper, c_.cell.bin);
  const double short_m = (c_.executor.X_BE().translation() - X_BE.translation()).norm();
  if (descent.contact() && short_m > kContactSlack_m) {
    return {
        {},
        "met something " + std::to_string(static_cast<int>(1e3 * short_m)) + " mm above the grasp"};
  }
  const CycleContext::During closing(c_, &AttemptReport::Phases::close);
  c_.observer.OnStep("closing");
  if (StepOutcome step = c_.Run(path, kCloseStage); !step.ok()) return {step, ""};
  const bool nothing = c_.executor.fingers().opening_m < kNothingOpening_m;
  return {{}, nothing ? "the fingers closed on nothing" : ""};
}

// A small lift, weigh, the rest of the motion, weigh for good.
Weighing Round::LiftAndWeigh(const Decision& decision) {
  const CheckedPath& path = *decision.path;
  c_.cell.arm.SetPayload(c_.setup.part.mass_kg, c_.cell.model.layout.X_FE.translation());
  const CycleContext::During lifting(c_, &AttemptReport::Phases::lift);
  c_.observer.OnStep("lifting 3 cm");
  if (StepOutcome step = c_.Run(path, kFirstLiftStage); !step.ok()) return {step, {}};
  Weighing first = Weigh(c_, kFirstSettle_s);
  if (!first.step.ok()) return first;
  c_.report.first_weighing = first.detection;
  c_.observer.OnStep("lifting (" + decision.plan.motion.name + ")");
  if (StepOutcome step = c_.Run(path, kMotionStage); !step.ok()) return {step, {}};
  c_.observer.OnStep("weighing");
  Weighing weighing = WeighHeld(c_, c_.setup.cycle.settle_s);
  if (!weighing.step.ok()) return weighing;
  c_.report.detection = weighing.detection;
  c_.observer.OnDetection(weighing.detection);
  return weighing;
}

Round::AttemptStep Round::FinishHeld(const PickPlan& plan, const Polyline& line_E,
                                     const Detection& detection) {
  HeldOutcome held = detection.outcome;
  if (held == HeldOutcome::kSeveral) {
    c_.observer.OnSeveral(Stored(line_E));
    if (c_.setup.cycle.end_at_several) return {{}, AttemptOutcome::kPutBack, true};
    c_.report.resolution_used = c_.strategy.make != nullptr;
    const HeldStep resolved = Resolve(c_, detection.torque_Nm);
    if (!resolved.step.ok()) return {resolved.step};
    held = resolved.held;
    if (c_.report.resolution_used) c_.report.resolution_outcome = held;
  }
  if (held != HeldOutcome::kOne) return GiveUpHeld(plan, held);
  const PlaceStep placed = Place(c_, line_E);
  if (!placed.step.ok() || placed.outcome == AttemptOutcome::kPlaced) {
    return {placed.step, placed.outcome};
  }
  const CycleContext::During recovering(c_, &AttemptReport::Phases::recover);
  PathBuilder open = c_.Path();
  open.Open("opening", c_.gripper.spec.stroke_m);
  return {c_.CheckAndRun(open.path()), placed.outcome};
}

Round::AttemptStep Round::GiveUpHeld(const PickPlan& plan, HeldOutcome held) {
  Remember(plan);
  const StepOutcome back = PutBack(c_);
  if (!back.ok()) return {back};
  if (held == HeldOutcome::kSeveral) {
    c_.report.reason = "several tubes hung in the fingers";
    return {{}, AttemptOutcome::kPutBack};
  }
  c_.report.reason = "the tube slipped out of the fingers";
  return {{}, AttemptOutcome::kNothingHeld};
}

std::optional<RoundReport> Round::After(const AttemptStep& attempt) {
  if (attempt.end_round) return End(RoundEnd::kStored, "several tubes hang in the fingers");
  if (attempt.step.ok()) {
    EndAttempt(attempt.outcome, "");
    return std::nullopt;
  }
  return attempt.step.refused() ? AfterRefusal(attempt.step) : AfterTrouble(attempt.step);
}

// What hangs in the fingers goes back into the bin, and the next attempt looks and plans anew. With
// nothing held a refusal is no fault: unless the arm cannot even look, the next plan is the answer.
std::optional<RoundReport> Round::AfterRefusal(const StepOutcome& refused) {
  const bool held = HoldsSomething();
  if (c_.report.plan) Remember(*c_.report.plan);
  if (held) {
    ++refusals_;
    const StepOutcome back = PutBack(c_);
    if (back.refused()) {
      EndAttempt(AttemptOutcome::kFault, refused.reason);
      return End(RoundEnd::kFault,
                 refused.reason + "; what is held cannot be put back: " + back.reason);
    }
    if (!back.ok()) return AfterTrouble(back);
  }
  EndAttempt(held ? AttemptOutcome::kPutBack : AttemptOutcome::kNothingHeld, refused.reason);
  if (refusals_ > kMaxRefusals || (!held && first_count_ < 0)) {
    return End(RoundEnd::kNoPlan, "a motion was refused: " + refused.reason);
  }
  return std::nullopt;
}

std::optional<RoundReport> Round::AfterTrouble(const StepOutcome& trouble) {
  EndAttempt(AttemptOutcome::kFault, trouble.reason);
  if (trouble.device == WaitOutcome::Status::kInterrupted) {
    return End(RoundEnd::kInterrupted, trouble.reason);
  }
  if (GoOnAfterStop(c_, trouble) == Acknowledgement::kGoOn) return std::nullopt;
  return End(RoundEnd::kFault, trouble.reason);
}

AttemptCheckpoint Round::Stored(const Polyline& line_E) const {
  const PathStart start = c_.executor.Start();
  return {c_.report,   line_E,  c_.reference_K, c_.attempt_began,
          c_.placed_T, start.q, start.opening_m};
}

bool Round::HoldsSomething() const {
  const GripperState fingers = c_.cell.gripper.State();
  return fingers.object == GripperObject::kContactClosing && fingers.opening_m >= kNothingOpening_m;
}

bool Round::FailedBefore(const PickPlan& plan) const {
  return std::any_of(failed_.begin(), failed_.end(), [&](const auto& failed) {
    return failed.first == plan.motion.name &&
           (failed.second - plan.grasp.X_NG.translation()).norm() < kSameGrasp_m;
  });
}

void Round::Remember(const PickPlan& plan) {
  failed_.emplace_back(plan.motion.name, plan.grasp.X_NG.translation());
}

std::string Round::WhyNoPlan() const {
  std::string out;
  for (const PerceivedTube& tube : views_.scene().tubes) {
    out += (out.empty() ? "tube " : "; tube ") + std::to_string(tube.id) + ": ";
    const auto found = std::find_if(c_.report.rejections.begin(), c_.report.rejections.end(),
                                    [&](const Rejection& r) { return r.tube == tube.id; });
    out += found == c_.report.rejections.end() ? "no candidate" : found->reason;
  }
  return out;
}

}  // namespace tubetwin

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/cycle/cycle_context.h"
#include "planner/cycle/round_steps.h"
#include "planner/cycle/view_scheduler.h"
#include "planner/pick/make_path.h"

namespace tubetwin {

/// One round: emptying one bin, attempt by attempt. Attempt() is the readable list of steps. One
/// thread.
class Round {
 public:
  Round(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer);

  /// What is left in the fingers from before is put back, on a person's word; without it the round
  /// ends before anything moves.
  std::optional<RoundReport> Begin();
  bool AttemptsLeft() const;
  /// One attempt from the look to the end. What ends the round is the answer, if anything does.
  std::optional<RoundReport> Attempt();
  /// Goes on where an attempt was stored, to its end.
  std::optional<RoundReport> FinishStored(const AttemptCheckpoint& state);
  RoundReport End(RoundEnd end, const std::string& reason) const;

 private:
  /// What was decided to be done.
  struct Decision {
    StepOutcome step;
    std::optional<RoundReport> end;  ///< Nothing can be done any more.
    PickPlan plan;
    std::optional<CheckedPath> path;
    Polyline line_N;  ///< The target's centerline.
  };
  /// How an attempt went on. Not ok: the attempt was not brought to an end.
  struct AttemptStep {
    StepOutcome step;
    AttemptOutcome outcome = AttemptOutcome::kNothingHeld;
    bool end_round = false;  ///< The round is to end here, the attempt being stored.
  };

  struct GraspStep {
    StepOutcome step;
    std::string miss;  ///< Why the grasp did not take; empty: something is between the fingers.
  };

  void BeginAttempt();
  void EndAttempt(AttemptOutcome outcome, const std::string& reason);

  StepOutcome RescanUntilConsistent();
  Decision Decide();
  std::optional<Decision> ChoosePlan(const TubeScene& scene);
  Decision NothingLeft(const TubeScene& scene);
  AttemptStep Pick(const Decision& decision);
  GraspStep GraspTube(const Decision& decision);
  Weighing LiftAndWeigh(const Decision& decision);
  AttemptStep FinishHeld(const PickPlan& plan, const Polyline& line_E, const Detection& detection);
  AttemptStep GiveUpHeld(const PickPlan& plan, HeldOutcome held);

  /// What follows from an attempt that was not brought to its end.
  std::optional<RoundReport> After(const AttemptStep& step);
  std::optional<RoundReport> AfterRefusal(const StepOutcome& refused);
  std::optional<RoundReport> AfterTrouble(const StepOutcome& trouble);

  AttemptCheckpoint Stored(const Polyline& line_E) const;
  PickProblem Problem(const TubeScene& scene, const std::vector<Vector3>& points_N) const;
  bool FailedBefore(const PickPlan& plan) const;
  void Remember(const PickPlan& plan);
  bool HoldsSomething() const;
  std::string LeftOver() const;
  /// Every tube that is left, with the first reason against it.
  std::string WhyNoPlan() const;

  CycleContext c_;
  ViewScheduler views_;
  std::vector<std::pair<std::string, Vector3>> failed_;  ///< Since the last placed tube.
  int attempt_ = 1;
  int attempts_ = 0;
  int first_count_ = -1;
  int expected_ = -1;  ///< Tubes that the next look should find at most; -1: unknown.
  int refusals_ = 0;   ///< Attempts of this round that a refused motion ended with a tube held.
};

}  // namespace tubetwin

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "planner/cycle/pick_cycle.h"
#include "tests/support/catch.h"
#include "tests/support/fake_world.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin::test {

/// Remembers all that a pick cycle tells.
class CycleNotes : public CycleObserver {
 public:
  void OnStep(const std::string& caption) override { steps.push_back(caption); }
  void OnScene(const TubeScene& scene, const PickPlan* plan) override {
    scenes.push_back(scene);
    if (plan != nullptr) plans.push_back(*plan);
    if (on_scene) on_scene();
    if (plan != nullptr && on_plan) on_plan();
  }
  void OnReference(const Wrench& reference_K) override { references_K.push_back(reference_K); }
  void OnDetection(const Detection& detection) override { detections.push_back(detection); }
  void OnSeveral(const AttemptCheckpoint& state) override { several.push_back(state); }
  void OnAttemptEnd(const AttemptReport& report) override {
    attempts.push_back(report);
    if (on_attempt_end) on_attempt_end();
  }
  std::function<void()> on_scene, on_plan, on_attempt_end;  ///< For scripts; may be empty.

  std::vector<std::string> steps;
  std::vector<TubeScene> scenes;
  std::vector<PickPlan> plans;
  std::vector<Wrench> references_K;
  std::vector<Detection> detections;
  std::vector<AttemptCheckpoint> several;
  std::vector<AttemptReport> attempts;
};

/// Two tubes far from each other and from the walls of FakeWorld::SmallBin.
inline std::vector<Polyline> TwoTubes() {
  return {StraightLine({-0.15, -0.05, 0.0125}, {0.08, -0.07, 0.0125}),
          StraightLine({-0.05, 0.09, 0.0125}, {0.18, 0.08, 0.0125})};
}

/// A round in a fake world: what to ask of it, and what came of it.
///
///     FakeRound round(world);
///     round.setup.resolution.strategy = "plus45";
///     round.Run(2);
///     CHECK(round.outcome(1) == "placed");
struct FakeRound {
  explicit FakeRound(FakeWorld& w) : world(w) {
    setup.part = world.part;
    setup.scan.overhead_m = 0.75;  // One view sees the small bin.
    // Few plans are checked: it is not planning that is tested here.
    setup.planner.max_plans = 3;
    setup.planner.nudges = 0;
    setup.evaluate = Harmless;
    setup.stop_requested = [this] {
      return static_cast<int>(notes.attempts.size()) >= attempts_wanted;
    };
  }
  FakeRound(const FakeRound&) = delete;
  FakeRound& operator=(const FakeRound&) = delete;

  /// Runs the cycle until the round ends or so many attempts are over. No robot may do what the
  /// world calls a fault.
  void Run(int attempts = 1000) {
    attempts_wanted = attempts;
    report = RunPickCycle(world.cell, setup, notes);
    CheckFaults();
  }
  void CheckFaults() const {
    for (const std::string& fault : world.faults) FAIL_CHECK(fault);
  }

  const AttemptReport& attempt(std::size_t k) const {
    INFO("attempt " << k << " of " << notes.attempts.size() << "; the round: " << report.reason);
    REQUIRE(k < notes.attempts.size());
    return notes.attempts[k];
  }
  /// Of the k-th attempt, from 0, as in result files.
  std::string outcome(std::size_t k) const { return ToString(attempt(k).outcome); }
  std::string end() const { return ToString(report.end); }
  std::string attempts_text() const {
    std::string out;
    for (const AttemptReport& a : notes.attempts) {
      out += std::string(ToString(a.outcome)) + " (" + a.reason + "); ";
    }
    return out + "end: " + end() + " (" + report.reason + ")";
  }

  /// Says of every motion that it takes its tube alone and moves no other.
  static EvaluationResult Harmless(const TubeScene&, const Part&, const Bin&,
                                   const EvaluationRequest& request) {
    EvaluationResult out;
    for (const CandidateMotion& motion : request.candidates) {
      CandidateScore score;
      static_cast<ObjectPath&>(score) = motion;
      score.tube = motion.tube;
      score.motion = motion.name;
      score.samples.assign(static_cast<std::size_t>(request.samples), 0.0);
      out.candidates.push_back(score);
    }
    out.best = out.candidates.empty() ? -1 : 0;
    return out;
  }

  FakeWorld& world;
  PickCycleSetup setup;
  CycleNotes notes;
  RoundReport report;
  int attempts_wanted = 1000;
};

}  // namespace tubetwin::test

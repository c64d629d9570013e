#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/cell/cell.h"
#include "models/base/parallel.h"
#include "perception/perceive.h"
#include "planner/cycle/attempt_checkpoint.h"
#include "planner/cycle/attempt_report.h"
#include "planner/cycle/cycle_config.h"
#include "planner/pick/pick_plan.h"
#include "planner/resolution/strategy.h"

namespace tubetwin {

/// Hears what the cycle does; for recordings, progress and scoring. Default: nothing.
class CycleObserver {
 public:
  virtual ~CycleObserver() = default;
  virtual void OnStep(const std::string& /*caption*/) {}
  /// A fresh look into the bin; `plan` is the chosen one or null.
  virtual void OnScene(const TubeScene& /*scene*/, const PickPlan* /*plan*/) {}
  virtual void OnClouds(const std::vector<OrganizedCloud>& /*views*/) {}
  /// Load along gravity was tared.
  virtual void OnReference(const Wrench& /*reference_K*/) {}
  /// The decision how many hang in the fingers, before any resolution.
  virtual void OnDetection(const Detection& /*detection*/) {}
  /// Several hang in the fingers, and nothing was done about it yet; the arm is at rest.
  virtual void OnSeveral(const AttemptCheckpoint& /*state*/) {}
  virtual void OnAttemptEnd(const AttemptReport& /*report*/) {}
};

/// What an operator says to a stop.
enum class Acknowledgement { kGoOn, kEnd };

/// Everything the cycle needs besides the cell.
struct PickCycleSetup {
  Part part;
  PerceptionConfig perception;
  PlannerConfig planner;
  ScanConfig scan;
  ResolutionConfig resolution;
  CycleConfig cycle;
  /// In place of the registry's strategy that `resolution` names.
  std::optional<ResolutionStrategy> strategy;
  /// In place of the registry's motions that `planner` names.
  std::optional<std::vector<ExtractionMotion>> motions;
  std::uint64_t seed = 1;
  EvaluateFunction evaluate;
  Parallelism parallelism;
  std::function<bool()> stop_requested;  ///< Asked between attempts; may be empty.
  /// Asked after a protective or emergency stop or an alarm, and before what an earlier program
  /// left in the fingers is put back, with what happened: only kGoOn, a person's word that the
  /// cause is gone, lets the cycle go on. Empty: nobody is there.
  std::function<Acknowledgement(const std::string&)> acknowledge;
};

/// Empties the bin, unless something is left in the fingers from before (see left_over.h): scan,
/// model, plan, approach, grasp, weigh, resolve, place, until the scan shows an empty bin or
/// nothing can be taken. Does not know whether the cell is simulated.
RoundReport RunPickCycle(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer);

/// The rest of the attempt in which a cell was stored: resolution, then placing or putting back,
/// with the strategy of `setup`. `cell` must stand as it stood then.
RoundReport ResumeAttempt(Cell& cell, const PickCycleSetup& setup, const AttemptCheckpoint& state,
                          CycleObserver& observer);

}  // namespace tubetwin

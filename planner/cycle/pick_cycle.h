#pragma once

#include <functional>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "models/base/parallel.h"
#include "perception/perceive.h"
#include "planner/cycle/attempt_checkpoint.h"
#include "planner/cycle/attempt_report.h"

namespace tubetwin {

/// Config table [scan].
struct ScanConfig {
  int views = 8;                        ///< Of the default poses, from the first.
  std::string resolution = "1032x772";  ///< Or "2064x1544".
  /// One view straight down on the bin's centre from so high over its floor, image along the long
  /// side, in place of the scan poses; 0: the scan poses.
  double overhead_m = 0.0;
  bool rescan_all = false;  ///< Later scans of a round look everywhere again.
  void Visit(ConfigVisitor& v);
};

/// Config table [resolution]: what is done when several tubes hang in the fingers.
struct ResolutionConfig {
  std::string strategy = "plus45_minus45";
  double angle_deg = 45.0;
  double speed_deg_s = 20.0;
  void Visit(ConfigVisitor& v);
};

/// Config table [cycle]: speeds, forces and waits of the pick cycle.
struct CycleConfig {
  double transfer_speed_m_s = 0.6, transfer_acceleration_m_s2 = 1.0;
  double approach_speed_m_s = 0.20, guarded_speed_m_s = 0.02;
  double guard_force_N = 8.0;
  double grip_force_N = 60.0, grip_speed_m_s = 0.10;
  double approach_m = 0.08;  ///< Height over the grasp where the fast part ends.
  double guarded_m = 0.010;  ///< Last part of the descent, guarded.
  double first_lift_m = 0.03;
  double settle_s = 2.0;  ///< At most, until the load stands still after a motion.
  double weigh_window_s = 0.2;
  double tolerance_share = 0.5;  ///< F_tol in tube weights.
  /// The round ends where several tubes hang in the fingers, once the observer has heard of it.
  bool end_at_several = false;
  int attempts_per_tube = 4;  ///< The round ends after this many times the first count, plus ten.
  void Visit(ConfigVisitor& v);
};

/// Where a round looks from, X_BS.
std::vector<RigidTransform> ScanPoses(const ScanConfig& config, const Bin& bin);

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
  std::uint64_t seed = 1;
  EvaluateFunction evaluate;
  Parallelism parallelism;
  std::function<bool()> stop_requested;  ///< Asked between attempts; may be empty.
  /// Asked after a protective or emergency stop or an alarm, with what happened: only kGoOn, a
  /// person's word that the cause is gone, lets the cycle go on. Empty: nobody is there.
  std::function<Acknowledgement(const std::string&)> acknowledge;
};

/// Empties the bin: scan, model, plan, approach, grasp, weigh, resolve, place, until the scan shows
/// an empty bin or nothing can be taken. Does not know whether the cell is simulated.
RoundReport RunPickCycle(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer);

/// The rest of the attempt in which a cell was stored: resolution, then placing or putting back,
/// with the strategy of `setup`. `cell` must stand as it stood then.
RoundReport ResumeAttempt(Cell& cell, const PickCycleSetup& setup, const AttemptCheckpoint& state,
                          CycleObserver& observer);

}  // namespace tubetwin

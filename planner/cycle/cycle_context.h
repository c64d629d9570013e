#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "planner/cycle/motion_executor.h"
#include "planner/cycle/pick_cycle.h"
#include "planner/grasp/held_part.h"

namespace tubetwin {

/// Wall clock of the pipeline's own computing, seconds. For reports only: no decision reads it.
inline double ComputeClock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct CycleContext;
/// Lets time pass until the load on the sensor no longer swings, `most_s` at most: the means of
/// successive windows, over one period of the held part at least, within a share of what weighing
/// must tell apart.
void WaitForSteadyLoad(CycleContext& context, double most_s);

/// What the steps of one round share. One per RunPickCycle; all steps run on the caller's thread.
struct CycleContext {
  Cell& cell;
  const PickCycleSetup& setup;
  CycleObserver& observer;
  MotionExecutor executor;
  AttemptReport report;  ///< Of the running attempt.
  Wrench reference_K;    ///< Tare with empty fingers, tool vertical.
  TimeNs attempt_began{0};
  HeldPart held;                   ///< How what the fingers closed on gives way.
  std::vector<Polyline> placed_T;  ///< Tubes on the tray, as they were laid.

  /// Adds the simulated time that passes during its life to one class of the report.
  class Timed {
   public:
    Timed(CycleContext& context, double AttemptReport::SimTime::*which)
        : context_(context), which_(which), began_(context.cell.clock.Now()) {}
    ~Timed() { context_.report.sim_s.*which_ += Seconds(context_.cell.clock.Now() - began_); }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

   private:
    CycleContext& context_;
    double AttemptReport::SimTime::*which_;
    TimeNs began_;
  };

  /// Mean wrench over `duration_s`. Throws MoveFailure when it cannot be believed.
  Wrench MeanWrench(double duration_s) {
    const WrenchOutcome wrench = AverageWrench(cell, duration_s);
    if (wrench.outcome.status != WaitOutcome::Status::kDone) {
      throw MoveFailure(wrench.outcome, "weighing");
    }
    return wrench.mean_K;
  }

  /// Moves the fingers. Those that still move at the end of the wait are judged by their opening
  /// and by weight. Throws MoveFailure on a gripper's fault.
  GripperState MoveFingers(const GripperCommand& command) {
    const GripperOutcome fingers = MoveGripper(cell, command);
    if (fingers.outcome.status == WaitOutcome::Status::kGripperFault) {
      throw MoveFailure(fingers.outcome, "fingers");
    }
    return fingers.state;
  }

  /// From now on the fingers hold a part that lies so in frame E, or nothing.
  void Hold(const Polyline& line_E) {
    held = HeldPartOf(line_E, setup.part);
    executor.SetLeastRamp(held.period_s);
  }
  void LetGo() { Hold({}); }

  /// Waits until the load stands still, `most_s` at most, averages and compares with the reference.
  /// Tool vertical and at rest.
  Detection Weigh(double most_s) {
    const Timed timed(*this, &AttemptReport::SimTime::weigh);
    WaitForSteadyLoad(*this, most_s);
    const Wrench now_K = MeanWrench(setup.cycle.weigh_window_s);
    Detection out = DetectHeld(reference_K, now_K, setup.part.mass_kg,
                               setup.cycle.tolerance_share * setup.part.mass_kg * kGravity);
    out.at_s = Seconds(cell.clock.Now() - attempt_began);
    return out;
  }
};

/// Looking into the bin: which views to take again, the clouds, and the scene they give.
class ViewScheduler {
 public:
  explicit ViewScheduler(CycleContext& context);

  /// Everything may have moved: the next Look goes to every view.
  void MarkAll();
  /// Only what touches this tube may have moved: views that see it or what it touches.
  void MarkAround(int tube_id);
  /// Moves to the marked views, scans, models. False positives of motion cost time only. Throws
  /// Error(kDevice) when the scanner fails; MoveFailure when a view cannot be reached.
  const TubeScene& Look();
  bool all_fresh() const;  ///< Every view of the last Look was taken by it.
  const TubeScene& scene() const { return scene_; }
  const std::vector<OrganizedCloud>& views() const { return views_; }

 private:
  bool Sees(std::size_t view, const Polyline& line_N) const;
  CycleContext& context_;
  std::vector<RigidTransform> poses_BS_;
  std::vector<OrganizedCloud> views_;
  std::vector<bool> marked_, taken_last_;
  TubeScene scene_;
};

/// Tries to shake off all but the held tube; leaves the arm at the tilt station, level. The outcome
/// is how many hang then.
HeldOutcome Resolve(CycleContext& context, const Vector3& load_torque_K);

/// Lowers what hangs in the fingers into the bin until it is felt or the fingers are near the
/// floor, opens and retreats.
void PutBack(CycleContext& context);

/// Lays the held tube into the next slot. `line_E`: its centerline relative to E. The outcome is
/// kPlaced, or kDropped when the tube was lost on the way.
AttemptOutcome Place(CycleContext& context, const Polyline& line_E);

/// Where no tube can be grasped: pushes one to where it can be and puts that into the report.
/// Closed fingers press on it until the wrist feels it, drag it along under a force limit and come
/// up again. The tube's id, or nothing when no tube can be pushed or it was done often enough.
std::optional<int> TryNudge(CycleContext& context, const TubeScene& scene,
                            const std::vector<OrganizedCloud>& views);

/// After a stop or fault of the arm: asks the operator, if there is one, and goes on only on their
/// word: ready again, straight up, what is held back into the bin.
Acknowledgement GoOnAfterStop(CycleContext& context, const MoveFailure& failure);

}  // namespace tubetwin

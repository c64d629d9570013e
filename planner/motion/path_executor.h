#pragma once

#include <optional>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "planner/motion/pick_path.h"

namespace tubetwin {

/// How a step of the cycle ended. Nothing of it is an exception: refusals and devices' trouble are
/// answers, and whoever asked decides.
struct [[nodiscard]] StepOutcome {
  enum class Status {
    kDone,
    kContact,  ///< Done as far as a guarded line let it: it met something.
    kRefused,  ///< A motion could not be planned; it was not begun.
    kTrouble,  ///< A device did not do as it was told.
  } status = Status::kDone;
  /// Of trouble, what the cell said; of contact, kContact.
  WaitOutcome::Status device = WaitOutcome::Status::kDone;
  std::string reason;

  /// Done, with or without contact.
  bool ok() const { return status == Status::kDone || status == Status::kContact; }
  bool contact() const { return status == Status::kContact; }
  bool refused() const { return status == Status::kRefused; }

  /// `what` is said before the outcome's own reason.
  static StepOutcome Refused(const std::string& reason);
  static StepOutcome Trouble(const WaitOutcome& outcome, const std::string& what);
};

/// Runs checked paths on a cell and knows where its arm stands. Motions run as they were checked;
/// where the arm does not stand where a segment begins (a guarded line ended early, something
/// pushed it), that segment is planned anew to the same goal from the measured joints, with all
/// checks. One per pick cycle; all calls from its thread.
class PathExecutor {
 public:
  /// `cell` must outlive this.
  explicit PathExecutor(Cell& cell);

  const MotionPlanner& planner() const { return planner_; }
  /// Where the next motion starts: the end of the last one, the measured joints where one was
  /// stopped or something pushed the arm a little.
  PathStart Start() const;
  /// Where E is there.
  RigidTransform X_BE() const { return planner_.PoseOfE(Start().q); }
  /// What the fingers said after they last moved.
  const GripperState& fingers() const { return fingers_; }

  PathCheck Check(const PickPath& path) const { return tubetwin::Check(planner_, path, Start()); }

  /// Runs one stage of a path. Contact ends it.
  StepOutcome Run(const CheckedPath& path, int stage);
  /// Runs all stages, one after the other.
  StepOutcome Run(const CheckedPath& path);
  /// Checks a path from where the arm stands and runs it, if all of it can be run.
  StepOutcome CheckAndRun(const PickPath& path);

  /// Goes on from where the arm stands now, with the opening that the gripper says.
  void Resync();
  /// Goes on as an executor whose last motion ended so.
  void Resume(const PathStart& start) { start_ = start; }

 private:
  /// Nobody pushes an arm at rest further than it may leave its path: what it says is wrong then,
  /// or somebody else moves it.
  std::optional<WaitOutcome> Displaced() const;
  StepOutcome RunSegment(const CheckedPath::Segment& segment);
  StepOutcome RunMotion(const CheckedPath::Segment& segment);
  StepOutcome RunFingers(const PathSegment& segment, const MoveFingers& fingers);

  Cell& cell_;
  MotionPlanner planner_;
  PathStart start_;
  GripperState fingers_;
};

}  // namespace tubetwin

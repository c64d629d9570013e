#pragma once

#include <functional>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {

/// A cell whose devices do exactly what a test tells them, on a clock that only counts: the arm is
/// where its trajectory says, the gripper arrives at once, the wrist weighs nothing. What a command
/// brings about in the world is the test's to say, through the functions that the devices call
/// (FakeWorld does so for a bin of tubes).
class FakeCell {
 public:
  FakeCell();
  FakeCell(const FakeCell&) = delete;
  FakeCell& operator=(const FakeCell&) = delete;

  class Clock : public CellClock {
   public:
    TimeNs Now() const override { return now_; }
    void AdvanceTo(TimeNs t) override;
    std::function<void()> each_period;  ///< Called after every control period.

   private:
    TimeNs now_{0};
  };

  class FakeArm : public Arm {
   public:
    explicit FakeArm(const Clock& clock) : clock_(clock) {}
    ArmState State() const override;
    CommandResult Start(const CheckedTrajectory& trajectory) override;
    CommandResult Append(const CheckedTrajectory&) override { return {}; }
    void Stop(StopKind kind) override;
    void SetPayload(double mass_kg, const Vector3&) override { payload_kg = mass_kg; }
    CommandResult Recover() override;
    std::function<void(const CheckedTrajectory&)> on_start;  ///< Called when a motion has begun.

    std::function<void(ArmState&)> lie;  ///< What it says instead of the truth; may be empty.

    JointVector q = JointVector::Zero();       ///< Where it stands.
    JointVector offset = JointVector::Zero();  ///< Of what it reports while it moves.
    JointVector pushed = JointVector::Zero();  ///< Of what it reports at rest.
    ArmMode mode = ArmMode::kReady;            ///< Set by a test: stops the motion.
    std::string fault;
    bool silent = false;   ///< The state's time stands still.
    bool stuck = false;    ///< Progress stands still.
    bool recovers = true;  ///< Recover makes it ready.
    int started = 0, stopped = 0, recovered = 0;
    StopKind last_stop = StopKind::kOnPath;
    double last_planned_s = 0.0;
    double payload_kg = 0.0;

   private:
    void Update() const;
    const Clock& clock_;
    JointTrajectory trajectory_;
    mutable TimeNs began_{0}, newest_{0};
    mutable double progress_s_ = 0.0;
    mutable bool moving_ = false, done_ = true;
  };

  class FakeGripper : public Gripper {
   public:
    explicit FakeGripper(const Clock& clock) : clock_(clock) {}
    void Command(const GripperCommand& command) override;
    GripperState State() const override;
    std::function<void(const GripperCommand&)> on_command;  ///< Called after `state` was set.
    std::function<void(GripperState&)> lie;  ///< What it says instead of `state`; may be empty.
    GripperState state;
    bool silent = false;
    int commands = 0;

   private:
    const Clock& clock_;
    mutable TimeNs newest_{0};
  };

  class FakeWrist : public ForceTorqueSensor {
   public:
    explicit FakeWrist(const Clock& clock) : clock_(clock) {}
    WrenchSample Read() const override;
    Wrench load_K;
    std::function<Wrench()> weigh;           ///< In place of load_K.
    std::function<void(WrenchSample&)> lie;  ///< What it says instead; may be empty.
    bool silent = false, saturated = false;

   private:
    const Clock& clock_;
    mutable TimeNs newest_{0};
  };

  class FakeScanner : public Scanner {
   public:
    CommandResult Trigger() override;
    ScanStatus Status() const override { return status_; }
    OrganizedCloud Take() override;
    std::string FailureReason() const override { return "told to fail"; }
    std::function<OrganizedCloud()> look;  ///< What a scan shows; an empty cloud without it.
    int failures = 0;                      ///< The next scans fail.
    int triggered = 0;

   private:
    ScanStatus status_ = ScanStatus::kIdle;
  };

  /// May be narrowed by a test: what the planner then refuses is refused for a real reason.
  CellModel model = PaperCell();
  Clock clock;
  FakeArm arm{clock};
  FakeGripper gripper{clock};
  FakeWrist wrist{clock};
  FakeScanner scanner;
  Cell cell;

  /// From where the arm stands, `angle_rad` with every joint, in `duration_s`.
  CheckedTrajectory Move(double angle_rad, double duration_s) const;
};

}  // namespace tubetwin::test

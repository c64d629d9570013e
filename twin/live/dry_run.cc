#include "twin/live/dry_run.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "models/arm/arm.h"

namespace tubetwin {
namespace {

/// Follows trajectories exactly, and refuses what a real arm would.
class DryArm : public Arm {
 public:
  DryArm(const CellClock& clock, const Arm& real, const Gripper& gripper)
      : clock_(clock), gripper_(gripper), q_(real.State().q) {}

  ArmState State() const override {
    ArmState state;
    state.time = clock_.Now();
    state.q = q_;
    if (path_.points.empty()) return state;
    state.planned_s = path_.duration_s();
    state.progress_s = std::min(Seconds(clock_.Now() - began_), end_s_);
    const TrajectoryPoint point = Sample(path_, state.progress_s);
    const bool moves = state.progress_s < end_s_;
    state.q = point.q;
    if (moves) state.qd = point.qd;
    state.mode = moves ? ArmMode::kMoving : ArmMode::kReady;
    state.done = state.progress_s >= state.planned_s;
    return state;
  }
  CommandResult Start(const CheckedTrajectory& trajectory) override {
    const ArmState now = State();
    if (now.mode != ArmMode::kReady) return Rejected("a trajectory still runs");
    if ((now.q - trajectory.trajectory().points.front().q).cwiseAbs().maxCoeff() > Radians(0.2)) {
      return Rejected("the first point is more than 0.2 degrees away");
    }
    path_ = trajectory.trajectory();
    end_s_ = path_.duration_s();
    began_ = clock_.Now();
    motions_.push_back({path_, gripper_.State().opening_m});
    return {};
  }
  CommandResult Append(const CheckedTrajectory&) override {
    return Rejected("a dry run appends nothing");
  }
  void Stop(StopKind) override { end_s_ = State().progress_s; }
  void SetPayload(double, const Vector3&) override {}
  const std::vector<RehearsedMotion>& motions() const { return motions_; }

 private:
  static CommandResult Rejected(const char* why) { return {CommandResult::Status::kRejected, why}; }
  const CellClock& clock_;
  const Gripper& gripper_;  ///< The rehearsed one.
  JointVector q_;
  std::vector<RehearsedMotion> motions_;
  JointTrajectory path_;
  double end_s_ = 0.0;
  TimeNs began_{0};
};

/// Arrives wherever it is sent, or closes on what it is told to hold.
class DryGripper : public Gripper {
 public:
  DryGripper(const CellClock& clock, const Gripper& real, double held_m)
      : clock_(clock), held_m_(held_m) {
    from_m_ = to_m_ = asked_m_ = real.State().opening_m;
  }
  void Command(const GripperCommand& command) override {
    ++commands_;
    from_m_ = State().opening_m;
    asked_m_ = command.opening_m;
    meets_ = asked_m_ < held_m_ && from_m_ >= held_m_;
    to_m_ = meets_ ? held_m_ : asked_m_;
    speed_m_s_ = command.speed_m_s;
    began_ = clock_.Now();
  }
  GripperState State() const override {
    GripperState state;
    state.time = clock_.Now();
    state.requested_m = asked_m_;
    const double gone_m = speed_m_s_ * Seconds(clock_.Now() - began_);
    const bool there = gone_m >= std::abs(to_m_ - from_m_);
    state.opening_m = there ? to_m_ : from_m_ + std::copysign(gone_m, to_m_ - from_m_);
    state.object = !there   ? GripperObject::kMoving
                   : meets_ ? GripperObject::kContactClosing
                            : GripperObject::kAtPosition;
    return state;
  }
  int commands() const { return commands_; }

 private:
  const CellClock& clock_;
  double held_m_;
  int commands_ = 0;
  bool meets_ = false;
  double asked_m_ = 0.0;
  double from_m_, to_m_, speed_m_s_ = 0.1;
  TimeNs began_{0};
};

/// What the real one reads, and the weight of what the rehearsed fingers hold between them.
class DryWrist : public ForceTorqueSensor {
 public:
  DryWrist(const Cell& real, const DryArm& arm, const DryGripper& gripper, double held_kg)
      : real_(real), arm_(arm), gripper_(gripper), held_kg_(held_kg) {}
  WrenchSample Read() const override {
    WrenchSample sample = real_.wrist.Read();
    if (gripper_.State().object != GripperObject::kContactClosing) return sample;
    const CellLayout& layout = real_.model.layout;
    const Matrix3 R_BK =
        FlangePose(real_.model.arm, arm_.State().q).linear() * layout.X_FK.linear();
    const Vector3 weight_K = R_BK.transpose() * Vector3(0, 0, -held_kg_ * kGravity);
    const Vector3 p_KE = (layout.X_FK.inverse() * layout.X_FE).translation();
    sample.wrench_K.force_N += weight_K;
    sample.wrench_K.torque_Nm += p_KE.cross(weight_K);
    return sample;
  }

 private:
  const Cell& real_;
  const DryArm& arm_;
  const DryGripper& gripper_;
  double held_kg_;
};

}  // namespace

struct DryRunCell::Impl {
  Impl(Cell& real, const RehearsedPart& held)
      : gripper(real.clock, real.gripper, held.width_m),
        arm(real.clock, real.arm, gripper),
        wrist(real, arm, gripper, held.mass_kg),
        cell{real.clock, arm, gripper, wrist, real.scanner, real.model, real.bin, real.safety} {}
  DryGripper gripper;
  DryArm arm;
  DryWrist wrist;
  Cell cell;
};

DryRunCell::DryRunCell(Cell& cell, const RehearsedPart& held)
    : impl_(std::make_unique<Impl>(cell, held)) {}
DryRunCell::~DryRunCell() = default;
Cell& DryRunCell::cell() { return impl_->cell; }
DryRunReport DryRunCell::Report() const {
  return ReportOf(impl_->cell, impl_->arm.motions(), impl_->gripper.commands());
}

}  // namespace tubetwin

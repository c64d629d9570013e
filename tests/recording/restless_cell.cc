#include "tests/recording/restless_cell.h"

#include <cmath>
#include <memory>
#include <utility>

#include "models/base/random.h"
#include "models/base/text.h"
#include "tests/recording/random_events.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

const JointVector kHome = (JointVector() << 0, 0.3, 1.5, 0, -1.2, 0).finished();

class Clock : public CellClock {
 public:
  TimeNs Now() const override { return now; }
  void AdvanceTo(TimeNs t) override {
    // Some clocks wake a little late.
    if (t > now) now = t + TimeNs(late.Index(3) == 0 ? 17 : 0);
  }
  TimeNs now{0};
  RandomStream late{1, 0, "late"};
};

class RestlessArm : public Arm {
 public:
  RestlessArm(const Clock& clock, RandomStream stream) : clock_(clock), stream_(stream) {}
  ArmState State() const override {
    ArmState state;
    state.time = clock_.now;
    const double t_s = std::min(Seconds(clock_.now - began_), trajectory_.duration_s());
    if (trajectory_.points.empty()) {
      state.q = kHome;
      return state;
    }
    const TrajectoryPoint point = Sample(trajectory_, t_s);
    for (int i = 0; i < kNumJoints; ++i) {
      state.q[i] = 1e-5 * std::round(point.q[i] / 1e-5 + stream_.Index(2));
      state.qd[i] = 1e-4 * std::round(point.qd[i] / 1e-4 - 0.3);  // Often -0.
    }
    state.progress_s = t_s;
    state.planned_s = trajectory_.duration_s();
    state.done = stopped_ ? false : t_s >= trajectory_.duration_s();
    state.mode = state.done || stopped_ ? ArmMode::kReady : ArmMode::kMoving;
    return state;
  }
  CommandResult Start(const CheckedTrajectory& trajectory) override {
    if (stream_.Index(6) == 0) return {CommandResult::Status::kRejected, "not now"};
    trajectory_ = trajectory.trajectory();
    began_ = clock_.now;
    stopped_ = false;
    return {};
  }
  CommandResult Append(const CheckedTrajectory&) override {
    return {CommandResult::Status::kRejected, "nothing is appended here"};
  }
  void Stop(StopKind) override { stopped_ = true; }
  void SetPayload(double, const Vector3&) override {}

 private:
  const Clock& clock_;
  mutable RandomStream stream_;
  JointTrajectory trajectory_;
  TimeNs began_{0};
  bool stopped_ = false;
};

class RestlessGripper : public Gripper {
 public:
  RestlessGripper(const Clock& clock, RandomStream stream) : clock_(clock), stream_(stream) {}
  void Command(const GripperCommand& command) override { requested_m_ = command.opening_m; }
  GripperState State() const override {
    GripperState state;
    state.time = clock_.now;
    state.object = stream_.Index(4) == 0 ? GripperObject::kContactClosing : GripperObject::kMoving;
    state.opening_m = 0.085 * stream_.Index(256) / 255.0;
    state.requested_m = requested_m_;
    state.fault = stream_.Index(30) == 0 ? 7 : 0;  // Told, but no trouble.
    return state;
  }

 private:
  const Clock& clock_;
  mutable RandomStream stream_;
  double requested_m_ = 0.085;
};

class RestlessWrist : public ForceTorqueSensor {
 public:
  RestlessWrist(const Clock& clock, RandomStream stream) : clock_(clock), stream_(stream) {}
  WrenchSample Read() const override {
    WrenchSample sample;
    // A device of its own rate: the sample may be an older one.
    sample.time = clock_.now - clock_.now % std::chrono::milliseconds(4);
    for (int i = 0; i < 3; ++i) {
      sample.wrench_K.force_N[i] = std::round(stream_.Normal(0, 20)) / 80.0;
      sample.wrench_K.torque_Nm[i] = stream_.Normal();
    }
    return sample;
  }

 private:
  const Clock& clock_;
  mutable RandomStream stream_;
};

class RestlessScanner : public Scanner {
 public:
  RestlessScanner(RandomStream stream, int width, int height)
      : stream_(stream), width_(width), height_(height) {}
  CommandResult Trigger() override {
    looks_ = 0;
    return {};
  }
  ScanStatus Status() const override {
    return ++looks_ > 2 ? ScanStatus::kReady : ScanStatus::kBusy;
  }
  OrganizedCloud Take() override { return RandomCloud(stream_, width_, height_, true); }
  std::string FailureReason() const override { return "none"; }

 private:
  RandomStream stream_;
  int width_, height_;
  mutable int looks_ = 0;
};

CheckedTrajectory Move(double by_rad) {
  TrajectoryPoint from, to;
  from.q = kHome;
  to.q = kHome + by_rad * JointVector::Ones();
  to.time_s = 0.4;
  const auto checked = CheckTrajectory(PaperCell().arm, {{from, to}});
  REQUIRE(std::holds_alternative<CheckedTrajectory>(checked));
  return std::get<CheckedTrajectory>(checked);
}

std::string Procedure(Cell& cell, int rounds, int planted) {
  std::string heard;
  int command = 0;
  const auto plant = [&] { return command++ == planted ? 0.001 : 0.0; };
  for (int i = 0; i < rounds; ++i) {
    const WaitOutcome moved = RunTrajectory(cell, Move(0.002 + plant()));
    heard += moved.reason + Number(moved.progress_s);
    const WaitOutcome guarded = RunGuarded(cell, Move(0.001 + plant()), 2.0);
    heard += guarded.reason + Number(guarded.progress_s);
    heard += cell.arm.Append(Move(0.03 + plant())).reason;
    heard += Number(MoveGripper(cell, {0.01 * (i % 8) + plant(), 0.1, 60.0}).state.opening_m);
    cell.arm.SetPayload(0.05 + plant(), Vector3(0, 0, 0.1));
    heard += Number(AverageWrench(cell, 0.02).mean_K.force_N.z());
    if (i % 3 == 0) {
      const OrganizedCloud cloud = Scan(cell);
      heard += Bits(cloud);
      heard += cell.scanner.FailureReason();
    }
    cell.arm.Stop(planted == command++ ? StopKind::kFast : StopKind::kOnPath);
    heard += Number(Seconds(cell.clock.Now()));
    Wait(cell, 0.5 + plant());
  }
  return heard;
}

}  // namespace

struct RestlessCell::Impl {
  Impl(const RandomStream& stream, int width, int height)
      : arm(clock, stream.Fork("arm")),
        gripper(clock, stream.Fork("gripper")),
        wrist(clock, stream.Fork("wrist")),
        scanner(stream.Fork("scanner"), width, height),
        cell{clock, arm, gripper, wrist, scanner, PaperCell(), {}, {}} {}
  Clock clock;
  RestlessArm arm;
  RestlessGripper gripper;
  RestlessWrist wrist;
  RestlessScanner scanner;
  Cell cell;
};

RestlessCell::RestlessCell(std::uint64_t seed, int cloud_width, int cloud_height)
    : impl_(std::make_unique<Impl>(RandomStream(seed, 0, "restless"), cloud_width, cloud_height)) {}
RestlessCell::~RestlessCell() = default;
Cell& RestlessCell::cell() { return impl_->cell; }

std::string Exercise(Cell& cell, int rounds) { return Procedure(cell, rounds, -1); }

std::string ExerciseWithPlant(Cell& cell, int rounds, int planted) {
  return Procedure(cell, rounds, planted);
}

}  // namespace tubetwin::test

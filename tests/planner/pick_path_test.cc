#include "planner/motion/pick_path.h"

#include <vector>

#include "models/base/random.h"
#include "models/gripper_spec.h"
#include "planner/motion/path_builder.h"
#include "planner/motion/path_executor.h"
#include "planner/pick/make_path.h"
#include "planner/pick/tool_path.h"
#include "tests/support/catch.h"
#include "tests/support/fake_cell.h"
#include "tests/support/paper_cell.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

constexpr double kSame_m = 1e-6, kSame_rad = 1e-6;  // Rounding of the inverse kinematics.

const MotionPlanner& Planner() {
  static const MotionPlanner planner(PaperCell(), Bin());
  return planner;
}

/// Straight above the bin's floor, pads along the bin's long side.
Grasp GraspAt(double x, double y, double z, double yaw_rad = 0.0) {
  Grasp grasp;
  grasp.tube = 1;
  grasp.X_NG = MakeTransform(RotZ(yaw_rad) * RotX(kPi), Vector3(x, y, z));
  grasp.opening_m = 0.05;
  return grasp;
}

CandidateMotion SlideAndLift(double slide_m) {
  CandidateMotion motion;
  motion.tube = 1;
  motion.kind = motion.name = "slide";
  motion.waypoints_N = {{0, 0, 0}, {slide_m, 0, 0}, {slide_m, 0, 0.4}};
  return motion;
}

PathStart AtView() {
  PathStart start;
  start.q = *Planner().Reach(MakeTransform(RotX(kPi), Vector3(0.6, 0.0, 0.65)));
  return start;
}

PickPath PathOf(const Grasp& grasp, const CandidateMotion& motion, const PathConfig& config = {},
                double radius_m = kRadius) {
  const Bin bin;
  return MakePickPath(grasp, motion, {PaperCell().gripper, bin, config, radius_m, 0.0});
}

CheckedPath Checked(const PickPath& path, const PathStart& start) {
  PathCheck check = Check(Planner(), path, start);
  if (const MotionRejection* refusal = RefusalOf(check)) FAIL(refusal->reason);
  return std::get<CheckedPath>(std::move(check));
}

/// Where E is at the end of the last motion of a stage.
RigidTransform EndOfStage(const CheckedPath& path, int stage) {
  RigidTransform X_BE = RigidTransform::Identity();
  for (const CheckedPath::Segment& segment : path.segments()) {
    if (segment.segment.stage == stage && segment.trajectory) {
      X_BE = Planner().PoseOfE(EndOf(*segment.trajectory));
    }
  }
  return X_BE;
}

bool SamePose(const RigidTransform& a, const RigidTransform& b) {
  const double turn_rad = Eigen::AngleAxisd(Matrix3(a.linear().transpose() * b.linear())).angle();
  return (a.translation() - b.translation()).norm() < kSame_m && turn_rad < kSame_rad;
}

/// An arm that keeps what it was sent.
class RecordingArm : public Arm {
 public:
  explicit RecordingArm(Arm& arm) : arm_(arm) {}
  ArmState State() const override { return arm_.State(); }
  CommandResult Start(const CheckedTrajectory& trajectory) override {
    sent.push_back(trajectory.trajectory());
    return arm_.Start(trajectory);
  }
  CommandResult Append(const CheckedTrajectory& more) override { return arm_.Append(more); }
  void Stop(StopKind kind) override { arm_.Stop(kind); }
  void SetPayload(double mass_kg, const Vector3& p_FC) override { arm_.SetPayload(mass_kg, p_FC); }

  std::vector<JointTrajectory> sent;

 private:
  Arm& arm_;
};

struct Rig {
  explicit Rig(const PathStart& start) {
    fake.arm.q = start.q;
    executor.emplace(cell);
  }
  test::FakeCell fake;
  RecordingArm arm{fake.arm};
  Cell cell{fake.clock,   arm,         fake.gripper, fake.wrist,
            fake.scanner, PaperCell(), Bin(),        fake.cell.safety};
  std::optional<PathExecutor> executor;
};

TEST_CASE("What is run is what was checked, joint by joint", "[unit]") {
  const PathStart start = AtView();
  const CheckedPath path =
      Checked(PathOf(GraspAt(0.1, 0.05, 0.022, 0.4), SlideAndLift(0.05)), start);
  Rig rig(start);
  REQUIRE(rig.executor->Run(path).ok());
  std::vector<JointTrajectory> checked;
  for (const CheckedPath::Segment& segment : path.segments()) {
    if (segment.trajectory) checked.push_back(segment.trajectory->trajectory());
  }
  REQUIRE(rig.arm.sent.size() == checked.size());
  for (std::size_t i = 0; i < checked.size(); ++i) {
    REQUIRE(rig.arm.sent[i].points.size() == checked[i].points.size());
    for (std::size_t k = 0; k < checked[i].points.size(); ++k) {
      CHECK(rig.arm.sent[i].points[k].q == checked[i].points[k].q);
    }
  }
}

TEST_CASE("The pads' centre is at the grasp when the fingers have closed, whatever the radius",
          "[unit]") {
  const double radius_m = GENERATE(0.006, 0.0125, 0.033);
  const Grasp grasp = GraspAt(0.0, 0.0, 0.05);
  const CheckedPath path = Checked(PathOf(grasp, SlideAndLift(0.0), {}, radius_m), AtView());
  const RigidTransform X_BE = EndOfStage(path, kDescendStage);
  // The pads of a hand that holds something thick are that much behind E.
  const RigidTransform X_BPads =
      X_BE * Translation(0, 0, -PadRetreat(PaperCell().gripper, 2.0 * radius_m));
  CHECK(SamePose(X_BPads, Bin().X_BN * grasp.X_NG));
  CHECK(SamePose(X_BE, ToolPoseAtGrasp(grasp, radius_m, PaperCell().gripper, Bin())));
}

TEST_CASE("The approach that is checked is the one that is configured", "[unit]") {
  PathConfig config;
  config.approach_m = GENERATE(0.02, 0.08, 0.25);
  const CheckedPath path =
      Checked(PathOf(GraspAt(0.0, 0.0, 0.03), SlideAndLift(0.0), config), AtView());
  const Vector3 above = EndOfStage(path, kApproachStage).translation();
  const Vector3 at = EndOfStage(path, kDescendStage).translation();
  CHECK((above - at).isApprox(Vector3(0, 0, config.approach_m), 1e-6));
}

TEST_CASE("The two parts of a motion, run one after the other, end where the whole does",
          "[unit]") {
  RandomStream stream(3, 0, "split paths");
  const RigidTransform& X_BN = Bin().X_BN;
  int checked = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Grasp grasp = GraspAt(stream.Uniform(-0.2, 0.2), stream.Uniform(-0.15, 0.15), 0.03,
                                stream.Uniform(-1.0, 1.0));
    CandidateMotion motion = SlideAndLift(stream.Uniform(-0.08, 0.08));
    if (trial % 2 == 1) {
      motion.waypoints_N.insert(motion.waypoints_N.begin() + 1, Vector3(0, 0, 0.05));
      motion.waypoints_N[2].z() = 0.05;
    }
    PathConfig config;
    config.first_lift_m = stream.Uniform(0.005, 0.2);
    const PathCheck check = Check(Planner(), PathOf(grasp, motion, config), AtView());
    if (RefusalOf(check) != nullptr) continue;
    ++checked;
    const auto& path = std::get<CheckedPath>(check);
    const RigidTransform X_NE =
        X_BN.inverse() * ToolPoseAtGrasp(grasp, kRadius, PaperCell().gripper, Bin());
    const int last = path.num_stages() - 1;
    CHECK(SamePose(EndOfStage(path, last), X_BN * ToolPath(motion, X_NE).back()));
  }
  CHECK(checked > 10);
}

TEST_CASE("A motion goes on from where contact ended the descent", "[unit]") {
  const PathStart start = AtView();
  const CheckedPath path = Checked(PathOf(GraspAt(0.0, 0.0, 0.03), SlideAndLift(0.04)), start);
  Rig rig(start);
  REQUIRE(rig.executor->Run(path, kApproachStage).ok());
  // The wrist feels the floor as soon as the guarded part begins.
  const std::size_t before = rig.arm.sent.size();
  rig.fake.clock.each_period = [&] {
    const bool guarded = rig.arm.sent.size() >= before + 2;
    rig.fake.wrist.load_K.force_N = Vector3(0, 0, guarded ? -30.0 : 0.0);
  };
  const StepOutcome descent = rig.executor->Run(path, kDescendStage);
  REQUIRE(descent.contact());
  rig.fake.clock.each_period = {};
  rig.fake.wrist.load_K.force_N = Vector3::Zero();
  const RigidTransform X_BE = rig.executor->X_BE();
  const double short_m = X_BE.translation().z() - EndOfStage(path, kDescendStage).translation().z();
  CHECK(short_m > 0.001);
  REQUIRE(rig.executor->Run(path, kFirstLiftStage).ok());
  REQUIRE(rig.executor->Run(path, kMotionStage).ok());
  const Vector3 by = rig.executor->X_BE().translation() - X_BE.translation();
  const Vector3 planned =
      EndOfStage(path, kMotionStage).translation() - EndOfStage(path, kDescendStage).translation();
  CHECK((by - planned).norm() < 1e-4);
}

TEST_CASE("From over its goal a path is refused exactly where it is refused from there", "[unit]") {
  RandomStream stream(5, 0, "refusals");
  int refused = 0, run = 0;
  for (int trial = 0; trial < 12; ++trial) {
    // Some of them too near to a wall, some too low.
    const Grasp grasp = GraspAt(stream.Uniform(-0.38, 0.38), stream.Uniform(-0.28, 0.28),
                                stream.Uniform(0.005, 0.05));
    const PickPath path = PathOf(grasp, SlideAndLift(0.0));
    const auto refusal = RefusalFromOver(Planner(), path);
    const auto& transfer = std::get<Transfer>(path.segments[1].what);
    PathStart over;
    const auto q = Planner().Reach(Planner().OverGoal(transfer.X_BE, path.segments[1].options));
    if (!q) continue;
    over.q = *q;
    const PathCheck whole = Check(Planner(), path, over);
    CHECK((RefusalOf(whole) != nullptr) == refusal.has_value());
    (refusal ? refused : run) += 1;
  }
  CHECK(run > 2);
  CHECK(refused > 2);
}

TEST_CASE("A refusal names its segment, and nothing of the path is run", "[unit]") {
  const PathStart start = AtView();
  const PickPath path = PathOf(GraspAt(0.0, 0.0, -0.05), SlideAndLift(0.0));  // Under the floor.
  const PathCheck check = Check(Planner(), path, start);
  REQUIRE(RefusalOf(check) != nullptr);
  CHECK(RefusalOf(check)->reason.rfind("approach: ", 0) == 0);
  Rig rig(start);
  const StepOutcome outcome = rig.executor->CheckAndRun(path);
  CHECK(outcome.refused());
  CHECK(rig.arm.sent.empty());
  CHECK(rig.fake.gripper.commands == 0);
}

TEST_CASE("A held part that swings is not brought to speed in less than its period", "[unit]") {
  const MotionOptions options = NearGrasp(0.25, 1.0, 0.5);
  CHECK(options.acceleration_m_s2 == Approx(0.5));
  CHECK(NearGrasp(0.25, 1.0).acceleration_m_s2 == Approx(1.0));
}

}  // namespace
}  // namespace tubetwin

#include "planner/motion/motion_planner.h"

#include "planner/motion/time_law.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

using Why = MotionRejection::Why;

constexpr double kLine_m = 0.00005;    // a line is followed between samples that well
constexpr double kDifferences = 1.02;  // limits measured by differences of a 10 ms cubic
const MotionPlanner& Planner() {
  static const MotionPlanner planner(PaperCell(), Bin());
  return planner;
}

RigidTransform Down(double x, double y, double over_floor_m, double yaw_rad = 0.0) {
  return MakeTransform(RotX(kPi) * RotZ(yaw_rad), Vector3(x, y, 0.10 + over_floor_m));
}

JointVector At(const RigidTransform& X_BE) {
  const auto q = Planner().Reach(X_BE);
  REQUIRE(q.has_value());
  return *q;
}

CheckedTrajectory Planned(const MotionResult& result) {
  if (const auto* rejection = std::get_if<MotionRejection>(&result)) FAIL(rejection->reason);
  return std::get<CheckedTrajectory>(result);
}

MotionRejection Rejected(const MotionResult& result) {
  REQUIRE(std::holds_alternative<MotionRejection>(result));
  return std::get<MotionRejection>(result);
}

/// Speed, acceleration and jerk of every joint by differences of fine samples stay in the limits.
void CheckLimits(const CheckedTrajectory& trajectory) {
  constexpr double kStep_s = 0.01;
  std::vector<JointVector> q;
  for (double t = 0; t <= trajectory.duration_s(); t += kStep_s) {
    q.push_back(Sample(trajectory.trajectory(), t).q);
  }
  for (std::size_t i = 3; i < q.size(); ++i) {
    const JointVector v = (q[i] - q[i - 1]) / kStep_s;
    const JointVector a = (q[i] - 2 * q[i - 1] + q[i - 2]) / (kStep_s * kStep_s);
    const JointVector j = (q[i] - 3 * q[i - 1] + 3 * q[i - 2] - q[i - 3]) / std::pow(kStep_s, 3);
    for (int k = 0; k < kNumJoints; ++k) {
      const ArmModel::Joint& limits = PaperCell().arm.joints[k];
      CHECK(std::abs(v[k]) < kDifferences * limits.max_speed_rad_s);
      CHECK(std::abs(a[k]) < kDifferences * limits.max_acceleration_rad_s2);
      CHECK(std::abs(j[k]) < kDifferences * limits.max_jerk_rad_s3);
    }
  }
}

/// Largest distance of E from the straight line, at ten places between samples.
double LineDeviation(const CheckedTrajectory& trajectory, const Vector3& from, const Vector3& to) {
  const Vector3 along = (to - from).normalized();
  double largest = 0;
  for (double t = 0; t < trajectory.duration_s(); t += 0.001) {
    const Vector3 p = Planner().PoseOfE(Sample(trajectory.trajectory(), t).q).translation() - from;
    largest = std::max(largest, (p - p.dot(along) * along).norm());
  }
  return largest;
}

TEST_CASE("The time law runs any length from rest to rest within its limits", "[unit]") {
  const PathLimits limits{0.5, 2.0, 20.0};
  double last_duration_s = 0;
  for (const double length : {1e-6, 0.001, 0.005, 0.02, 0.1, 0.13, 0.5, 3.0}) {
    const SCurve law(length, limits);
    CHECK(law.duration_s() > last_duration_s);
    last_duration_s = law.duration_s();
    CHECK(law.At(0).s == 0);
    CHECK(law.At(law.duration_s()).s == length);
    constexpr int kSteps = 4000;
    const double dt = law.duration_s() / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const auto a = law.At(i * dt), b = law.At((i + 1) * dt);
      CHECK(b.v <= limits.speed + 1e-12);
      CHECK(std::abs(b.a) <= limits.acceleration + 1e-9);
      CHECK(std::abs(b.a - a.a) <= limits.jerk * dt * (1 + 1e-6));
      CHECK(b.s >= a.s);
      // Speed is the derivative of the place, acceleration that of the speed.
      CHECK(std::abs((b.s - a.s) - 0.5 * (a.v + b.v) * dt) <= limits.jerk * dt * dt * dt);
      CHECK(std::abs((b.v - a.v) - 0.5 * (a.a + b.a) * dt) <= limits.jerk * dt * dt);
    }
  }
}

TEST_CASE("The time law is as fast as three closed forms say", "[unit]") {
  const PathLimits limits{0.5, 2.0, 20.0};
  // Long: length/v + v/a + a/j. Medium, full acceleration, no full speed. Short: jerk only.
  CHECK(std::abs(SCurve(3.0, limits).duration_s() - (3.0 / 0.5 + 0.5 / 2 + 2.0 / 20)) < 1e-12);
  const double half = 0.5 * 2.0 / 20;
  CHECK(std::abs(SCurve(0.1, limits).duration_s() -
                 2 * (half + std::sqrt(half * half + 0.1 / 2.0))) < 1e-12);
  CHECK(std::abs(SCurve(0.01, limits).duration_s() - 4 * std::cbrt(0.01 / 40)) < 1e-12);
}

TEST_CASE("A 500 mm/s line across the bin is straight, fast and within every limit", "[unit]") {
  const RigidTransform from = Down(0.60, -0.33, 0.25), to = Down(0.60, 0.33, 0.25);
  MotionOptions options;
  const auto trajectory = Planned(Planner().PlanLine(At(from), to, options));
  const double free_s =
      SCurve(0.66, {options.speed_m_s, options.acceleration_m_s2, options.jerk_m_s3}).duration_s();
  CHECK(trajectory.duration_s() < 1.001 * free_s);  // no joint slowed it
  CHECK(LineDeviation(trajectory, from.translation(), to.translation()) < kLine_m);
  const RigidTransform X_BE = Planner().PoseOfE(EndOf(trajectory));
  CHECK((X_BE.translation() - to.translation()).norm() < 1e-8);
  CHECK((X_BE.linear() - to.linear()).norm() < 1e-8);
  CheckLimits(trajectory);
  double top = 0;
  const auto& points = trajectory.trajectory().points;
  for (std::size_t i = 1; i < points.size(); ++i) {
    CHECK(points[i].time_s - points[i - 1].time_s < 0.0101);
    const double moved = (Planner().PoseOfE(points[i].q).translation() -
                          Planner().PoseOfE(points[i - 1].q).translation())
                             .norm();
    top = std::max(top, moved / (points[i].time_s - points[i - 1].time_s));
  }
  CHECK(std::abs(top - 0.5) < 0.001);
}

TEST_CASE("Velocities of the samples are the derivatives of their positions", "[unit]") {
  const auto trajectory =
      Planned(Planner().PlanLine(At(Down(0.5, -0.2, 0.3)), Down(0.7, 0.2, 0.2, 1.0), {}));
  const auto& points = trajectory.trajectory().points;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const JointVector v =
        (points[i + 1].q - points[i - 1].q) / (points[i + 1].time_s - points[i - 1].time_s);
    CHECK((v - points[i].qd).cwiseAbs().maxCoeff() < 0.01);
  }
}

TEST_CASE("A motion that asks too much of the joints is slowed, not refused", "[unit]") {
  MotionOptions fast;
  fast.speed_m_s = 5;
  fast.acceleration_m_s2 = 100;
  fast.jerk_m_s3 = 5000;
  fast.turn_speed_rad_s = 20;
  fast.turn_acceleration_rad_s2 = 300;
  fast.turn_jerk_rad_s3 = 9000;
  const RigidTransform from = Down(0.5, -0.30, 0.3), to = Down(0.75, 0.30, 0.4, 1.5);
  const auto line = Planned(Planner().PlanLine(At(from), to, fast));
  CheckLimits(line);
  const auto joint = Planned(Planner().PlanJoint(At(from), At(to), fast));
  CheckLimits(joint);
  CHECK(joint.duration_s() <= line.duration_s());
  // Some joint is close to its share of some limit: the motion is not slower than it must be.
  double use = 0;
  for (const auto& p : line.trajectory().points) {
    for (int k = 0; k < kNumJoints; ++k) {
      const auto& limits = PaperCell().arm.joints[k];
      use = std::max(use, std::abs(p.qd[k]) / limits.max_speed_rad_s / fast.joint_speed_share);
      use = std::max(
          use, std::abs(p.qdd[k]) / limits.max_acceleration_rad_s2 / fast.joint_acceleration_share);
    }
  }
  CHECK(use > 0.7);
}

TEST_CASE("A line into the bin's wall is refused and the wall is named", "[unit]") {
  // Pads across B's y, E sinks outside the wall of the bin's +x (B's +y at 0.385).
  const RigidTransform from = Down(0.60, 0.20, 0.05, kPi / 2);
  const RigidTransform to = Down(0.60, 0.42, 0.05, kPi / 2);
  MotionOptions options;
  options.opening_m = 0.03;
  const auto rejection = Rejected(Planner().PlanLine(At(from), to, options));
  CHECK(rejection.why == Why::kCollision);
  CHECK_THAT(rejection.reason, Catch::Contains("bin wall +x"));
  CHECK_THAT(rejection.reason, Catch::Contains("at "));
  CHECK(rejection.fraction > 0.5);
  CHECK(rejection.fraction < 0.9);
}

TEST_CASE("The way to a grasp near the floor needs the fingers' smaller clearance", "[unit]") {
  MotionOptions options;
  options.opening_m = 0.0;
  const RigidTransform from = Down(0.60, 0.0, 0.20), to = Down(0.60, 0.0, 0.0208);  // pads 2 mm up
  CHECK_THAT(Rejected(Planner().PlanLine(At(from), to, options)).reason,
             Catch::Contains("finger") && Catch::Contains("bin floor"));
  options.finger_clearance_m = 0.001;
  const auto down = Planned(Planner().PlanLine(At(from), to, options));
  // From there the lift is allowed with the usual clearance: it leads away.
  options.finger_clearance_m = 0.005;
  const auto up = Planned(Planner().PlanLine(EndOf(down), from, options));
  CHECK((Planner().PoseOfE(EndOf(up)).translation() - from.translation()).norm() < 1e-8);
  // Below the floor is refused at any clearance that keeps the fingers whole.
  CHECK(Rejected(Planner().PlanLine(At(from), Down(0.60, 0.0, 0.015), options)).why ==
        Why::kCollision);
}

TEST_CASE("A line beyond the reach is refused with where", "[unit]") {
  const auto rejection = Rejected(Planner().PlanLine(At(Down(0.6, 0, 0.3)), Down(1.6, 0, 0.3), {}));
  CHECK(rejection.fraction > 0.2);
  CHECK(rejection.fraction < 0.8);
  CHECK_FALSE(rejection.reason.empty());
}

TEST_CASE("A sideways line through a nearly singular pose is refused, a vertical one is not",
          "[unit]") {
  // Nearest row, forearm almost upright: about 0.04 there.
  MotionOptions options;
  options.manipulability = 0.06;
  options.opening_m = 0.03;
  options.finger_clearance_m = 0.001;
  const RigidTransform from = Down(0.36, -0.25, 0.0215), to = Down(0.36, 0.10, 0.0215);
  const auto rejection = Rejected(Planner().PlanLine(At(from), to, options));
  CHECK(rejection.why == Why::kSingular);
  CHECK_THAT(rejection.reason, Catch::Contains("manipulability"));
  CHECK(rejection.fraction > 0.0);
  // A start beyond the bound may be left as long as that does not get worse.
  Planned(Planner().PlanLine(At(Down(0.36, 0.0, 0.0215)), Down(0.36, 0.0, 0.30), options));
}

TEST_CASE("A turn beyond joint 6's range names the joint, and either yaw avoids it", "[unit]") {
  JointVector q = At(Down(0.6, 0, 0.4));
  q[5] = Radians(150);
  const RigidTransform goal =
      Planner().PoseOfE(q) * MakeTransform(RotZ(Radians(100)), Vector3::Zero());
  const RigidTransform back =
      Planner().PoseOfE(q) * MakeTransform(RotZ(Radians(-100)), Vector3::Zero());
  MotionOptions options;
  const auto a = Planner().PlanLine(q, goal, options);
  const auto b = Planner().PlanLine(q, back, options);
  const bool a_refused = std::holds_alternative<MotionRejection>(a);
  CHECK(a_refused != std::holds_alternative<MotionRejection>(b));
  const auto rejection = Rejected(a_refused ? a : b);
  CHECK(rejection.joint == 5);
  CHECK(rejection.why == Why::kJointLimit);
}

TEST_CASE("At the tilt station E stands still through 45 degrees about any horizontal axis",
          "[unit]") {
  const Vector3 p_BTilt = PaperCell().layout.p_BTilt;
  const RigidTransform X_BE = MakeTransform(RotX(kPi), p_BTilt);
  for (int k = 0; k < 8; ++k) {
    const double angle = k * kPi / 4;
    const Vector3 rotation_B = Radians(45) * Vector3(std::cos(angle), std::sin(angle), 0);
    MotionOptions options;
    options.opening_m = 0.02;
    const auto tilt = Planned(Planner().PlanTilt(At(X_BE), rotation_B, options));
    for (const auto& p : tilt.trajectory().points) {
      CHECK((Planner().PoseOfE(p.q).translation() - p_BTilt).norm() < kLine_m);
    }
    const Matrix3 R = Planner().PoseOfE(EndOf(tilt)).linear();
    CHECK(std::abs(Degrees(std::acos(-R(2, 2))) - 45.0) < 1e-6);
    CheckLimits(tilt);
    const auto back = Planned(Planner().PlanTilt(EndOf(tilt), -rotation_B, options));
    CHECK((EndOf(back) - At(X_BE)).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("A polyline stops at each corner and passes through it", "[unit]") {
  const std::vector<RigidTransform> corners = {Down(0.5, -0.2, 0.3), Down(0.7, -0.2, 0.3),
                                               Down(0.7, 0.2, 0.3)};
  const auto trajectory =
      Planned(Planner().PlanPolyline(At(Down(0.5, -0.2, 0.2)), corners, MotionOptions()));
  const auto& points = trajectory.trajectory().points;
  for (const auto& corner : corners) {
    CHECK(std::any_of(points.begin(), points.end(), [&](const TrajectoryPoint& p) {
      return p.qd.norm() == 0 &&
             (Planner().PoseOfE(p.q).translation() - corner.translation()).norm() < 1e-8;
    }));
  }
  const auto rejection = Rejected(Planner().PlanPolyline(
      At(Down(0.5, -0.2, 0.2)), {corners[0], Down(0.5, -0.2, -0.02), corners[2]}, {}));
  CHECK_THAT(rejection.reason, Catch::StartsWith("leg 2 of 3 at "));
  CHECK(rejection.fraction > 1.0 / 3);
  CHECK(rejection.fraction < 2.0 / 3);
}

TEST_CASE("Transfers join every part of the bin with every corner of the tray", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  MotionOptions options;
  options.opening_m = 0.025;
  double longest_s = 0;
  for (const double x : {0.36, 0.60, 0.84}) {
    for (const double y : {-0.33, 0.0, 0.33}) {
      for (const double yaw_deg : {0.0, 50.0, 130.0}) {
        const JointVector q = At(Down(x, y, 0.14, Radians(yaw_deg)));
        for (const double corner : {-1.0, 1.0}) {
          const Vector3 p_BE = layout.X_BT * Vector3(corner * 0.2, -corner * 0.2, 0.05);
          const auto there = Planned(
              Planner().PlanTransfer(q, MakeTransform(RotX(kPi) * RotZ(0.3), p_BE), options));
          CheckLimits(there);
          for (double t = 0; t < there.duration_s(); t += 0.02) {
            const auto near = Planner().clearance().Check(Sample(there.trajectory(), t).q,
                                                          PaperCell().gripper.stroke_m);
            // Between two pieces of the path E moves less than half of the clearance asked.
            CHECK(near.clearance_m > 0.5 * options.clearance_m);
          }
          longest_s = std::max(longest_s, there.duration_s());
          CHECK((Planner().PoseOfE(EndOf(there)).translation() - p_BE).norm() < 1e-8);
        }
      }
    }
  }
  CHECK(longest_s < 8.0);
}

TEST_CASE("Every scan pose is reached from the one before by a straight line", "[unit]") {
  JointVector q;
  bool first = true;
  for (const auto& X_BS : ScanPosesOf(PaperCell(), Bin())) {
    const RigidTransform X_BE = Planner().PoseOfEForScan(X_BS);
    if (first) {
      q = At(X_BE);
    } else {
      q = EndOf(Planned(Planner().PlanLine(q, X_BE, {})));
    }
    first = false;
    const RigidTransform X_BS_reached =
        Planner().PoseOfE(q) * PaperCell().layout.X_FE.inverse() * PaperCell().layout.X_FS;
    CHECK((X_BS_reached.translation() - X_BS.translation()).norm() < 1e-8);
  }
}

TEST_CASE("Standing still is a motion too", "[unit]") {
  const JointVector q = At(Down(0.6, 0, 0.3));
  const auto still = Planned(Planner().PlanLine(q, Planner().PoseOfE(q), {}));
  CHECK(still.duration_s() > 0);
  CHECK((EndOf(still) - q).norm() < 1e-9);
  CHECK(EndOf(Planned(Planner().PlanJoint(q, q, {}))) == q);
}

}  // namespace
}  // namespace tubetwin

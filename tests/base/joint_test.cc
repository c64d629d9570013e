#include "models/base/joint.h"

#include <cmath>

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

/// q_j(t) = a t^3 + b t^2 on [0, 2], which a cubic reproduces exactly, cut at 0.7 s.
TrajectoryPoint CubicAt(double t) {
  TrajectoryPoint p;
  p.time_s = t;
  for (int j = 0; j < kNumJoints; ++j) {
    const double a = 0.3 - 0.1 * j;
    const double b = 0.2 * j - 0.4;
    p.q[j] = a * t * t * t + b * t * t + j;
    p.qd[j] = 3 * a * t * t + 2 * b * t;
    p.qdd[j] = 6 * a * t + 2 * b;
  }
  return p;
}

JointTrajectory Cubic() { return {{CubicAt(0.0), CubicAt(0.7), CubicAt(2.0)}}; }

constexpr double kRounding = 1e-13;  // Values are of order 1.

}  // namespace

TEST_CASE("between points a trajectory is the cubic through position and velocity") {
  for (const double t : {0.001, 0.3, 0.7, 0.700001, 1.3, 1.999}) {
    const TrajectoryPoint p = Sample(Cubic(), t);
    const TrajectoryPoint expected = CubicAt(t);
    CHECK(p.time_s == t);
    CHECK((p.q - expected.q).cwiseAbs().maxCoeff() < kRounding);
    CHECK((p.qd - expected.qd).cwiseAbs().maxCoeff() < 10 * kRounding);
    CHECK((p.qdd - expected.qdd).cwiseAbs().maxCoeff() < 100 * kRounding);
  }
}

TEST_CASE("before its start and after its end a trajectory stands still at its ends") {
  const JointTrajectory cubic = Cubic();
  CHECK(Sample(cubic, -1.0).q == cubic.points.front().q);
  CHECK(Sample(cubic, 0.0).q == cubic.points.front().q);
  const TrajectoryPoint after = Sample(cubic, 5.0);
  CHECK(after.q == cubic.points.back().q);
  CHECK(after.qd.isZero(0.0));
  CHECK(after.qdd.isZero(0.0));
}

TEST_CASE("one point is a trajectory of no duration, none is a bug") {
  const JointTrajectory one = {{CubicAt(0.0)}};
  CHECK(one.duration_s() == 0.0);
  CHECK(Sample(one, 0.5).q == one.points.front().q);
  CHECK_THROWS_AS(Sample(JointTrajectory{}, 0.0), LogicError);
}

}  // namespace tubetwin

#include "models/base/rotation.h"

#include "tests/support/catch.h"

namespace tubetwin {

TEST_CASE("The rotation between two directions turns one into the other, by no more than needed",
          "[unit]") {
  const Vector3 from(0.3, -0.2, 2.0), to(-1.0, 0.4, 0.1);
  const Eigen::Quaterniond turn = RotationBetween(from, to);
  CHECK((turn * from.normalized() - to.normalized()).norm() < 1e-15);
  const double angle_rad = std::acos(from.normalized().dot(to.normalized()));
  CHECK(Eigen::AngleAxisd(turn).angle() == Approx(angle_rad).margin(1e-14));
  CHECK(RotationBetween(from, 7.0 * from).isApprox(Eigen::Quaterniond::Identity(), 1e-15));
}

TEST_CASE("Of opposite directions it is a half turn about an axis across them", "[unit]") {
  const Vector3 from(0.3, -0.2, 2.0);
  const Eigen::Quaterniond turn = RotationBetween(from, -from);
  CHECK((turn * from + from).norm() < 1e-14);
}

}  // namespace tubetwin

#include "models/base/rotation.h"

#include <cmath>

namespace tubetwin {

Eigen::Quaterniond RotationBetween(const Vector3& from, const Vector3& to) {
  const Vector3 from_unit = from.normalized(), to_unit = to.normalized();
  const double cosine = to_unit.dot(from_unit);
  Eigen::Quaterniond turn;
  if (cosine < -1.0 + 1e-12) {
    turn.w() = 0.0;
    turn.vec() = from_unit.unitOrthogonal();
    return turn;
  }
  const double twice_w = std::sqrt((1.0 + cosine) * 2.0);  // 2 cos(angle / 2)
  turn.vec() = from_unit.cross(to_unit) * (1.0 / twice_w);
  turn.w() = twice_w * 0.5;
  return turn;
}

}  // namespace tubetwin

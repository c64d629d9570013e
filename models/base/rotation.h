#pragma once

#include "models/base/frames.h"

namespace tubetwin {

/// The smallest rotation that turns the direction of `from` into that of `to`; of opposite
/// directions any half turn. Precondition: neither is zero. Eigen's FromTwoVectors does the same,
/// but compiles a singular value decomposition for the opposite case into every file that names it.
Eigen::Quaterniond RotationBetween(const Vector3& from, const Vector3& to);

}  // namespace tubetwin

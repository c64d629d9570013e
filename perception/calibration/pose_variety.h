#pragma once

#include <string>
#include <vector>

#include "models/base/frames.h"

namespace tubetwin::calibration_internal {

/// What the flange's poses R_BF lack to tell how the scanner hangs on it: a sentence with the pose
/// to add. Empty: they differ enough.
std::string WhatPosesLack(const std::vector<Matrix3>& R_BF);

}  // namespace tubetwin::calibration_internal

#pragma once

#include <string>

#include "perception/calibration/calibration.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// A scan from where the arm of the scenario's cell stands, and its joints then.
struct TakenView {
  OrganizedCloud cloud;
  JointVector q = JointVector::Zero();
};

/// Scans; moves nothing. Throws as LiveCell and Scan do, Error(kDevice) when the arm moved
/// meanwhile.
TakenView TakeView(const Scenario& scenario, Parallelism parallelism);

/// Where the tip, `p_FTip` on the flange, is now, in B; moves nothing. Only the arm is connected.
/// Throws Error(kConfig) unless it is a device, Error(kDevice) when it is not at rest.
Vector3 TakeTouch(const Scenario& scenario, const Vector3& p_FTip);

}  // namespace tubetwin

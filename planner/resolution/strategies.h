#pragma once

#include <vector>

#include "planner/resolution/strategy.h"

namespace tubetwin {

// The strategies of registry.cc, one a file. At the layout's tilt station the tool tilts by
// `angle_deg` about an axis through E, rests there, and turns back.

/// Leão et al. 2020, section 3.7: once, about the horizontal axis of the load torque, in the sense
/// that lets the heavy side go down.
PickPath MakePlus45(const ResolutionInput& input);
/// The same, then to the other side.
PickPath MakePlus45Minus45(const ResolutionInput& input);
/// To both sides about the horizontal axis across the load torque.
PickPath MakePerpendicular(const ResolutionInput& input);
/// Down until what hangs rests on the pile, a short rest, and up: extras that lie there let go.
PickPath MakePutback(const ResolutionInput& input);

/// Horizontal unit vector of the load torque in B; B's x where the torque is too small to have one.
Vector3 LoadAxis(const ResolutionInput& input);

/// The tilts of a path: at the station, one stage for each angle about `axis_B`, which is given for
/// the tool as it hangs now and turns about the vertical with it.
PickPath TiltPath(const ResolutionInput& input, const Vector3& axis_B,
                  const std::vector<double>& angles_deg);

/// E at the tilt station, the tool turned by the input's yaw.
RigidTransform TiltStation(const ResolutionInput& input);

}  // namespace tubetwin

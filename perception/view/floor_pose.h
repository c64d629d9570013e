#pragma once

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// Pose of the scanner in the bin, X_NS, from floor and walls alone: for clouds that come without
/// one. The floor is the plane that has the walls' points above it; the walls are a rectangle of
/// the bin's inner size upright on it. At least two neighbouring walls must be seen. A rectangle
/// looks the same when turned by half a turn: of the two poses, S's x axis points along +x of N
/// (rather along +y where it is square to that). Uses only points, so it works in any frame; the
/// cloud's own X_NS is not read. Deterministic. Throws Error(kBadData) saying what was not found,
/// without a file's name.
RigidTransform FitFloorPose(const OrganizedCloud& cloud, const Bin& bin);

}  // namespace tubetwin

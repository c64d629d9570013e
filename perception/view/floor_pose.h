#pragma once

#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// Where the bin is, as its floor and walls alone tell.
struct FloorPose {
  std::vector<RigidTransform> X_NS;  ///< Of each cloud.
  std::string walls;                 ///< Those that the fit rests on: "-x, +x, -y".
  /// What looks the same and stays open: "half a turn of the bin", or "a quarter turn of the bin"
  /// when it is square.
  std::string open;
};

/// Finds the bin in clouds that were taken from unknown places. The floor is a plane with upright
/// walls on it; the walls are sides of a rectangle of the bin's inner size. Every way to lay that
/// on the walls seen is compared with all points: the scanner is over the floor, nothing is seen
/// through floor or walls, no wall stands inside. There is a pose only when one way is left, but
/// for turns that look the same, and one side is seen to be as long as the bin's: of those turns
/// the one in which the first S's x axis points along +x of N (rather along +y where it is square
/// to that).
///
/// Several clouds whose own X_NS differ are taken to know their places in one frame, whichever it
/// is: they are fitted as one. Otherwise each is fitted for itself, and what they see in common
/// decides between the ways and turns of the second and later ones.
///
/// Throws Error(kBadData) saying without files' names why there is no pose: too few walls, several
/// ways, another bin than the one given, views with too little in common. Deterministic.
FloorPose FitFloorPose(const std::vector<OrganizedCloud>& clouds, const Bin& bin);

}  // namespace tubetwin

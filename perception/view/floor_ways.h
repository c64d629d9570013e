#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// One way in which the bin may stand in the frame C of some clouds.
struct FloorWay {
  RigidTransform X_NC = RigidTransform::Identity();
  std::array<bool, 4> seen_walls{};  ///< -x, +x, -y, +y of N.
  bool shows_size = false;           ///< See BinFit.
  double seen_floor_m2 = 0.0;
};

/// All ways that nothing seen speaks against, those that only a turn of the bin tells apart once.
struct FloorWays {
  std::vector<FloorWay> ways;
  std::string why_none;  ///< Of no way at all: a sentence for the user.
};

/// Lays the bin on floor and walls in clouds whose X_NS are their poses in C. Deterministic.
FloorWays FindFloorWays(const std::vector<OrganizedCloud>& clouds, const Bin& bin);

/// What the walls seen say about another bin than the given one, of clouds whose X_NS are known:
/// two that face each other, neither of them where a wall of the bin would be. Empty: nothing.
std::string OtherBinSeen(const std::vector<OrganizedCloud>& clouds, const Bin& bin);

/// The turns of N about its z that neither floor nor walls tell apart: half a turn, of a square bin
/// each quarter. The first is none.
std::vector<RigidTransform> TurnsOf(const Bin& bin);

/// The way after N was turned.
FloorWay Turned(const FloorWay& way, const RigidTransform& turn);

/// "-x, +y".
std::string WallsText(const std::array<bool, 4>& walls);

/// "0.8 x 0.6 x 0.2 m".
std::string SizeText(const Bin& bin);

}  // namespace tubetwin

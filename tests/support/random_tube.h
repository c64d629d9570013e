#pragma once

#include <cstdint>
#include <string>

#include "tests/support/tube_mesh.h"

namespace tubetwin {

/// What a tube has besides its bends.
enum class TubeFeature { kNone, kSpigot, kBead, kFlange, kTaper };
const char* ToString(TubeFeature feature);

/// A tube as a CAD program might export it.
struct RandomTube {
  Polyline line;          ///< The axis: centres of the mesh's rings, metres, frame of the mesh.
  double radius_m = 0.0;  ///< Of most of it.
  Mesh mesh;              ///< Metres.
  std::string unit;       ///< That a file of it shall have: "mm", "cm", "in" or "m".
  double scale = 1.0;     ///< From metres to that unit.
  std::string text;       ///< What was drawn, for a failing test.
};

/// Sweeps a circle along a line of up to four bends of 10 to 120 degrees in turned planes (bend
/// radius 1.8 to 10 tube radii), somewhere in space. Drawn besides: radius (3 to 8 mm, every
/// third up to 30 mm), length, 10 to 48 sides, 3 to 12 degrees of bend between rings, ends flat,
/// open or round, solid, hollow or a mere skin, unit. Tubes that touch themselves are drawn anew.
/// Features are at the end of the line, and the line is straight there. Same seed, same tube.
RandomTube MakeRandomTube(std::uint64_t seed, TubeFeature feature);

}  // namespace tubetwin

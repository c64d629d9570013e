#pragma once

#include <array>
#include <string>

#include "models/mesh/mesh.h"

namespace tubetwin {

/// What a mesh is, seen as a bin.
enum class BinVerdict {
  kBin,
  kNoFloor,    ///< No level surface that fills the space between the walls.
  kNoWall,     ///< A wall is missing or has large openings.
  kNoBox,      ///< A wall leans, bends or has steps.
  kNotEmpty,   ///< Something stands between the walls, or a lid closes them.
  kWrongSize,  ///< Outside of what the cell can hold.
};

/// The inner box of a bin's mesh.
struct MeshBin {
  BinVerdict verdict = BinVerdict::kBin;
  std::string reason;                        ///< Why it is no bin, with numbers; empty for a bin.
  std::array<double, 3> size_m = {0, 0, 0};  ///< Inner: long, short, wall height over the floor.
  RigidTransform X_MN = RigidTransform::Identity();  ///< The bin's frame N in the mesh's frame M.
};

/// Finds floor and inner walls. The mesh is in metres, its z points up, it may be turned about z.
/// Walls may lean by up to 5 degrees (their middle height counts), thin sheets will do. A verdict,
/// not an exception, says what is no box-shaped, open, empty bin. Precondition: the mesh has a
/// face.
MeshBin FindBinOfMesh(const Mesh& mesh);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/polyline.h"
#include "models/mesh/mesh.h"

namespace tubetwin {

struct TubeMeshOptions {
  enum class Ends { kOpen, kFlat, kRound } ends = Ends::kFlat;
  int sides = 32;
  double bore_m = 0.0;          ///< Radius of an inner wall; 0: none. Flat ends then are rings.
  double end_radius_m = 0.0;    ///< A cone: the radius grows to this at the last node; 0: it stays.
  std::vector<double> radii_m;  ///< One per node of the line, in place of the radius; empty: none.
};

/// The mesh of a tube about a line: one ring of vertices per node, in the plane that halves the
/// corner there (mitred). Wound outwards.
Mesh MakeTubeMesh(const Polyline& line, double radius_m, const TubeMeshOptions& options = {});

Mesh MakeSphereMesh(const Vector3& centre, double radius_m);
Mesh MakeBoxMesh(const Vector3& centre, const Vector3& half_m);

/// An open box with its floor's inner middle at the origin, z up. `size_m` is the inside at the
/// floor, `wall_m` the thickness (0: a sheet; its first faces are the floor's two, then two per
/// wall), `lean_m` how much further out each wall is at its top.
Mesh MakeBinMesh(const Vector3& size_m, double wall_m, double lean_m = 0.0);

/// Both meshes in one.
Mesh Together(const Mesh& a, const Mesh& b);

/// The content of a file in which all coordinates are multiplied by `scale`.
std::string BinaryStl(const Mesh& mesh, double scale = 1.0);
std::string TextStl(const Mesh& mesh, double scale = 1.0);
std::string Obj(const Mesh& mesh, double scale = 1.0);
std::string TextPly(const Mesh& mesh, double scale = 1.0);
std::string BinaryPly(const Mesh& mesh, double scale = 1.0);

}  // namespace tubetwin

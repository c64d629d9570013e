#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "models/base/frames.h"

namespace tubetwin {

/// Triangles over shared vertices, in the file's own frame and, until ScaleToMetres, its own unit.
struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<std::array<int, 3>> faces;  ///< Indices of vertices, all different.

  /// Edge lengths of the box about all vertices.
  Vector3 BoxSize() const;
};

/// Reads an STL, OBJ or PLY file (told apart by the name's ending) and welds vertices that
/// coincide. STL may be text with anything before `solid`, or binary whatever its header says, with
/// bytes behind the last triangle; of PLY only positions and faces are read. Throws
/// Error(kMissing), Error(kBadData) naming the file and the reason: another ending, not parsable,
/// no triangle, a coordinate that is no finite number, more vertices claimed than the file can
/// hold, more than 2 million triangles.
Mesh ReadMesh(const std::string& path);

/// Scales a mesh to metres. `units`: one of LengthUnits(), or empty: the numbers are taken as
/// metres if the longest edge of the box then is 0.02 to 3 m. Throws Error(kBadData) when it is
/// not, naming `option`, with which the user says the unit, and the box in each unit; `source`
/// names the mesh. Precondition: `units` is known or empty.
void ScaleToMetres(Mesh& mesh, const std::string& units, const std::string& source,
                   const std::string& option);

/// The connected pieces of a mesh, the one with the largest box first. Within each piece all faces
/// are wound alike, so that the normals of what encloses a volume look outwards, however the file
/// wound them.
std::vector<Mesh> ConnectedPieces(const Mesh& mesh);

/// What a surface without rims encloses, m^3 for metres; nothing where an edge has not exactly two
/// faces. The faces are wound outwards (a piece of ConnectedPieces).
std::optional<double> EnclosedVolume(const Mesh& mesh);

/// A point of a surface, with the part of the surface that it stands for.
struct MeshPoint {
  Vector3 p = Vector3::Zero();
  Vector3 n = Vector3::UnitZ();  ///< Unit normal, smooth over edges of less than 65 degrees.
  double area = 0.0;
};

/// `count` points spread evenly over the surface, the same ones every time.
std::vector<MeshPoint> SampleSurface(const Mesh& mesh, int count);

/// The corners of all faces: points of the surface that the triangles stand for.
std::vector<MeshPoint> FaceCorners(const Mesh& mesh);

}  // namespace tubetwin

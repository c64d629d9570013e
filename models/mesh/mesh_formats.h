#pragma once

#include <cstddef>
#include <string>

#include "models/mesh/mesh.h"

namespace tubetwin {

/// More triangles than a tube or a bin needs, and than memory and patience hold.
inline constexpr std::size_t kMaxMeshFaces = 2'000'000;

/// Throws Error(kBadData) "PATH: why". Internal to the readers of meshes, as is all of this file.
[[noreturn]] void RefuseMesh(const std::string& path, const std::string& why);

/// Appends a vertex; throws for one that is not finite.
void AddMeshVertex(const std::string& path, const Vector3& p, Mesh& mesh);
/// Appends the triangles of a polygon as a fan; throws where there are too many.
void AddMeshPolygon(const std::string& path, const std::vector<int>& corners, Mesh& mesh);

/// Triangles of an STL file, text or binary, each with its own vertices.
Mesh ReadStl(const std::string& path, const std::string& content);
/// Faces of an OBJ file over its vertices as they are.
Mesh ReadObj(const std::string& path, const std::string& content);
/// Faces and triangle strips of a PLY file, over its vertices as they are.
Mesh ReadPlyMesh(const std::string& path);

}  // namespace tubetwin

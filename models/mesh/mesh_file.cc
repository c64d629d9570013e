#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/foreign/content.h"
#include "models/base/text.h"
#include "models/mesh/mesh.h"
#include "models/mesh/mesh_formats.h"

namespace tubetwin {
namespace {

/// Vertices closer than this share of the box's diagonal are one.
constexpr double kWeld = 1e-5;

/// Makes vertices at one place one vertex and drops faces and vertices that are nothing then.
Mesh Weld(const Mesh& mesh) {
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell& o) const { return x == o.x && y == o.y && z == o.z; }
  };
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      return static_cast<std::size_t>((c.x * 73856093) ^ (c.y * 19349663) ^ (c.z * 83492791));
    }
  };
  const double size = std::max(kWeld * mesh.BoxSize().norm(), 1e-300);
  Mesh out;
  std::unordered_map<Cell, int, Hash> index;  // Only looked up, never iterated.
  const auto find = [&](const Vector3& p) {
    // Two vertices on both sides of a cell's border are near each other as well.
    const Vector3 base = (p - mesh.vertices.front()) / size;
    for (int k = 0; k < 8; ++k) {
      const Vector3 q = base + 0.25 * Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
      const auto found =
          index.find({std::llround(q.x()), std::llround(q.y()), std::llround(q.z())});
      if (found != index.end()) return found->second;
    }
    const int added = static_cast<int>(out.vertices.size());
    index[{std::llround(base.x()), std::llround(base.y()), std::llround(base.z())}] = added;
    out.vertices.push_back(p);
    return added;
  };
  for (const auto& face : mesh.faces) {
    std::array<int, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = find(mesh.vertices[static_cast<std::size_t>(face[k])]);
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    out.faces.push_back(corners);
  }
  return out;
}

}  // namespace

void RefuseMesh(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::kBadData, path + ": " + why);
}

void AddMeshVertex(const std::string& path, const Vector3& p, Mesh& mesh) {
  if (!p.allFinite()) {
    RefuseMesh(path, "vertex " + std::to_string(mesh.vertices.size()) + " is (" + Number(p.x()) +
                         ", " + Number(p.y()) + ", " + Number(p.z()) +
                         "); finite numbers are needed");
  }
  mesh.vertices.push_back(p);
}

void AddMeshPolygon(const std::string& path, const std::vector<int>& corners, Mesh& mesh) {
  // Points and lines are nothing.
  for (std::size_t k = 2; k < corners.size(); ++k) {
    mesh.faces.push_back({corners[0], corners[k - 1], corners[k]});
  }
  if (mesh.faces.size() > kMaxMeshFaces) {
    RefuseMesh(path, "more than " + std::to_string(kMaxMeshFaces) +
                         " triangles; export it with a coarser tolerance");
  }
}

Mesh ReadMesh(const std::string& path) {
  const std::string ending = LowerCase(std::filesystem::path(path).extension().string());
  const std::string content = ReadFile(path);
  if (ending != ".stl" && ending != ".obj" && ending != ".ply") {
    const std::string other = MistakenContent(std::string_view(content).substr(0, 64));
    RefuseMesh(path, "the name ends in '" + Printable(ending) +
                         "'; meshes are read from .stl, .obj and .ply" +
                         (other.empty() ? "" : " (the file " + other + ")"));
  }
  if (content.empty()) RefuseMesh(path, "is empty");
  const Mesh raw = ending == ".stl"   ? ReadStl(path, content)
                   : ending == ".ply" ? ReadPlyMesh(path)
                                      : ReadObj(path, content);
  if (raw.faces.empty()) {
    RefuseMesh(path, "holds no triangle (" + std::to_string(raw.vertices.size()) +
                         " vertices); a surface is needed, a cloud is none");
  }
  Mesh mesh = Weld(raw);
  if (mesh.faces.empty()) RefuseMesh(path, "all its triangles are points or lines");
  return mesh;
}

}  // namespace tubetwin

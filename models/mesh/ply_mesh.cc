#include <algorithm>
#include <cmath>

#include "models/base/cloud/ply_rows.h"
#include "models/mesh/mesh_formats.h"

namespace tubetwin {
namespace {

/// The property with the corners of a face, as writers call it; -1: none.
int NeedCorners(PlyElement* element) {
  if (element == nullptr) return -1;
  for (const char* name : {"vertex_indices", "vertex_index", "vertex_indexes", "indices"}) {
    const int i = element->Find(name);
    if (i >= 0 && element->properties[static_cast<std::size_t>(i)].count)
      return element->Need(name);
  }
  return -1;
}

int NeedCoordinate(const std::string& path, PlyElement& vertex, const char* name) {
  const int i = vertex.Need(name);
  if (i < 0 || vertex.properties[static_cast<std::size_t>(i)].count) {
    RefuseMesh(path, std::string("element 'vertex' lacks property '") + name + "'");
  }
  return i;
}

/// Indices of vertices; -1 ends a strip.
std::vector<int> Corners(const std::string& path, const std::vector<double>& list,
                         std::size_t vertices, bool strip) {
  std::vector<int> corners;
  for (const double value : list) {
    const bool end = strip && value == -1.0;
    if (!end && !(value >= 0 && value < static_cast<double>(vertices))) {
      char text[64];
      std::snprintf(text, sizeof text, "a face names vertex %.0f of %zu", value, vertices);
      RefuseMesh(path, text);
    }
    corners.push_back(static_cast<int>(value));
  }
  return corners;
}

/// Triangles of a strip; every second is wound the other way.
void AddStrips(const std::string& path, const std::vector<int>& corners, Mesh& mesh) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < 0) {
      begin = i + 1;
    } else if (i >= begin + 2) {
      const bool odd = (i - begin) % 2 == 1;
      AddMeshPolygon(path, {corners[i - 2], corners[odd ? i : i - 1], corners[odd ? i - 1 : i]},
                     mesh);
    }
  }
}

}  // namespace

Mesh ReadPlyMesh(const std::string& path) {
  CloudFile file(path, "PLY file");
  PlyHeader header = ReadPlyHeader(file);
  PlyElement* vertex = header.Find("vertex");
  PlyElement* face = header.Find("face");
  PlyElement* strip = header.Find("tristrips");
  if (vertex == nullptr) RefuseMesh(path, "has no element 'vertex'");
  const int x = NeedCoordinate(path, *vertex, "x"), y = NeedCoordinate(path, *vertex, "y"),
            z = NeedCoordinate(path, *vertex, "z");
  const int of_face = NeedCorners(face), of_strip = NeedCorners(strip);
  Mesh mesh;
  std::vector<std::pair<bool, std::vector<double>>> lists;  // Checked when all vertices are known.
  PlyRows rows(file, header);
  PlyRow row;
  for (PlyElement& element : header.elements) {
    const int corners = &element == face ? of_face : &element == strip ? of_strip : -1;
    if (&element != vertex && corners < 0) {
      if (&element < std::max({vertex, face, strip})) rows.Skip(element);
      continue;
    }
    rows.RequireRoom(element);
    const std::size_t most = &element == vertex ? 3 * kMaxMeshFaces : kMaxMeshFaces;
    if (static_cast<std::uint64_t>(element.count) > most) {
      RefuseMesh(path, "element '" + element.name + "' has " + std::to_string(element.count) +
                           " rows, allowed are " + std::to_string(most) +
                           "; export it with a coarser tolerance");
    }
    for (std::int64_t i = 0; i < element.count; ++i) {
      rows.Read(element, i, row);
      if (&element == vertex) {
        AddMeshVertex(path, {row.values[x], row.values[y], row.values[z]}, mesh);
      } else {
        lists.emplace_back(&element == strip, row.lists[static_cast<std::size_t>(corners)]);
      }
    }
  }
  for (const auto& [is_strip, list] : lists) {
    const std::vector<int> corners = Corners(path, list, mesh.vertices.size(), is_strip);
    is_strip ? AddStrips(path, corners, mesh) : AddMeshPolygon(path, corners, mesh);
  }
  return mesh;
}

}  // namespace tubetwin

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/text.h"
#include "models/mesh/mesh.h"

/// What assimp calls when a file breaks an assumption of its readers: its own version ends the
/// program, this one takes its place when the program is linked and lets the reader fail.
namespace Assimp {
[[noreturn]] ASSIMP_API void aiAssertViolation(const char* expression, const char* /*file*/,
                                               int /*line*/) {
  throw std::runtime_error(std::string("broken assumption ") + expression);
}
}  // namespace Assimp

namespace tubetwin {
namespace {

constexpr std::size_t kMaxFaces = 2'000'000;
/// Vertices closer than this share of the box's diagonal are one.
constexpr double kWeld = 1e-5;

[[noreturn]] void Refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::kBadData, path + ": " + why);
}

std::string EndingOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

/// Bytes of a PLY type, or none.
std::optional<std::uint64_t> BytesOf(const std::string& type) {
  static const std::map<std::string, std::uint64_t> bytes = {
      {"char", 1},  {"uchar", 1},  {"int8", 1},    {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2}, {"int", 4},     {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"double", 8}, {"float32", 4}, {"float64", 8}};
  const auto found = bytes.find(type);
  return found == bytes.end() ? std::nullopt : std::optional(found->second);
}

/// What the header of a PLY file claims must be whole and fit into the file: the reader believes
/// it, for memory and for where it ends.
void CheckPlyHeader(const std::string& path, const std::string& content) {
  std::istringstream head(content.substr(0, std::min<std::size_t>(content.size(), 1 << 16)));
  std::string line;
  std::uint64_t count = 0, needed = 0;
  bool text = false;
  for (int number = 1; std::getline(head, line); ++number) {
    const auto refuse = [&] {
      Refuse(path, "line " + std::to_string(number) + " is no line of a PLY header: '" +
                       line.substr(0, 40) + "'");
    };
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::istringstream words(line);
    std::string word, kind, type, extra;
    words >> word >> kind >> type;
    if (number == 1 ? line != "ply" : word == "ply") refuse();
    if (line == "end_header") {
      const std::uint64_t held = content.size() - static_cast<std::uint64_t>(head.tellg());
      if (needed <= held) return;
      Refuse(path, "claims elements of at least " + std::to_string(needed) + " bytes, but holds " +
                       std::to_string(held) + "; the file is cut off or no mesh");
    }
    if (word == "format") {
      text = kind == "ascii";
      if (!text && kind != "binary_little_endian" && kind != "binary_big_endian") refuse();
    } else if (word == "element") {
      const bool digits = std::all_of(type.begin(), type.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
      if (type.empty() || !digits || type.size() > 12) refuse();
      count = std::stoull(type);
    } else if (word == "property") {
      const auto bytes = BytesOf(kind == "list" ? type : kind);
      if (!bytes || (kind == "list" && (!(words >> extra) || !BytesOf(extra)))) refuse();
      // A list is at least its length, a word of text a digit and a blank.
      needed += count * (text ? 2 : *bytes);
    } else if (number > 1 && word != "comment" && word != "obj_info") {
      refuse();
    }
  }
  Refuse(path, "has no end_header line; it is no PLY file");
}

/// Refuses headers that claim what the file does not hold.
void CheckHeader(const std::string& path, const std::string& ending, const std::string& content) {
  if (ending == ".ply") CheckPlyHeader(path, content);
  if (ending != ".stl" || content.rfind("solid", 0) == 0 || content.size() < 84) return;
  std::uint32_t faces = 0;
  std::memcpy(&faces, content.data() + 80, sizeof faces);
  if (84 + 50 * std::uint64_t{faces} <= content.size()) return;
  Refuse(path, "claims " + std::to_string(faces) + " triangles, but has only " +
                   std::to_string(content.size()) + " bytes; the file is cut off or no mesh");
}

/// All triangles of a scene; the file's vertices as they are, each face with its own.
Mesh Gather(const aiScene& scene, const std::string& path) {
  Mesh mesh;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    const std::size_t first = mesh.vertices.size();
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      mesh.vertices.push_back({v.x, v.y, v.z});
      if (!mesh.vertices.back().allFinite()) {
        Refuse(path, "vertex " + std::to_string(first + i) + " is (" + Number(v.x) + ", " +
                         Number(v.y) + ", " + Number(v.z) + "); finite numbers are needed");
      }
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) {
          Refuse(path, "a face names vertex " + std::to_string(face.mIndices[k]) + " of " +
                           std::to_string(part.mNumVertices));
        }
      }
      // Polygons become fans; points and lines are nothing.
      for (unsigned k = 2; k < face.mNumIndices; ++k) {
        mesh.faces.push_back({static_cast<int>(first + face.mIndices[0]),
                              static_cast<int>(first + face.mIndices[k - 1]),
                              static_cast<int>(first + face.mIndices[k])});
      }
    }
    if (mesh.faces.size() > kMaxFaces) {
      Refuse(path, "more than " + std::to_string(kMaxFaces) +
                       " triangles; export it with a coarser tolerance");
    }
  }
  return mesh;
}

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

Mesh ReadMesh(const std::string& path) {
  const std::string ending = EndingOf(path);
  const std::string content = ReadFile(path);
  if (ending != ".stl" && ending != ".obj" && ending != ".ply") {
    Refuse(path, "the name ends in '" + ending + "'; meshes are read from .stl, .obj and .ply");
  }
  if (content.empty()) Refuse(path, "is empty");
  CheckHeader(path, ending, content);
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFileFromMemory(content.data(), content.size(), 0, ending.c_str() + 1);
  } catch (const std::exception& e) {
    Refuse(path, std::string("cannot be read as a mesh: ") + e.what());
  }
  if (scene == nullptr) {
    // It quotes the file, of any bytes and length.
    std::string why = std::string(importer.GetErrorString()).substr(0, 120);
    for (char& c : why) c = std::isprint(static_cast<unsigned char>(c)) != 0 ? c : ' ';
    Refuse(path, "cannot be read as a mesh: " + (why.empty() ? "unknown content" : why));
  }
  const Mesh raw = Gather(*scene, path);
  if (raw.faces.empty()) {
    Refuse(path, "holds no triangle (" + std::to_string(raw.vertices.size()) +
                     " vertices); a surface is needed");
  }
  Mesh mesh = Weld(raw);
  if (mesh.faces.empty()) Refuse(path, "all its triangles are points or lines");
  return mesh;
}

}  // namespace tubetwin

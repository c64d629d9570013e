#include <algorithm>
#include <cstring>
#include <string_view>

#include "models/base/foreign/content.h"
#include "models/base/text.h"
#include "models/mesh/mesh_formats.h"

namespace tubetwin {
namespace {

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

/// Words of an STL text, for which the line ends count only behind a solid's name.
class StlText {
 public:
  StlText(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  Mesh Read() {
    Mesh mesh;
    while (true) {
      const std::string word = LowerCase(Word());
      if (word.empty()) break;
      if (word == "solid" || word == "endsolid") {
        SkipName();
      } else if (word == "facet") {
        if (open_) Refuse("begins a facet inside another");
        open_ = true;
        corners_.clear();
      } else if (word == "vertex") {
        corners_.push_back(static_cast<int>(mesh.vertices.size()));
        ReadVertex(mesh);
      } else if (word == "endfacet") {
        if (corners_.size() < 3) {
          Refuse("ends a facet of " + std::to_string(corners_.size()) + " vertices");
        }
        AddMeshPolygon(path_, corners_, mesh);
        open_ = false;
        corners_.clear();
      }
      // Anything else (normals, loops, what some programs add) is not needed.
    }
    if (open_ || !corners_.empty()) Refuse("ends inside a facet; the file is cut off");
    return mesh;
  }

 private:
  [[noreturn]] void Refuse(const std::string& problem) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(at_), '\n');
    RefuseMesh(path_, "line " + std::to_string(line) + " " + problem);
  }
  static bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0'; }
  std::string_view Word() {
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !IsBlank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  /// To the line's end, or to the first facet where all stands in one line.
  void SkipName() {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::size_t facet = LowerCase(text_.substr(at_, end - at_)).find(" facet normal");
    at_ = facet == std::string::npos ? end : at_ + facet;
  }
  void ReadVertex(Mesh& mesh) {
    Vector3 p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = Word();
      const auto value = ParseNumber(word);
      if (!value) Refuse("has '" + Printable(word.substr(0, 40)) + "' where a number is needed");
      p[k] = *value;
    }
    AddMeshVertex(path_, p, mesh);
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  bool open_ = false;  ///< Within a facet.
  std::vector<int> corners_;
};

Mesh ReadBinaryStl(const std::string& path, const std::string& content, std::uint32_t faces) {
  if (faces > kMaxMeshFaces) {
    RefuseMesh(path, "claims " + std::to_string(faces) + " triangles, allowed are " +
                         std::to_string(kMaxMeshFaces) + "; export it with a coarser tolerance");
  }
  Mesh mesh;
  for (std::uint32_t f = 0; f < faces; ++f) {
    // Twelve floats, the normal first, and two bytes of anything.
    float values[12];
    std::memcpy(values, content.data() + kStlHeader + f * kStlTriangle, sizeof values);
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 3; k < 12; k += 3) {
      AddMeshVertex(path, {values[k], values[k + 1], values[k + 2]}, mesh);
    }
    AddMeshPolygon(path, {first, first + 1, first + 2}, mesh);
  }
  return mesh;
}

}  // namespace

Mesh ReadStl(const std::string& path, const std::string& content) {
  // The number of triangles has a zero byte, which no text has; "solid" may begin either.
  const std::string_view head = std::string_view(content).substr(0, 512);
  std::uint32_t faces = 0;
  if (content.size() >= kStlHeader) std::memcpy(&faces, content.data() + 80, sizeof faces);
  const bool binary = content.size() >= kStlHeader && head.find('\0') != std::string_view::npos;
  if (binary && kStlHeader + kStlTriangle * std::uint64_t{faces} <= content.size()) {
    return ReadBinaryStl(path, content, faces);
  }
  const std::string other = MistakenContent(head);
  if (!other.empty() && other != "is an STL mesh") RefuseMesh(path, "no STL mesh: it " + other);
  if (binary) {
    RefuseMesh(path, "claims " + std::to_string(faces) + " triangles, but has only " +
                         std::to_string(content.size()) + " bytes; the file is cut off or no mesh");
  }
  return StlText(path, content).Read();
}

}  // namespace tubetwin

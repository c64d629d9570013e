#include <algorithm>
#include <charconv>
#include <string_view>

#include "models/base/foreign/content.h"
#include "models/base/text.h"
#include "models/mesh/mesh_formats.h"

namespace tubetwin {
namespace {

/// Reads `v` and `f` of Wavefront OBJ; what else there is (normals, textures, groups, materials,
/// lines, points, curves) makes no surface.
class ObjText {
 public:
  ObjText(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  Mesh Read() {
    while (NextLine()) {
      const std::string key = LowerCase(Word());
      if (key == "v") {
        ReadVertex();
      } else if (key == "f") {
        ReadFace();
      }
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void Refuse(const std::string& problem) const {
    RefuseMesh(path_, "line " + std::to_string(number_) + " " + problem);
  }
  /// Lines end in LF, CR LF or CR; one that ends in a backslash goes on in the next.
  bool NextLine() {
    if (rest_.empty()) return false;
    line_.clear();
    bool more = true;
    while (more && !rest_.empty()) {
      const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
      line_ += rest_.substr(0, end);
      rest_ = rest_.substr(
          std::min(end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1), rest_.size()));
      ++number_;
      more = line_.ends_with('\\');
      if (more) line_.back() = ' ';
    }
    at_ = 0;
    return true;
  }
  std::string_view Word() {
    const std::string_view line = line_;
    at_ = std::min(line.find_first_not_of(" \t\v\f", at_), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t\v\f", at_), line.size());
    const std::string_view word = line.substr(at_, end - at_);
    at_ = end;
    return word.starts_with('#') ? std::string_view() : word;
  }
  void ReadVertex() {
    Vector3 p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = Word();
      const auto value = ParseNumber(word);
      if (!value) {
        Refuse("has '" + Printable(word.substr(0, 40)) + "' where a vertex needs a number");
      }
      p[k] = *value;
    }
    AddMeshVertex(path_, p, mesh_);
  }
  /// Corners count from 1, or back from the last vertex; what follows a slash is no corner.
  void ReadFace() {
    std::vector<int> corners;
    for (std::string_view word = Word(); !word.empty(); word = Word()) {
      const std::string_view number = word.substr(0, word.find('/'));
      const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
      std::int64_t index = 0;
      const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), index);
      const bool whole = code == std::errc() && end == number.data() + number.size();
      if (!whole || index == 0 || index > count || index < -count) {
        Refuse("has a face with corner '" + Printable(word.substr(0, 40)) + "', allowed are 1 to " +
               std::to_string(count) + ", or negative: back from the last");
      }
      corners.push_back(static_cast<int>(index > 0 ? index - 1 : count + index));
    }
    AddMeshPolygon(path_, corners, mesh_);
  }

  const std::string& path_;
  std::string_view rest_;
  std::string line_;
  std::size_t at_ = 0;
  int number_ = 0;
  Mesh mesh_;
};

}  // namespace

Mesh ReadObj(const std::string& path, const std::string& content) {
  const std::string other = MistakenContent(std::string_view(content).substr(0, 64));
  if (!other.empty()) RefuseMesh(path, "no OBJ mesh: it " + other);
  const std::string_view text = content;
  return ObjText(path, text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0)).Read();
}

}  // namespace tubetwin

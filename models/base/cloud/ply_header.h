#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/cloud/cloud_file.h"

namespace tubetwin {

/// A number's type. Internal to the readers of PLY clouds and meshes, as is all of this file.
struct PlyType {
  char kind = 'F';  ///< 'I' signed, 'U' unsigned, 'F' floating.
  int size = 4;     ///< Bytes; 0: a name that is not known, which only text can hold.
};

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count;  ///< Of a list: the type of its length.
  bool needed = false;           ///< PlyRows looks only into those.
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of the first property of that name (in letters of any size), or -1.
  int Find(std::string_view property) const;
  /// Find(), and has PlyRows read it from now on.
  int Need(std::string_view property);
  /// Fewest bytes that a row takes in a file.
  std::uint64_t SmallestRow(bool text) const;
};

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

/// What a PLY file says before its data.
struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;             ///< In the file's order.
  std::vector<std::vector<std::string>> notes;  ///< Words of each `comment` and `obj_info`.

  bool text() const { return format == PlyFormat::kAscii; }
  /// The first element of that name, or null.
  PlyElement* Find(std::string_view name);
};

/// Reads the header up to its data. Throws Error(kBadData) naming line, entry, value and what is
/// allowed.
PlyHeader ReadPlyHeader(CloudFile& file);

}  // namespace tubetwin

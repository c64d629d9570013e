#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/cloud/cloud_file.h"

namespace tubetwin {

/// One entry of FIELDS. Internal to models/base, as is all of this file.
struct PcdField {
  std::string name;
  std::string type = "F";
  int size = 4;
  /// 0 takes no place in the data; PCL also writes padding "_" of a negative count, which goes
  /// back, where fields are not named in the order of their places.
  int count = 1;
  std::size_t offset = 0;  ///< Of its first element in a binary record.
  int column = 0;          ///< Of its first element in an ascii record.

  /// In the data of its own, without going back.
  std::size_t bytes() const { return static_cast<std::size_t>(size) * (count > 0 ? count : 0); }
};

enum class PcdData { kAscii, kBinary, kCompressed };

/// What a PCD file says before its data.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::int64_t width = 0, height = 0, points = 0;
  RigidTransform X_NS = RigidTransform::Identity();
  std::optional<double> unit_m;  ///< From a comment "# units mm".
  PcdData data = PcdData::kBinary;
  std::size_t record_size = 0;
  int columns = 0;

  /// The first field of that name (in small letters; the file's may be large), or null.
  const PcdField* Find(std::string_view name) const;
};

/// Reads the header of PCD 0.5, 0.6 or 0.7 up to its data. What nobody needs (types and counts of
/// other fields, HEIGHT or POINTS where the others say it) may be missing or foreign. Throws
/// Error(kBadData) naming line, entry, value and what is allowed.
PcdHeader ReadPcdHeader(CloudFile& file);

}  // namespace tubetwin

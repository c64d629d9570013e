#include "models/base/cloud/pcd_header.h"

#include <algorithm>
#include <cmath>

#include "models/base/foreign/length_unit.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr std::int64_t kMaxSide = 2147483647;

using Words = std::vector<std::string_view>;

/// The lines of a header that were seen, by their names as the format spells them.
struct Seen {
  std::vector<std::string> keys;
  bool Has(std::string_view key) const {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  }
};

RigidTransform ParseViewpoint(const CloudFile& file, const Words& words) {
  if (words.size() != 8) {
    file.FailLine("VIEWPOINT has " + std::to_string(words.size() - 1) +
                  " numbers, 7 are needed: tx ty tz qw qx qy qz");
  }
  double v[7];
  for (int i = 0; i < 7; ++i) v[i] = HeaderNumber(file, "VIEWPOINT", words[1 + i]);
  // Nothing but zeros: the writer knew no pose.
  if (std::all_of(v, v + 7, [](double value) { return value == 0.0; })) {
    return RigidTransform::Identity();
  }
  const double norm = std::sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
  constexpr double kUnitTolerance = 1e-3;  // Files with four decimals pass, a wrong order does not.
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) {
    std::string unit;
    for (int i = 3; i < 7 && norm > 0; ++i) unit += " " + Number(v[i] / norm);
    file.FailLine("VIEWPOINT's quaternion (qw qx qy qz) has norm " + Number(norm) +
                  ", allowed is 1 within " + Number(kUnitTolerance) +
                  (unit.empty() ? "" : "; of that direction:" + unit));
  }
  return MakeTransform(RotationFromWxyz(v[3], v[4], v[5], v[6]), {v[0], v[1], v[2]});
}

void ParseFields(const CloudFile& file, const Words& words, PcdHeader& header) {
  constexpr std::size_t kMaxFields = 256;
  if (words.size() < 2 || words.size() - 1 > kMaxFields) {
    file.FailLine("FIELDS has " + std::to_string(words.size() - 1) +
                  " names, allowed are 3 to 256, among them x y z");
  }
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string low = LowerCase(words[i]);
    if ((low == "x" || low == "y" || low == "z") && header.Find(low) != nullptr) {
      file.FailLine("FIELDS names " + Quoted(words[i]) + " twice");
    }
    PcdField field;
    field.name = words[i];
    header.fields.push_back(std::move(field));
  }
}

/// SIZE, TYPE or COUNT: one entry per field.
void ParsePerField(const CloudFile& file, const std::string& key, const Words& words,
                   PcdHeader& header) {
  if (header.fields.empty()) file.FailLine(key + " stands before FIELDS");
  if (words.size() - 1 != header.fields.size()) {
    file.FailLine(key + " has " + std::to_string(words.size() - 1) + " entries, FIELDS has " +
                  std::to_string(header.fields.size()));
  }
  constexpr std::int64_t kMost = 65536;
  for (std::size_t i = 1; i < words.size(); ++i) {
    PcdField& field = header.fields[i - 1];
    const std::string name = key + " of field " + Quoted(field.name);
    if (key == "SIZE") {
      field.size = static_cast<int>(HeaderInteger(file, name, words[i], 1, kMost));
    } else if (key == "TYPE") {
      field.type = words[i].size() == 1 ? std::string(1, static_cast<char>(words[i][0] & ~0x20))
                                        : std::string(words[i]);
    } else {
      const std::int64_t least = field.name == "_" ? -kMost : 0;
      field.count = static_cast<int>(HeaderInteger(file, name, words[i], least, kMost));
    }
  }
}

/// Whether a needed field holds numbers that this machine has; in text any type does.
bool IsNumber(const PcdField& field, PcdData data) {
  if (field.count != 1) return false;
  if (data == PcdData::kAscii) return true;
  const int n = field.size;
  if (field.type == "F") return n == 4 || n == 8;
  return (field.type == "U" || field.type == "I") && (n == 1 || n == 2 || n == 4 || n == 8);
}

void RequireCoordinates(const CloudFile& file, const PcdHeader& header) {
  for (const char* name : {"x", "y", "z"}) {
    const PcdField* field = header.Find(name);
    if (field == nullptr) {
      std::vector<std::string> names;
      for (const PcdField& f : header.fields) names.push_back(f.name);
      const std::string all = Join(names, " ");
      file.FailLine("FIELDS lacks '" + std::string(name) + "', it has: " +
                    Printable(all.substr(0, 200)) + (all.size() > 200 ? " ..." : ""));
    }
    if (!IsNumber(*field, header.data)) {
      file.FailLine("field '" + field->name + "' has TYPE " + Printable(field->type.substr(0, 8)) +
                    ", SIZE " + std::to_string(field->size) + ", COUNT " +
                    std::to_string(field->count) +
                    ", allowed is COUNT 1 and TYPE F, SIZE 4 or 8, or TYPE I or U, SIZE 1, 2, 4 "
                    "or 8");
    }
  }
}

/// WIDTH, HEIGHT and POINTS say the same thing twice, so that one of them may be missing (a HEIGHT
/// of 0 is none).
void FinishShape(const CloudFile& file, const Seen& seen, PcdHeader& header) {
  const bool points = seen.Has("POINTS"), width = seen.Has("WIDTH");
  if (!points && !width) file.FailLine("the header ends without a line WIDTH or POINTS");
  if (!width) header.width = header.points / std::max<std::int64_t>(header.height, 1);
  if (header.height == 0) {
    header.height = points && header.points % header.width == 0 ? header.points / header.width : 1;
  }
  if (!points) header.points = header.width * header.height;
  if (header.height > kMaxSide || header.width > kMaxSide ||
      header.points != header.width * header.height) {
    file.FailLine("POINTS is " + std::to_string(header.points) + ", WIDTH x HEIGHT is " +
                  std::to_string(header.width) + " x " + std::to_string(header.height) + " = " +
                  std::to_string(header.width * header.height));
  }
}

/// Checks that depend on several lines; positions of the fields.
void FinishHeader(const CloudFile& file, const Seen& seen, bool old, PcdHeader& header) {
  if (!seen.Has("FIELDS")) file.FailLine("the header ends without a line FIELDS");
  // In text they say nothing, and the first versions knew float32 alone.
  for (const char* needed : {"SIZE", "TYPE"}) {
    if (header.data != PcdData::kAscii && !old && !seen.Has(needed)) {
      file.FailLine("the header ends without a line " + std::string(needed));
    }
  }
  RequireCoordinates(file, header);
  FinishShape(file, seen, header);
  std::int64_t offset = 0;
  for (PcdField& field : header.fields) {
    field.offset = static_cast<std::size_t>(std::max<std::int64_t>(offset, 0));
    field.column = header.columns;
    offset += std::int64_t{field.size} * field.count;
    if (offset < 0) file.FailLine("COUNT of padding '_' goes back before the point's beginning");
    header.columns += std::max(field.count, 0);
  }
  header.record_size = static_cast<std::size_t>(offset);
  for (const PcdField& field : header.fields) {
    if (field.offset + field.bytes() > header.record_size) {
      file.FailLine("field " + Quoted(field.name) + " ends behind its point, by the COUNT of '_'");
    }
  }
}

/// Whether the version is one of those before 0.7.
bool ParseVersion(const CloudFile& file, std::string_view word) {
  const std::string_view digits = word.substr(word.starts_with("0.") ? 1 : 0);
  if (digits != ".5" && digits != ".6" && digits != ".7") {
    file.FailLine("VERSION is " + Quoted(word) + ", allowed are 0.5, 0.6, 0.7");
  }
  return digits != ".7";
}

void ParseData(const CloudFile& file, std::string_view word, PcdHeader& header) {
  const std::string data = LowerCase(word);
  if (data == "ascii") {
    header.data = PcdData::kAscii;
  } else if (data == "binary") {
    header.data = PcdData::kBinary;
  } else if (data == "binary_compressed") {
    header.data = PcdData::kCompressed;
  } else {
    file.FailLine("DATA is " + Quoted(word) + ", allowed are binary, binary_compressed, ascii");
  }
}

/// The name of a header line as the format spells it.
std::string KeyOf(const CloudFile& file, std::string_view word) {
  static const std::vector<std::string> kKeys = {"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                 "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                 "VIEWPOINT", "POINTS", "DATA"};
  std::string key(word.substr(0, 40));
  for (char& c : key) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  if (key == "COLUMNS") return "FIELDS";
  if (std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end()) return key;
  file.FailLine(Quoted(word) + " is no PCD header entry, nearest is " + NearestName(key, kKeys));
}

}  // namespace

const PcdField* PcdHeader::Find(std::string_view name) const {
  for (const PcdField& field : fields) {
    if (LowerCase(field.name) == name) return &field;
  }
  return nullptr;
}

PcdHeader ReadPcdHeader(CloudFile& file) {
  PcdHeader header;
  Seen seen;
  bool old = false;
  while (!seen.Has("DATA")) {
    const std::string line = file.HeaderLine();
    Words words = SplitWords(line);
    const auto comment = std::find_if(words.begin(), words.end(),
                                      [](std::string_view word) { return word[0] == '#'; });
    if (comment != words.end()) {
      Words said(comment, words.end());
      said.front().remove_prefix(1);
      if (const auto unit_m = UnitOfComment(said)) header.unit_m = unit_m;
      words.erase(comment, words.end());
    }
    if (words.empty()) continue;
    const std::string key = KeyOf(file, words[0]);
    if (seen.Has(key)) file.FailLine(key + " is given twice");
    const bool list = key == "FIELDS" || key == "SIZE" || key == "TYPE" || key == "COUNT";
    if (!list && key != "VIEWPOINT" && words.size() != 2) {
      file.FailLine(key + " needs exactly one value");
    }
    if (key == "FIELDS") {
      ParseFields(file, words, header);
    } else if (list) {
      ParsePerField(file, key, words, header);
    } else if (key == "VIEWPOINT") {
      header.X_NS = ParseViewpoint(file, words);
    } else if (key == "VERSION") {
      old = ParseVersion(file, words[1]);
    } else if (key == "WIDTH") {
      header.width = HeaderInteger(file, key, words[1], 1, kMaxSide);
    } else if (key == "HEIGHT") {
      header.height = HeaderInteger(file, key, words[1], 0, kMaxSide);
    } else if (key == "POINTS") {
      header.points = HeaderInteger(file, key, words[1], 1, kMaxSide * kMaxSide);
    } else {
      ParseData(file, words[1], header);
    }
    seen.keys.push_back(key);
  }
  FinishHeader(file, seen, old, header);
  return header;
}

}  // namespace tubetwin

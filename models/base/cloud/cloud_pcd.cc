#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "models/base/cloud/cloud.h"
#include "models/base/cloud/cloud_file.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr std::int64_t kMaxSide = 2147483647;

struct PcdField {
  std::string name;
  char type = 'F';
  int size = 4;
  int count = 1;
  std::size_t offset = 0;  ///< Of its first element in a binary record.
  int column = 0;          ///< Of its first element in an ascii record.
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::int64_t width = 0, height = 0, points = 0;
  RigidTransform X_NS = RigidTransform::Identity();
  bool binary = true;
  std::size_t record_size = 0;
  int columns = 0;

  const PcdField* Find(std::string_view name) const {
    for (const PcdField& field : fields) {
      if (field.name == name) return &field;
    }
    return nullptr;
  }
};

/// A word of the file as a message may show it.
std::string Text(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return "'" + text + "'";
}

RigidTransform ParseViewpoint(const CloudFile& file, const std::vector<std::string_view>& words) {
  if (words.size() != 8) {
    file.FailLine("VIEWPOINT has " + std::to_string(words.size() - 1) +
                  " numbers, 7 are needed: tx ty tz qw qx qy qz");
  }
  double v[7];
  for (int i = 0; i < 7; ++i) v[i] = HeaderNumber(file, "VIEWPOINT", words[1 + i]);
  const double norm = std::sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
  constexpr double kUnitTolerance = 1e-3;  // Files with four decimals pass, a wrong order does not.
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) {
    file.FailLine("VIEWPOINT's quaternion (qw qx qy qz) has norm " + Number(norm) +
                  ", allowed is 1 within " + Number(kUnitTolerance));
  }
  return MakeTransform(RotationFromWxyz(v[3], v[4], v[5], v[6]), {v[0], v[1], v[2]});
}

/// The words of a per-field line; their number must be that of FIELDS, which must come first.
void RequirePerField(const CloudFile& file, const std::vector<std::string_view>& words,
                     const PcdHeader& header) {
  if (header.fields.empty()) file.FailLine(std::string(words[0]) + " stands before FIELDS");
  if (words.size() - 1 != header.fields.size()) {
    file.FailLine(std::string(words[0]) + " has " + std::to_string(words.size() - 1) +
                  " entries, FIELDS has " + std::to_string(header.fields.size()));
  }
}

void ParseFields(const CloudFile& file, const std::vector<std::string_view>& words,
                 PcdHeader& header) {
  constexpr std::size_t kMaxFields = 256;
  if (words.size() < 2 || words.size() - 1 > kMaxFields) {
    file.FailLine("FIELDS has " + std::to_string(words.size() - 1) +
                  " names, allowed are 3 to 256, among them x y z");
  }
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] != "_" && header.Find(words[i]) != nullptr) {
      file.FailLine("FIELDS names " + Text(words[i]) + " twice");
    }
    header.fields.push_back({std::string(words[i])});
  }
}

void ParsePerField(const CloudFile& file, const std::vector<std::string_view>& words,
                   PcdHeader& header) {
  RequirePerField(file, words, header);
  for (std::size_t i = 1; i < words.size(); ++i) {
    PcdField& field = header.fields[i - 1];
    const std::string name = std::string(words[0]) + " of field '" + field.name + "'";
    if (words[0] == "SIZE") {
      field.size = static_cast<int>(HeaderInteger(file, name, words[i], 1, 8));
      if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8) {
        file.FailLine(name + " is " + Text(words[i]) + ", allowed are 1, 2, 4, 8");
      }
    } else if (words[0] == "TYPE") {
      if (words[i] != "F" && words[i] != "U" && words[i] != "I") {
        file.FailLine(name + " is " + Text(words[i]) + ", allowed are F, U, I");
      }
      field.type = words[i][0];
    } else {
      field.count = static_cast<int>(HeaderInteger(file, name, words[i], 1, 65536));
    }
  }
}

void RequireType(const CloudFile& file, const PcdField& field, char type,
                 std::initializer_list<int> sizes, const std::string& allowed) {
  const bool size_ok = std::find(sizes.begin(), sizes.end(), field.size) != sizes.end();
  if (field.type != type || !size_ok || field.count != 1) {
    file.FailLine("field '" + field.name + "' has TYPE " + field.type + ", SIZE " +
                  std::to_string(field.size) + ", COUNT " + std::to_string(field.count) +
                  ", allowed is " + allowed);
  }
}

/// Checks that depend on several lines; positions of the fields.
void FinishHeader(const CloudFile& file, PcdHeader& header, const std::vector<std::string>& seen) {
  for (const char* needed : {"FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT", "POINTS"}) {
    if (std::find(seen.begin(), seen.end(), needed) == seen.end()) {
      file.FailLine("the header ends without a line " + std::string(needed));
    }
  }
  for (const char* name : {"x", "y", "z"}) {
    const PcdField* field = header.Find(name);
    if (field == nullptr) {
      std::vector<std::string> names;
      for (const PcdField& f : header.fields) names.push_back(f.name);
      file.FailLine("FIELDS lacks '" + std::string(name) + "', it has: " + Join(names, " "));
    }
    RequireType(file, *field, 'F', {4, 8}, "TYPE F, SIZE 4 or 8, COUNT 1");
  }
  if (const PcdField* f = header.Find("intensity")) {
    RequireType(file, *f, 'F', {4, 8}, "TYPE F, SIZE 4 or 8, COUNT 1");
  }
  if (const PcdField* f = header.Find("label")) {
    RequireType(file, *f, 'U', {1, 2, 4}, "TYPE U, SIZE 1, 2 or 4, COUNT 1");
  }
  if (header.points != header.width * header.height) {
    file.FailLine("POINTS is " + std::to_string(header.points) + ", WIDTH x HEIGHT is " +
                  std::to_string(header.width) + " x " + std::to_string(header.height) + " = " +
                  std::to_string(header.width * header.height));
  }
  for (PcdField& field : header.fields) {
    field.offset = header.record_size;
    field.column = header.columns;
    header.record_size += static_cast<std::size_t>(field.size) * field.count;
    header.columns += field.count;
  }
}

void ParseHeaderLine(const CloudFile& file, const std::vector<std::string_view>& words,
                     PcdHeader& header) {
  const std::string_view key = words[0];
  if (key == "FIELDS") return ParseFields(file, words, header);
  if (key == "SIZE" || key == "TYPE" || key == "COUNT") return ParsePerField(file, words, header);
  if (key == "VIEWPOINT") {
    header.X_NS = ParseViewpoint(file, words);
    return;
  }
  if (words.size() != 2) file.FailLine(std::string(key) + " needs exactly one value");
  if (key == "VERSION") {
    if (words[1] != "0.7" && words[1] != ".7") {
      file.FailLine("VERSION is " + Text(words[1]) + ", allowed is 0.7");
    }
  } else if (key == "WIDTH") {
    header.width = HeaderInteger(file, "WIDTH", words[1], 1, kMaxSide);
  } else if (key == "HEIGHT") {
    header.height = HeaderInteger(file, "HEIGHT", words[1], 1, kMaxSide);
  } else if (key == "POINTS") {
    header.points = HeaderInteger(file, "POINTS", words[1], 1, kMaxSide * kMaxSide);
  } else {
    if (words[1] != "binary" && words[1] != "ascii") {
      file.FailLine("DATA is " + Text(words[1]) + ", allowed are binary, ascii");
    }
    header.binary = words[1] == "binary";
  }
}

PcdHeader ReadHeader(CloudFile& file) {
  static const std::vector<std::string> kKeys = {"VERSION", "FIELDS", "SIZE",   "TYPE",
                                                 "COUNT",   "WIDTH",  "HEIGHT", "VIEWPOINT",
                                                 "POINTS",  "DATA"};
  PcdHeader header;
  std::vector<std::string> seen;
  while (seen.empty() || seen.back() != "DATA") {
    const std::string line = file.HeaderLine();
    const std::vector<std::string_view> words = SplitWords(line);
    if (words.empty() || words[0].front() == '#') continue;
    const std::string key(words[0]);
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      file.FailLine(Text(key) + " is no PCD header entry, nearest is " + NearestName(key, kKeys));
    }
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      file.FailLine(key + " is given twice");
    }
    ParseHeaderLine(file, words, header);
    seen.push_back(key);
  }
  FinishHeader(file, header, seen);
  return header;
}

float LoadFloat(const char* record, const PcdField& field) {
  if (field.size == 8) {
    double value;
    std::memcpy(&value, record + field.offset, sizeof value);
    return static_cast<float>(value);
  }
  float value;
  std::memcpy(&value, record + field.offset, sizeof value);
  return value;
}

std::uint32_t LoadUnsigned(const char* record, const PcdField& field) {
  std::uint32_t value = 0;  // Little-endian: the low bytes come first.
  std::memcpy(&value, record + field.offset, static_cast<std::size_t>(field.size));
  return value;
}

void ReadBinary(CloudFile& file, const PcdHeader& header, OrganizedCloud& cloud) {
  const PcdField& x = *header.Find("x");
  const PcdField& y = *header.Find("y");
  const PcdField& z = *header.Find("z");
  const PcdField* intensity = header.Find("intensity");
  const PcdField* label = header.Find("label");
  const std::size_t block_points = std::max<std::size_t>(1, (1u << 20) / header.record_size);
  std::vector<char> block(std::min<std::size_t>(block_points, cloud.size()) * header.record_size);
  for (std::size_t first = 0; first < cloud.size(); first += block_points) {
    const std::size_t n = std::min(block_points, cloud.size() - first);
    file.ReadBytes(block.data(), n * header.record_size);
    for (std::size_t i = 0; i < n; ++i) {
      const char* record = block.data() + i * header.record_size;
      cloud.p_SP[first + i] = {LoadFloat(record, x), LoadFloat(record, y), LoadFloat(record, z)};
      if (intensity != nullptr) cloud.intensity[first + i] = LoadFloat(record, *intensity);
      if (label != nullptr) cloud.label[first + i] = LoadUnsigned(record, *label);
    }
  }
}

/// Reads the numbers of the ascii data one by one and stores those that are wanted.
class AsciiReader {
 public:
  AsciiReader(CloudFile& file, const PcdHeader& header) : file_(file), header_(header) {
    begin_ = file.position();
    text_.resize(file.size() - begin_);
    file.ReadBytes(text_.data(), text_.size());
  }

  void Read(OrganizedCloud& cloud) {
    const int label_column = header_.Find("label") ? header_.Find("label")->column : -1;
    const int intensity_column = header_.Find("intensity") ? header_.Find("intensity")->column : -1;
    const int p_column[3] = {header_.Find("x")->column, header_.Find("y")->column,
                             header_.Find("z")->column};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (int column = 0; column < header_.columns; ++column) {
        const double value = Next(i, column);
        for (int k = 0; k < 3; ++k) {
          if (column == p_column[k]) cloud.p_SP[i][k] = static_cast<float>(value);
        }
        if (column == intensity_column) cloud.intensity[i] = static_cast<float>(value);
        if (column == label_column) {
          if (!(value >= 0.0 && value <= 4294967295.0) || value != std::floor(value)) {
            Fail(i, column, "is " + Number(value) + ", allowed are whole numbers 0 to 4294967295");
          }
          cloud.label[i] = static_cast<std::uint32_t>(value);
        }
      }
    }
    SkipBlanks();
    if (at_ != text_.size()) {
      file_.FailByte(begin_ + at_,
                     "data goes on after the last of POINTS " + std::to_string(header_.points));
    }
  }

 private:
  void SkipBlanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  [[noreturn]] void Fail(std::size_t point, int column, const std::string& problem) const {
    std::string name;
    for (const PcdField& field : header_.fields) {
      if (field.column <= column) name = field.name;
    }
    const auto line = file_.line() + 1 + std::count(text_.begin(), text_.begin() + at_, '\n');
    throw Error(ErrorKind::kBadData, file_.path() + ":" + std::to_string(line) + ": point " +
                                         std::to_string(point) + ", field '" + name + "' " +
                                         problem);
  }
  double Next(std::size_t point, int column) {
    SkipBlanks();
    if (at_ == text_.size()) {
      Fail(point, column, "is missing: the data ends at byte " + std::to_string(file_.size()));
    }
    double value = 0;
    const char* end = text_.data() + text_.size();
    const auto [stop, code] = std::from_chars(text_.data() + at_, end, value);
    const bool whole = stop == end || std::strchr(" \t\r\n", *stop) != nullptr;
    if (code != std::errc() || !whole) {
      const std::size_t word_end = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
      Fail(point, column,
           "is " + Text(std::string_view(text_).substr(at_, word_end - at_)) + ", no number");
    }
    at_ = static_cast<std::size_t>(stop - text_.data());
    return value;
  }

  CloudFile& file_;
  const PcdHeader& header_;
  std::uint64_t begin_ = 0;
  std::string text_;
  std::size_t at_ = 0;
};

/// Compares what the header claims with what the file holds, before anything is allocated.
void RequireData(const CloudFile& file, const PcdHeader& header) {
  const std::uint64_t left = file.size() - file.position();
  const auto points = static_cast<std::uint64_t>(header.points);
  if (header.binary) {
    const bool fits = points <= left / header.record_size;
    if (!fits || points * header.record_size != left) {
      file.FailByte(file.position(), "POINTS " + std::to_string(points) + " of " +
                                         std::to_string(header.record_size) + " bytes each need " +
                                         (fits ? "less" : "more") + " than the " +
                                         std::to_string(left) + " bytes of data that follow (" +
                                         std::to_string(left / header.record_size) +
                                         " whole points)");
    }
  } else if (points > left / (2 * static_cast<std::uint64_t>(header.columns)) + 1) {
    // A number and what separates it from the next take at least two bytes.
    file.FailByte(file.position(), "POINTS " + std::to_string(points) + " of " +
                                       std::to_string(header.columns) +
                                       " numbers each need more than the " + std::to_string(left) +
                                       " bytes of data that follow");
  }
}

}  // namespace

OrganizedCloud ReadPcd(const std::string& path) {
  CloudFile file(path);
  const PcdHeader header = ReadHeader(file);
  RequireData(file, header);
  OrganizedCloud cloud;
  cloud.width = static_cast<int>(header.width);
  cloud.height = static_cast<int>(header.height);
  cloud.X_NS = header.X_NS;
  const auto points = static_cast<std::size_t>(header.points);
  cloud.p_SP.resize(points);
  if (header.Find("intensity") != nullptr) cloud.intensity.resize(points);
  if (header.Find("label") != nullptr) cloud.label.resize(points);
  if (header.binary) {
    ReadBinary(file, header, cloud);
  } else {
    AsciiReader(file, header).Read(cloud);
  }
  FinishPoints(file, cloud);
  return cloud;
}

}  // namespace tubetwin

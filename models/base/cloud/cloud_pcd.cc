#include <algorithm>
#include <cmath>
#include <cstring>

#include "models/base/cloud/cloud.h"
#include "models/base/cloud/cloud_file.h"
#include "models/base/cloud/column_number.h"
#include "models/base/cloud/lzf.h"
#include "models/base/cloud/pcd_header.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

double LoadNumber(const char* bytes, const PcdField& field) {
  const char kind = field.type == "F" ? 'F' : field.type == "I" ? 'I' : 'U';
  return ColumnNumber(bytes, kind, field.size);
}

/// What is read of a record: x, y, z, and intensity and label where they are as WritePcd() writes
/// them. All else in those two columns is someone else's and left out.
struct Wanted {
  explicit Wanted(const PcdHeader& header)
      : p{header.Find("x"), header.Find("y"), header.Find("z")},
        intensity(header.Find("intensity")),
        label(header.Find("label")) {
    const auto is = [](const PcdField& field, const char* type, std::initializer_list<int> sizes) {
      return field.type == type && field.count == 1 &&
             std::find(sizes.begin(), sizes.end(), field.size) != sizes.end();
    };
    if (intensity != nullptr && !is(*intensity, "F", {4, 8})) intensity = nullptr;
    if (label != nullptr && !is(*label, "U", {1, 2, 4})) label = nullptr;
  }
  void Resize(OrganizedCloud& cloud) const {
    if (intensity != nullptr) cloud.intensity.resize(cloud.size());
    if (label != nullptr) cloud.label.resize(cloud.size());
  }

  const PcdField* p[3];
  const PcdField* intensity;
  const PcdField* label;
};

void ReadBinary(CloudFile& file, const PcdHeader& header, OrganizedCloud& cloud) {
  const Wanted wanted(header);
  wanted.Resize(cloud);
  const std::size_t block_points = std::max<std::size_t>(1, (1u << 20) / header.record_size);
  std::vector<char> block(std::min<std::size_t>(block_points, cloud.size()) * header.record_size);
  for (std::size_t first = 0; first < cloud.size(); first += block_points) {
    const std::size_t n = std::min(block_points, cloud.size() - first);
    file.ReadBytes(block.data(), n * header.record_size);
    for (std::size_t i = 0; i < n; ++i) {
      const char* record = block.data() + i * header.record_size;
      const auto load = [&](const PcdField& f) { return LoadNumber(record + f.offset, f); };
      for (int k = 0; k < 3; ++k) {
        cloud.p_SP[first + i][k] = static_cast<float>(load(*wanted.p[k]));
      }
      if (wanted.intensity != nullptr) {
        cloud.intensity[first + i] = static_cast<float>(load(*wanted.intensity));
      }
      if (wanted.label != nullptr) {
        cloud.label[first + i] = static_cast<std::uint32_t>(load(*wanted.label));
      }
    }
  }
}

std::uint32_t ReadSize(CloudFile& file) {
  char bytes[4];
  file.ReadBytes(bytes, sizeof bytes);
  std::uint32_t size;
  std::memcpy(&size, bytes, sizeof size);
  return size;
}

/// Two sizes, then LZF of all values of the first field, all of the second and so on. PCL leaves
/// padding out; other writers keep it, which the size tells.
void ReadCompressed(CloudFile& file, const PcdHeader& header, OrganizedCloud& cloud) {
  const std::uint64_t begin = file.position();
  const std::uint64_t packed_size = ReadSize(file), size = ReadSize(file);
  if (packed_size > file.size() - file.position()) {
    file.FailByte(
        begin, "the compressed data has " + std::to_string(packed_size) + " bytes, the file only " +
                   std::to_string(file.size() - file.position()) + " more: it is cut off");
  }
  std::uint64_t whole = 0, bare = 0;
  for (const PcdField& field : header.fields) {
    whole += cloud.size() * field.bytes();
    bare += field.name == "_" ? 0 : cloud.size() * field.bytes();
  }
  if (size != whole && size != bare) {
    file.FailByte(begin, "the compressed data unpacks to " + std::to_string(size) +
                             " bytes, POINTS " + std::to_string(header.points) + " of " +
                             std::to_string(whole / cloud.size()) + " bytes each need " +
                             std::to_string(whole));
  }
  std::string packed(packed_size, '\0');
  file.ReadBytes(packed.data(), packed.size());
  const std::string planes = LzfUnpacked(packed, size, file.path());
  const Wanted wanted(header);
  wanted.Resize(cloud);
  std::size_t at = 0;
  for (const PcdField& field : header.fields) {
    if (field.name == "_" && size == bare) continue;
    for (std::size_t i = 0; i < cloud.size(); ++i, at += field.bytes()) {
      const char* bytes = planes.data() + at;
      for (int k = 0; k < 3; ++k) {
        if (&field == wanted.p[k]) cloud.p_SP[i][k] = static_cast<float>(LoadNumber(bytes, field));
      }
      if (&field == wanted.intensity) {
        cloud.intensity[i] = static_cast<float>(LoadNumber(bytes, field));
      }
      if (&field == wanted.label) {
        cloud.label[i] = static_cast<std::uint32_t>(LoadNumber(bytes, field));
      }
    }
  }
}

/// Reads the words of the ascii data one by one and looks only into those that are wanted.
class AsciiReader {
 public:
  AsciiReader(CloudFile& file, const PcdHeader& header)
      : file_(file), header_(header), begin_(file.position()), text_(file.ReadRest()) {}

  void Read(OrganizedCloud& cloud) {
    const Wanted wanted(header_);
    wanted.Resize(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (const PcdField& field : header_.fields) {
        for (int k = 0; k < field.count; ++k) Take(field, NextWord(i, field), wanted, i, cloud);
      }
      RequireLineEnd(i);
    }
    RequireEnd();
  }

 private:
  void Take(const PcdField& field, std::string_view word, const Wanted& wanted, std::size_t i,
            OrganizedCloud& cloud) {
    for (int k = 0; k < 3; ++k) {
      if (&field != wanted.p[k]) continue;
      const auto value = ParseNumber(word);
      if (!value) {
        const bool comma = word.find(',') != std::string_view::npos;
        Fail(i, field,
             "is " + Quoted(word) + ", no number" +
                 (comma ? ": numbers are written with a point and set apart by blanks" : ""));
      }
      cloud.p_SP[i][k] = static_cast<float>(*value);
    }
    // These two are not needed: one word that is none of theirs drops the column.
    if (&field == wanted.intensity && !cloud.intensity.empty()) {
      if (const auto value = ParseNumber(word)) {
        cloud.intensity[i] = static_cast<float>(*value);
      } else {
        cloud.intensity.clear();
      }
    }
    if (&field == wanted.label && !cloud.label.empty()) {
      const auto value = ParseNumber(word);
      if (value && *value >= 0.0 && *value <= 4294967295.0 && *value == std::floor(*value)) {
        cloud.label[i] = static_cast<std::uint32_t>(*value);
      } else {
        cloud.label.clear();
      }
    }
  }

  static bool IsBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
  }
  /// To the next word; a word that begins with '#' begins a comment.
  void SkipBlanks() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '#') at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      if (at_ == text_.size() || !IsBlank(text_[at_])) return;
    }
  }
  std::string_view WordHere() const {
    std::size_t end = at_;
    while (end < text_.size() && !IsBlank(text_[end])) ++end;
    return std::string_view(text_).substr(at_, end - at_);
  }
  std::string_view NextWord(std::size_t point, const PcdField& field) {
    SkipBlanks();
    if (at_ == text_.size()) {
      Fail(point, field, "is missing: the data ends at byte " + std::to_string(file_.size()));
    }
    const std::string_view word = WordHere();
    at_ += word.size();
    return word;
  }
  /// A line that goes on has another number of columns than the header says, and every later point
  /// would be wrong.
  void RequireLineEnd(std::size_t point) {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    if (at_ == text_.size() || IsBlank(text_[at_]) || text_[at_] == '#') return;
    throw Error(ErrorKind::kBadData, Place() + ": point " + std::to_string(point) +
                                         ": the line goes on with " + Quoted(WordHere()) +
                                         ", FIELDS and COUNT say " +
                                         std::to_string(header_.columns) + " columns");
  }
  /// What follows must not be more points: something else (an editor's end mark) is nobody's.
  void RequireEnd() {
    SkipBlanks();
    if (at_ < text_.size() && ParseNumber(WordHere())) {
      file_.FailByte(begin_ + at_,
                     "data goes on after the last of POINTS " + std::to_string(header_.points));
    }
  }
  std::string Place() const {
    const auto line = file_.line() + 1 + std::count(text_.begin(), text_.begin() + at_, '\n');
    return file_.path() + ":" + std::to_string(line);
  }
  [[noreturn]] void Fail(std::size_t point, const PcdField& field,
                         const std::string& problem) const {
    throw Error(ErrorKind::kBadData, Place() + ": point " + std::to_string(point) + ", field " +
                                         Quoted(field.name) + " " + problem);
  }

  CloudFile& file_;
  const PcdHeader& header_;
  std::uint64_t begin_;
  std::string text_;
  std::size_t at_ = 0;
};

/// Bytes behind the data are nobody's (PCL fills up pages), unless they are as many as make every
/// record larger: then the header lacks a field.
void RequireRecords(const CloudFile& file, const PcdHeader& header) {
  const std::uint64_t left = file.size() - file.position();
  const auto points = static_cast<std::uint64_t>(header.points);
  const bool fits = points <= left / header.record_size;
  const std::uint64_t more = fits ? left - points * header.record_size : 0;
  if (fits && (more < points || more % points != 0 || points == 1)) return;
  file.FailByte(file.position(),
                "POINTS " + std::to_string(points) + " of " + std::to_string(header.record_size) +
                    " bytes each need " + (fits ? "less" : "more") + " than the " +
                    std::to_string(left) + " bytes of data that follow (" +
                    (fits ? std::to_string(left / points) + " bytes for each point)"
                          : std::to_string(left / header.record_size) + " whole points)"));
}

/// Compares what the header claims with what the file holds, before anything is allocated.
void RequireData(const CloudFile& file, const PcdHeader& header) {
  if (header.data == PcdData::kBinary) return RequireRecords(file, header);
  const std::uint64_t left = file.size() - file.position();
  const auto points = static_cast<std::uint64_t>(header.points);
  if (header.data == PcdData::kCompressed) {
    if (points > left * kLzfLargestRatio / header.record_size) {
      file.FailByte(file.position(), "POINTS " + std::to_string(points) + " of " +
                                         std::to_string(header.record_size) +
                                         " bytes each need more than the " + std::to_string(left) +
                                         " bytes of compressed data that follow");
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

OrganizedCloud ReadPcd(const std::string& path, std::optional<double> unit_m) {
  CloudFile file(path, "PCD cloud");
  const PcdHeader header = ReadPcdHeader(file);
  RequireData(file, header);
  OrganizedCloud cloud;
  cloud.width = static_cast<int>(header.width);
  cloud.height = static_cast<int>(header.height);
  cloud.X_NS = header.X_NS;
  cloud.p_SP.resize(static_cast<std::size_t>(header.points));
  if (header.data == PcdData::kBinary) {
    ReadBinary(file, header, cloud);
  } else if (header.data == PcdData::kCompressed) {
    ReadCompressed(file, header, cloud);
  } else {
    AsciiReader(file, header).Read(cloud);
  }
  const double scale = unit_m.value_or(header.unit_m.value_or(1.0));
  if (scale != 1.0) {
    for (Eigen::Vector3f& p : cloud.p_SP) p = (scale * p.cast<double>()).cast<float>();
    cloud.X_NS.translation() *= scale;
  }
  FinishPoints(file, cloud);
  return cloud;
}

}  // namespace tubetwin

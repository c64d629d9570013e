#include "models/base/cloud/cloud_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/foreign/content.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "cloud files are little-endian");

constexpr std::uint64_t kMaxHeaderBytes = 1024 * 1024;
constexpr double kMinMedianDistance_m = 0.001, kMaxMedianDistance_m = 20.0;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr const char* kPacked = ".zst";
/// Four times the largest scan of a PhoXi XL with every field.
constexpr std::uint64_t kMaxUnpackedBytes = 256 * 1024 * 1024;

}  // namespace

CloudFile::CloudFile(const std::string& path, const std::string& kind) : path_(path) {
  std::error_code code;
  if (!fs::is_regular_file(path, code)) ReadFile(path);  // Throws: it says what is there instead.
  if (CloudEnding(path).ends_with(kPacked)) {
    std::string content = DecompressedFile(ReadFile(path), kMaxUnpackedBytes, path);
    size_ = content.size();
    in_ = std::make_unique<std::istringstream>(std::move(content), std::ios::binary);
  } else {
    size_ = fs::file_size(path, code);
    in_ = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (code || !*in_) {
      throw Error(ErrorKind::kMissing, path + ": cannot be read: " + std::strerror(errno));
    }
  }
  if (size_ == 0) throw Error(ErrorKind::kBadData, path + ": is empty");
  std::string head(std::min<std::uint64_t>(size_, 64), '\0');
  in_->read(head.data(), static_cast<std::streamsize>(head.size()));
  const std::string other = MistakenContent(head);
  if (!other.empty() && other != "is a " + kind) {
    throw Error(ErrorKind::kBadData, path + ": no " + kind + ": it " + other);
  }
  if (head.starts_with(kByteOrderMark)) position_ = kByteOrderMark.size();
  in_->seekg(static_cast<std::streamoff>(position_));
}

std::string CloudFile::HeaderLine() {
  constexpr int kEnd = std::istream::traits_type::eof();
  ++line_;
  std::string line;
  while (true) {
    const int c = in_->get();
    if (c == kEnd) FailLine("the file ends inside its header");
    ++position_;
    if (c == '\n' || (c == '\r' && old_mac_)) return line;
    if (c == '\r') {
      const bool with_lf = in_->peek() == '\n';
      if (with_lf) {
        in_->get();
        ++position_;
      }
      if (with_lf || line_ == 1) {
        old_mac_ = !with_lf;
        return line;
      }
    }
    if (c == '\0' || position_ > kMaxHeaderBytes) {
      FailLine("byte " + std::to_string(position_ - 1) +
               " is no header text (a header has at most 1048576 bytes, none of them zero)");
    }
    line.push_back(static_cast<char>(c));
  }
}

void CloudFile::ReadBytes(char* out, std::size_t count) {
  in_->read(out, static_cast<std::streamsize>(count));
  const auto got = static_cast<std::uint64_t>(in_->gcount());
  if (got != count) {
    FailByte(position_ + got, "the data ends, " + std::to_string(count - got) + " bytes missing");
  }
  position_ += count;
}

void CloudFile::SkipBytes(std::uint64_t count) {
  TT_CHECK(count <= size_ - position_);
  in_->seekg(static_cast<std::streamoff>(count), std::ios::cur);
  position_ += count;
}

std::string CloudFile::ReadRest() {
  std::string rest(size_ - position_, '\0');
  ReadBytes(rest.data(), rest.size());
  return rest;
}

void CloudFile::FailLine(const std::string& problem) const {
  throw Error(ErrorKind::kBadData, path_ + ":" + std::to_string(line_) + ": " + problem);
}

void CloudFile::FailByte(std::uint64_t byte, const std::string& problem) const {
  throw Error(ErrorKind::kBadData, path_ + ": byte " + std::to_string(byte) + ": " + problem);
}

std::string Quoted(std::string_view word) { return "'" + Printable(word.substr(0, 40)) + "'"; }

std::vector<std::string_view> SplitWords(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (true) {
    i = text.find_first_not_of(" \t", i);
    if (i == std::string_view::npos) return words;
    const std::size_t end = std::min(text.find_first_of(" \t", i), text.size());
    words.push_back(text.substr(i, end - i));
    i = end;
  }
}

std::int64_t HeaderInteger(const CloudFile& file, const std::string& field, std::string_view word,
                           std::int64_t low, std::int64_t high) {
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size() || value < low || value > high) {
    file.FailLine(field + " is " + Quoted(word) + ", allowed are whole numbers from " +
                  std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

double HeaderNumber(const CloudFile& file, const std::string& field, std::string_view word) {
  const auto value = ParseNumber(word);
  if (!value || !std::isfinite(*value)) {
    file.FailLine(field + " holds " + Quoted(word) + ", a finite number is needed");
  }
  return *value;
}

void FinishPoints(const CloudFile& file, OrganizedCloud& cloud) {
  // A sample of about 2,000 points decides the median; its stride depends on the size alone.
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / 2000);
  std::vector<float> sample;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3f& p = cloud.p_SP[i];
    // One sum is finite only when all three are.
    if (!std::isfinite(p.x() + p.y() + p.z()) || p.isZero(0.0f)) {
      p = InvalidPoint();
    } else if (i % stride == 0) {
      sample.push_back(p.norm());
    }
  }
  const std::string remedy =
      "\n(--units mm, cm or in says another unit; so does a header line 'comment units mm' in PLY, "
      "'# units mm' in PCD)";
  if (sample.empty()) return;
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  if (*middle >= kMinMedianDistance_m && *middle <= kMaxMedianDistance_m) return;
  throw Error(ErrorKind::kBadData,
              file.path() + ": x y z: the median distance from the scanner is " +
                  Number(*middle > 1 ? std::round(*middle) : *middle) + ", allowed are " +
                  Number(kMinMedianDistance_m) + " to " + Number(kMaxMedianDistance_m) +
                  " m: the file is not in metres, or no scan of a bin" + remedy);
}

std::string CloudEnding(const std::string& path) {
  const fs::path name(path);
  std::string ending = name.extension().string();
  if (LowerCase(ending) == kPacked) ending = name.stem().extension().string() + ending;
  return LowerCase(ending);
}

void WriteRecords(const std::string& path, const std::string& header, std::size_t count,
                  std::size_t record_size, const std::string& trailer,
                  void (*fill)(const OrganizedCloud&, std::size_t, char*),
                  const OrganizedCloud& cloud) {
  WriteFileInPieces(path, [&](OutputFile& out) {
    out.Write(header);
    constexpr std::size_t kBlock = 16384;
    std::vector<char> block(std::min(kBlock, count) * record_size);
    for (std::size_t first = 0; first < count; first += kBlock) {
      const std::size_t n = std::min(kBlock, count - first);
      for (std::size_t i = 0; i < n; ++i) fill(cloud, first + i, block.data() + i * record_size);
      out.Write({block.data(), n * record_size});
    }
    out.Write(trailer);
  });
}

}  // namespace tubetwin

#include "models/base/cloud/cloud_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
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
#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "cloud files are little-endian");

constexpr std::uint64_t kMaxHeaderBytes = 64 * 1024;
constexpr double kMaxMedianDistance_m = 20.0;
constexpr const char* kPacked = ".zst";
/// Four times the largest scan of a PhoXi XL with every field.
constexpr std::uint64_t kMaxUnpackedBytes = 256 * 1024 * 1024;

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

CloudFile::CloudFile(const std::string& path) : path_(path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) throw Error(ErrorKind::kMissing, path + ": no such file");
  if (fs::is_directory(status)) {
    throw Error(ErrorKind::kMissing, path + ": is a folder, a file is needed");
  }
  if (!fs::is_regular_file(status)) {
    throw Error(ErrorKind::kBadData, path + ": is no regular file, so its size cannot be checked");
  }
  if (CloudEnding(path).ends_with(kPacked)) {
    std::string content = DecompressedFile(ReadFile(path), kMaxUnpackedBytes, path);
    size_ = content.size();
    in_ = std::make_unique<std::istringstream>(std::move(content), std::ios::binary);
    return;
  }
  size_ = fs::file_size(path, code);
  in_ = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (code || !*in_) {
    throw Error(ErrorKind::kMissing, path + ": cannot be read: " + std::strerror(errno));
  }
}

std::string CloudFile::HeaderLine() {
  ++line_;
  std::string line;
  while (true) {
    const int c = in_->get();
    if (c == std::ifstream::traits_type::eof()) FailLine("the file ends inside its header");
    ++position_;
    if (c == '\n') break;
    const bool text = c == '\t' || c == '\r' || c >= 0x20;
    if (!text || position_ > kMaxHeaderBytes) {
      FailLine("byte " + std::to_string(position_ - 1) +
               " is no header text (a header has at most 65536 bytes)");
    }
    line.push_back(static_cast<char>(c));
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

void CloudFile::ReadBytes(char* out, std::size_t count) {
  in_->read(out, static_cast<std::streamsize>(count));
  const auto got = static_cast<std::uint64_t>(in_->gcount());
  if (got != count) {
    FailByte(position_ + got, "the data ends, " + std::to_string(count - got) + " bytes missing");
  }
  position_ += count;
}

void CloudFile::FailLine(const std::string& problem) const {
  throw Error(ErrorKind::kBadData, path_ + ":" + std::to_string(line_) + ": " + problem);
}

void CloudFile::FailByte(std::uint64_t byte, const std::string& problem) const {
  throw Error(ErrorKind::kBadData, path_ + ": byte " + std::to_string(byte) + ": " + problem);
}

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
    file.FailLine(field + " is '" + std::string(word.substr(0, 40)) +
                  "', allowed are whole numbers from " + std::to_string(low) + " to " +
                  std::to_string(high));
  }
  return value;
}

double HeaderNumber(const CloudFile& file, const std::string& field, std::string_view word) {
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    file.FailLine(field + " holds '" + std::string(word.substr(0, 40)) +
                  "', a finite number is needed");
  }
  return value;
}

void FinishPoints(const CloudFile& file, OrganizedCloud& cloud) {
  // A sample of about 2,000 points decides the median; its stride depends on the size alone.
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / 2000);
  const bool organized = cloud.organized();
  std::vector<float> sample;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3f& p = cloud.p_SP[i];
    // One sum is finite only when all three are.
    if (!std::isfinite(p.x() + p.y() + p.z()) || (organized && p.isZero(0.0f))) {
      p = InvalidPoint();
    } else if (i % stride == 0) {
      sample.push_back(p.norm());
    }
  }
  if (sample.empty()) return;
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  if (*middle > kMaxMedianDistance_m) {
    throw Error(ErrorKind::kBadData,
                file.path() + ": x y z: the median distance from the scanner is " +
                    Number(std::round(*middle)) + ", allowed are up to " +
                    Number(kMaxMedianDistance_m) +
                    " m: the file is not in metres\n(a PLY in millimetres says so by the header "
                    "line 'comment units mm')");
  }
}

std::string CloudEnding(const std::string& path) {
  const fs::path name(path);
  std::string ending = name.extension().string();
  if (Lower(ending) == kPacked) ending = name.stem().extension().string() + ending;
  return Lower(ending);
}

void WriteRecords(const std::string& path, const std::string& header, std::size_t count,
                  std::size_t record_size, const std::string& trailer,
                  void (*fill)(const OrganizedCloud&, std::size_t, char*),
                  const OrganizedCloud& cloud) {
  WriteThroughTemporary(path, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    if (!out) {
      throw Error(ErrorKind::kCannotCreate, path + ": cannot be created: " + std::strerror(errno));
    }
    out << header;
    constexpr std::size_t kBlock = 16384;
    std::vector<char> block(std::min(kBlock, count) * record_size);
    for (std::size_t first = 0; first < count && out; first += kBlock) {
      const std::size_t n = std::min(kBlock, count - first);
      for (std::size_t i = 0; i < n; ++i) fill(cloud, first + i, block.data() + i * record_size);
      out.write(block.data(), static_cast<std::streamsize>(n * record_size));
    }
    out << trailer;
    out.close();
    if (!out) throw Error(ErrorKind::kIo, path + ": writing failed: " + std::strerror(errno));
  });
}

}  // namespace tubetwin

#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// What the PCD and PLY codecs share: a file read in pieces, never more than it holds; one that
/// ends in ".zst" is unpacked first, and sizes and places are those of its content. Internal to
/// models/base. One thread.
class CloudFile {
 public:
  /// Throws Error(kMissing) when there is no such file, Error(kBadData) when it is no regular file,
  /// or a damaged or too large .zst.
  explicit CloudFile(const std::string& path);

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Bytes of the file that were read so far.
  std::uint64_t position() const { return position_; }
  int line() const { return line_; }  ///< Number of the last header line, from 1.

  /// Next line of the header without its end. Throws Error(kBadData) when the file ends, or when
  /// the header has more than 64 KiB or the line bytes that no text has.
  std::string HeaderLine();
  /// Reads exactly `count` bytes; the caller has compared count with size().
  void ReadBytes(char* out, std::size_t count);

  /// Throws Error(kBadData) "PATH:LINE: problem".
  [[noreturn]] void FailLine(const std::string& problem) const;
  /// Throws Error(kBadData) "PATH: byte N: problem".
  [[noreturn]] void FailByte(std::uint64_t byte, const std::string& problem) const;

 private:
  std::string path_;
  std::unique_ptr<std::istream> in_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  int line_ = 0;
};

/// Words of a text between blanks and tabs.
std::vector<std::string_view> SplitWords(std::string_view text);

/// Whole number of a header. Throws through `file` naming `field`, the text and the range.
std::int64_t HeaderInteger(const CloudFile& file, const std::string& field, std::string_view word,
                           std::int64_t low, std::int64_t high);
/// Finite number of a header.
double HeaderNumber(const CloudFile& file, const std::string& field, std::string_view word);

/// Clears points that cannot be measured (not finite; at the camera's own centre in an organised
/// cloud, as vendors mark them) and refuses a cloud whose median distance from its origin is over
/// 20 m: lengths in millimetres are never guessed. Throws Error(kBadData).
void FinishPoints(const CloudFile& file, OrganizedCloud& cloud);

/// A name's ending in small letters, with the one below it when it is packed: ".pcd", ".ply.zst".
std::string CloudEnding(const std::string& path);

/// Writes `header`, then `count` records of `record_size` bytes that `fill(index, out)` makes.
void WriteRecords(const std::string& path, const std::string& header, std::size_t count,
                  std::size_t record_size, const std::string& trailer,
                  void (*fill)(const OrganizedCloud&, std::size_t, char*),
                  const OrganizedCloud& cloud);

}  // namespace tubetwin

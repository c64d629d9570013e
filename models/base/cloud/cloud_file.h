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
  /// Throws Error(kMissing) when there is no such regular file, Error(kBadData) when it is empty,
  /// or a damaged or too large .zst. `kind` is what it should be, "PCD cloud" or "PLY file": a file
  /// that is something else by its first bytes is refused by that name.
  CloudFile(const std::string& path, const std::string& kind);

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Bytes of the file that were read so far.
  std::uint64_t position() const { return position_; }
  int line() const { return line_; }  ///< Number of the last header line, from 1.

  /// Next line of the header without its end (LF, CR LF, or CR where the first line ends so); a
  /// byte order mark before the first is skipped. Throws Error(kBadData) when the file ends, or
  /// when the header has more than a mebibyte or a zero byte.
  std::string HeaderLine();
  /// Reads exactly `count` bytes; the caller has compared count with size().
  void ReadBytes(char* out, std::size_t count);
  /// Passes over `count` bytes, of which there are so many.
  void SkipBytes(std::uint64_t count);
  /// All that was not read yet.
  std::string ReadRest();

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
  bool old_mac_ = false;  ///< The first line ends in CR alone, so all do.
};

/// A word of a file as a message may show it: quoted, printable, at most 40 bytes of it.
std::string Quoted(std::string_view word);

/// Words of a text between blanks and tabs.
std::vector<std::string_view> SplitWords(std::string_view text);

/// Whole number of a header. Throws through `file` naming `field`, the text and the range.
std::int64_t HeaderInteger(const CloudFile& file, const std::string& field, std::string_view word,
                           std::int64_t low, std::int64_t high);
/// Finite number of a header.
double HeaderNumber(const CloudFile& file, const std::string& field, std::string_view word);

/// Clears points that cannot be measured (not finite, or at the camera's own centre, as vendors
/// mark them) and refuses a cloud that is not in metres: its median distance from its origin is
/// over 20 m, or below 1 mm. Millimetres are never guessed. Throws Error(kBadData).
void FinishPoints(const CloudFile& file, OrganizedCloud& cloud);

/// A name's ending in small letters, with the one below it when it is packed: ".pcd", ".ply.zst".
std::string CloudEnding(const std::string& path);

/// Writes `header`, then `count` records of `record_size` bytes that `fill(index, out)` makes.
void WriteRecords(const std::string& path, const std::string& header, std::size_t count,
                  std::size_t record_size, const std::string& trailer,
                  void (*fill)(const OrganizedCloud&, std::size_t, char*),
                  const OrganizedCloud& cloud);

}  // namespace tubetwin

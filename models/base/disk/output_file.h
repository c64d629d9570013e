#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "models/base/error.h"

namespace tubetwin {

/// What a failed attempt to create a file or folder is: Error(kIo) where the disk is full or broken
/// (ENOSPC, EDQUOT, EIO), else Error(kCannotCreate). `error` is an errno.
ErrorKind KindOfFailedCreation(int error);

/// A file that is written from front to back, without a buffer of its own: what Write() returned
/// from is the system's, what Sync() returned from is on the disk. One thread.
class OutputFile {
 public:
  /// A new file in place of a file or symbolic link of that name; what the link points to is left
  /// alone, and nobody else's file is ever opened. Its folder must exist. Throws
  /// Error(kCannotCreate | kIo).
  static OutputFile Create(const std::string& path);
  /// A new, empty file in `folder` whose name nobody can foresee, ending in `ending`: libraries
  /// choose a format by it. Its messages name `shown`, the file that it will become.
  static OutputFile Temporary(const std::string& folder, const std::string& ending,
                              const std::string& shown);
  /// An existing regular file, to be written behind its end. Throws Error(kCannotCreate | kIo).
  static OutputFile Continue(const std::string& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }  ///< Bytes written, the old ones included.

  /// Throws Error(kIo) naming the byte and the system's reason; what was written before stays.
  void Write(std::string_view bytes);
  /// Waits until everything is on the disk. Throws Error(kIo).
  void Sync();
  /// Adds `bytes` whole and on the disk, or throws Error(kIo) and leaves the file as it was.
  void Append(std::string_view bytes);
  /// Drops what was written behind `size` bytes, as far as the system lets it.
  void CutTo(std::uint64_t size);
  /// Throws Error(kIo) when its path no longer names this file: somebody removed or renamed it, or
  /// a folder above it.
  void RequireInPlace() const;
  /// Gives the file up; nothing may be written afterwards. Errors that a file server tells only now
  /// are thrown as Error(kIo).
  void Close();

 private:
  OutputFile(int fd, std::string path, std::string shown);
  [[noreturn]] void Fail(int error) const;

  int fd_ = -1;
  std::string path_, shown_;
  std::uint64_t size_ = 0;
};

}  // namespace tubetwin

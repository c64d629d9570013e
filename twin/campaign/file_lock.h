#pragma once

#include <memory>
#include <string>

namespace tubetwin {

/// An exclusive lock on a file (flock): the system lets go of it when its owner ends, however it
/// ends, so that a dead owner never blocks. A forked child shares the lock until it closes `fd()`.
class FileLock {
 public:
  /// The lock, or null when another process still has it after `patience_s`. Creates the file.
  /// Throws Error(kCannotCreate | kIo).
  static std::unique_ptr<FileLock> TryTake(const std::string& path, double patience_s);
  /// Waits for it.
  static std::unique_ptr<FileLock> Take(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  int fd() const { return fd_; }
  /// Writes into the lock file who has it, for the messages of those who do not.
  void Sign(const std::string& owner);

 private:
  explicit FileLock(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace tubetwin

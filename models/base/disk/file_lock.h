#pragma once

#include <memory>
#include <string>
#include <utility>

namespace tubetwin {

/// "process 12 on host", for people.
std::string ThisProcess();

/// An exclusive lock on a file (flock): the system lets go of it when its owner ends, however it
/// ends, so that a dead owner never blocks. A forked child shares the lock until it closes `fd()`.
class FileLock {
 public:
  /// The lock, or null when another process still has it after `patience_s`. Creates the file.
  /// Throws Error(kCannotCreate | kIo); a link, or a file that holds anything but a lock's
  /// signature, is left alone.
  static std::unique_ptr<FileLock> TryTake(const std::string& path, double patience_s);
  /// Waits for it.
  static std::unique_ptr<FileLock> Take(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  int fd() const { return fd_; }
  /// Writes ThisProcess() into the lock file, for the messages of those who do not get it.
  void Sign();
  /// The file goes with the lock: who waits for it makes it anew.
  void RemoveAtEnd() { removes_ = true; }

 private:
  FileLock(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  int fd_;
  std::string path_;
  bool removes_ = false;
};

}  // namespace tubetwin

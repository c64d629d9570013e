#include "models/base/disk/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "models/base/error.h"
#include "models/base/files.h"

namespace tubetwin {
namespace {

constexpr char kSignature[] = "process ";

/// A lock is an empty file or one that a lock's owner signed. Anything else of that name is
/// somebody's: a link leads to a file that signing would overwrite.
int OpenLock(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (fd < 0 && errno == ELOOP) {
    throw Error(ErrorKind::kCannotCreate,
                path + ": is a symbolic link, a lock is needed here; remove it");
  }
  if (fd < 0) {
    throw Error(KindOfFailedCreation(errno), path + ": cannot be created: " + std::strerror(errno));
  }
  struct stat there = {};
  char begin[sizeof kSignature - 1] = {};
  // A power cut may leave zeros of a signature.
  const bool known = ::fstat(fd, &there) == 0 && S_ISREG(there.st_mode) && there.st_nlink == 1 &&
                     (there.st_size == 0 ||
                      (::pread(fd, begin, sizeof begin, 0) == sizeof begin &&
                       (std::memcmp(begin, kSignature, sizeof begin) == 0 || begin[0] == '\0')));
  if (known || there.st_nlink == 0) return fd;
  ::close(fd);
  throw Error(ErrorKind::kCannotCreate,
              path + ": is no lock of this program; move it away, or give another folder");
}

/// 0 or the error of flock.
int Lock(int fd, int operation) {
  int result = 0;
  do {
    result = ::flock(fd, operation);
  } while (result != 0 && errno == EINTR);
  return result == 0 ? 0 : errno;
}

[[noreturn]] void Fail(int fd, const std::string& path, int error) {
  ::close(fd);
  throw Error(ErrorKind::kIo, path + ": cannot be locked: " + std::strerror(error));
}

/// Whether the lock's path still names the file that is locked: an owner may have removed it.
bool IsCurrent(int fd, const std::string& path) {
  struct stat mine = {}, there = {};
  return ::fstat(fd, &mine) == 0 && ::stat(path.c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

}  // namespace

std::string ThisProcess() {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  return kSignature + std::to_string(::getpid()) + " on " + host;
}

std::unique_ptr<FileLock> FileLock::TryTake(const std::string& path, double patience_s) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration<double>(patience_s);
  for (;;) {
    const int fd = OpenLock(path);
    const int error = Lock(fd, LOCK_EX | LOCK_NB);
    if (error == 0 && IsCurrent(fd, path)) return std::unique_ptr<FileLock>(new FileLock(fd, path));
    if (error != 0 && error != EWOULDBLOCK) Fail(fd, path, error);
    ::close(fd);
    if (error == 0) continue;  // Its owner removed it between the two.
    if (Clock::now() >= until) return nullptr;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

std::unique_ptr<FileLock> FileLock::Take(const std::string& path) {
  for (;;) {
    const int fd = OpenLock(path);
    const int error = Lock(fd, LOCK_EX);
    if (error != 0) Fail(fd, path, error);
    if (IsCurrent(fd, path)) return std::unique_ptr<FileLock>(new FileLock(fd, path));
    ::close(fd);
  }
}

FileLock::~FileLock() {
  if (removes_) ::unlink(path_.c_str());
  ::close(fd_);
}

void FileLock::Sign() {
  const std::string owner = ThisProcess();
  // Only a hint for people: a full disk may leave it empty, the lock holds all the same.
  if (::ftruncate(fd_, 0) == 0) {
    [[maybe_unused]] const auto written = ::pwrite(fd_, owner.data(), owner.size(), 0);
  }
}

}  // namespace tubetwin

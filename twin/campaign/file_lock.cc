#include "twin/campaign/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "models/base/error.h"

namespace tubetwin {
namespace {

int Open(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd < 0) {
    throw Error(ErrorKind::kCannotCreate, path + ": cannot be created: " + std::strerror(errno));
  }
  return fd;
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

}  // namespace

std::unique_ptr<FileLock> FileLock::TryTake(const std::string& path, double patience_s) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration<double>(patience_s);
  const int fd = Open(path);
  int error = Lock(fd, LOCK_EX | LOCK_NB);
  while (error == EWOULDBLOCK && Clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    error = Lock(fd, LOCK_EX | LOCK_NB);
  }
  if (error == EWOULDBLOCK) {
    ::close(fd);
    return nullptr;
  }
  if (error != 0) Fail(fd, path, error);
  return std::unique_ptr<FileLock>(new FileLock(fd));
}

std::unique_ptr<FileLock> FileLock::Take(const std::string& path) {
  const int fd = Open(path);
  const int error = Lock(fd, LOCK_EX);
  if (error != 0) Fail(fd, path, error);
  return std::unique_ptr<FileLock>(new FileLock(fd));
}

FileLock::~FileLock() { ::close(fd_); }

void FileLock::Sign(const std::string& owner) {
  // Only a hint for people: a full disk may leave it empty, the lock holds all the same.
  if (::ftruncate(fd_, 0) == 0) {
    [[maybe_unused]] const auto written = ::pwrite(fd_, owner.data(), owner.size(), 0);
  }
}

}  // namespace tubetwin

#include "models/base/disk/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kMode = 0666;  // Less the umask.
constexpr int kNames = 100;     // Of temporary files tried before giving up.

[[noreturn]] void FailToCreate(const std::string& shown, int error) {
  throw Error(KindOfFailedCreation(error), shown + ": cannot be created: " + std::strerror(error));
}

/// Creates what was not there; -1 and errno otherwise.
int CreateExclusively(const std::string& path) {
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode);
}

/// ".tubetwin-" and twelve letters. No stream of models/base/random.h: nobody may foresee it.
std::string UnforeseenName() {
  constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz012345";
  std::random_device source;
  std::string name = ".tubetwin-";
  for (int i = 0; i < 12; ++i) name += kLetters[source() % 32];
  return name;
}

}  // namespace

ErrorKind KindOfFailedCreation(int error) {
  return error == ENOSPC || error == EDQUOT || error == EIO ? ErrorKind::kIo
                                                            : ErrorKind::kCannotCreate;
}

OutputFile::OutputFile(int fd, std::string path, std::string shown)
    : fd_(fd), path_(std::move(path)), shown_(std::move(shown)) {}

OutputFile OutputFile::Create(const std::string& path) {
  struct stat there = {};
  if (::lstat(path.c_str(), &there) == 0) {
    if (S_ISDIR(there.st_mode)) {
      throw Error(ErrorKind::kCannotCreate, path + ": is a folder, a file name is needed");
    }
    if (!S_ISREG(there.st_mode) && !S_ISLNK(there.st_mode)) {
      throw Error(ErrorKind::kCannotCreate,
                  path + ": is a device, pipe or socket; the name of a file is needed");
    }
    if (::unlink(path.c_str()) != 0) FailToCreate(path, errno);
  }
  const int fd = CreateExclusively(path);
  if (fd < 0) FailToCreate(path, errno);
  return OutputFile(fd, path, path);
}

OutputFile OutputFile::Temporary(const std::string& folder, const std::string& ending,
                                 const std::string& shown) {
  for (int i = 0; i < kNames; ++i) {
    const std::string path = (fs::path(folder) / (UnforeseenName() + ending)).string();
    const int fd = CreateExclusively(path);
    if (fd >= 0) return OutputFile(fd, path, shown);
    if (errno != EEXIST) FailToCreate(shown, errno);
  }
  FailToCreate(shown, EEXIST);
}

OutputFile OutputFile::Continue(const std::string& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    throw Error(KindOfFailedCreation(errno),
                path + ": cannot be opened for writing: " +
                    (errno == ELOOP ? "is a symbolic link" : std::strerror(errno)));
  }
  OutputFile file(fd, path, path);
  struct stat there = {};
  if (::fstat(fd, &there) != 0) file.Fail(errno);
  if (!S_ISREG(there.st_mode)) {
    throw Error(ErrorKind::kCannotCreate, path + ": is no regular file");
  }
  file.size_ = static_cast<std::uint64_t>(there.st_size);
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept { *this = std::move(other); }

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(path_, other.path_);
  std::swap(shown_, other.shown_);
  std::swap(size_, other.size_);
  return *this;
}

OutputFile::~OutputFile() {
  if (fd_ >= 0) ::close(fd_);
}

void OutputFile::Fail(int error) const {
  throw Error(ErrorKind::kIo, shown_ + ": cannot be written at byte " + std::to_string(size_) +
                                  ": " + std::strerror(error));
}

void OutputFile::Write(std::string_view bytes) {
  TT_CHECK(fd_ >= 0);
  while (!bytes.empty()) {
    const ssize_t step = ::write(fd_, bytes.data(), bytes.size());
    if (step < 0 && errno == EINTR) continue;
    if (step < 0) Fail(errno);
    if (step == 0) Fail(ENOSPC);  // What a full disk says that has no word for it.
    size_ += static_cast<std::uint64_t>(step);
    bytes.remove_prefix(static_cast<std::size_t>(step));
  }
}

void OutputFile::Sync() {
  TT_CHECK(fd_ >= 0);
  while (::fsync(fd_) != 0) {
    if (errno != EINTR) Fail(errno);
  }
}

void OutputFile::Append(std::string_view bytes) {
  const std::uint64_t before = size_;
  try {
    Write(bytes);
    Sync();
  } catch (const Error&) {
    CutTo(before);
    throw;
  }
}

void OutputFile::CutTo(std::uint64_t size) {
  // It fails on a broken disk only: readers drop half a piece, too.
  if (::ftruncate(fd_, static_cast<off_t>(size)) != 0) return;
  ::lseek(fd_, static_cast<off_t>(size), SEEK_SET);
  size_ = size;
}

void OutputFile::RequireInPlace() const {
  struct stat mine = {}, there = {};
  if (::fstat(fd_, &mine) != 0) Fail(errno);
  const bool found = ::stat(path_.c_str(), &there) == 0;
  if (found && there.st_dev == mine.st_dev && there.st_ino == mine.st_ino) return;
  throw Error(ErrorKind::kIo,
              shown_ + ": is not there any more: somebody removed or renamed it, or its folder");
}

void OutputFile::Close() {
  const int fd = std::exchange(fd_, -1);
  if (fd >= 0 && ::close(fd) != 0 && errno != EINTR) Fail(errno);
}

}  // namespace tubetwin

#include "models/base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr const char kNoRegularFile[] =
    ": is a device, pipe or socket; the name of a file is needed";

std::string NameTooLong(const std::string& path) {
  constexpr std::size_t kShown = 60;
  return path.substr(0, kShown) +
         "...: the name is too long; allowed: 255 bytes a name, 4095 with "
         "its folders";
}

[[noreturn]] void FailReading(const std::string& file, int error) {
  if (file.empty()) throw Error(ErrorKind::kMissing, "the name of a file is empty");
  const std::string path = Printable(file);
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      throw Error(ErrorKind::kMissing, path + ": no such file");
    case EACCES:
    case EPERM:
      throw Error(ErrorKind::kMissing, path + ": no permission to read it");
    case ENAMETOOLONG:
      throw Error(ErrorKind::kMissing, NameTooLong(path));
    case ELOOP:
      throw Error(ErrorKind::kMissing, path + ": symbolic links that lead in a circle");
    case ENXIO:  // A socket.
      throw Error(ErrorKind::kMissing, path + kNoRegularFile);
    default:
      throw Error(ErrorKind::kIo, path + ": cannot be read: " + std::strerror(error));
  }
}

/// A regular file, open for reading.
class ReadHandle {
 public:
  explicit ReadHandle(const std::string& path)
      : path_(path), fd_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    struct stat status {};
    if (fd_ < 0 || ::fstat(fd_, &status) != 0) FailReading(path, errno);
    if (S_ISREG(status.st_mode)) {
      size_ = static_cast<std::uint64_t>(status.st_size);
      return;
    }
    ::close(fd_);
    throw Error(ErrorKind::kMissing,
                Printable(path) +
                    (S_ISDIR(status.st_mode) ? ": is a folder, a file is needed" : kNoRegularFile));
  }
  ~ReadHandle() { ::close(fd_); }
  ReadHandle(const ReadHandle&) = delete;
  ReadHandle& operator=(const ReadHandle&) = delete;

  std::uint64_t size() const { return size_; }

  /// 0: the end.
  std::size_t Read(char* to, std::size_t most) const {
    for (;;) {
      const ssize_t size = ::read(fd_, to, most);
      if (size >= 0) return static_cast<std::size_t>(size);
      if (errno != EINTR) FailReading(path_, errno);
    }
  }

 private:
  const std::string& path_;
  int fd_;
  std::uint64_t size_ = 0;
};

std::string TooLarge(const std::string& path, std::uint64_t max_bytes) {
  return Printable(path) + ": holds more than " + std::to_string(max_bytes) +
         " bytes; allowed: up to that for a file of this kind";
}

struct Descriptor {
  explicit Descriptor(int number) : fd(number) {}
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  const int fd;
};

std::string FolderOf(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// Waits until the folder's names are on the disk.
void SyncFolder(const std::string& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // A folder that may be written but not listed cannot be waited for.
  if (opened.fd < 0 && errno == EACCES) return;
  // Some network file systems cannot sync a folder, and say EINVAL: they do it by themselves.
  if (opened.fd < 0 || (::fsync(opened.fd) != 0 && errno != EINVAL)) {
    throw Error(ErrorKind::kIo, folder + ": cannot be written: " + std::strerror(errno));
  }
}

/// The ending of a file's name, by which libraries choose a format.
std::string EndingOf(const std::string& path) {
  constexpr std::size_t kLongest = 16;  // Nobody chooses by more, and names may be full already.
  const std::string ending = fs::path(path).extension().string();
  return ending.size() <= kLongest ? ending : "";
}

enum class Kept { kOnDisk, kUntilPowerCut };

void Replace(const std::string& path, Kept kept,
             const std::function<void(OutputFile& out)>& write) {
  const std::string folder = FolderOf(path);
  MakeFolder(folder);
  struct stat there = {};
  const bool old = ::stat(path.c_str(), &there) == 0;
  if (old) {
    // The rename would put a file in the device's place, for everybody.
    if (S_ISDIR(there.st_mode)) {
      throw Error(ErrorKind::kCannotCreate, path + ": is a folder, a file name is needed");
    }
    if (!S_ISREG(there.st_mode)) throw Error(ErrorKind::kCannotCreate, path + kNoRegularFile);
  } else if (errno == ENAMETOOLONG) {
    throw Error(ErrorKind::kCannotCreate, NameTooLong(path));
  }
  OutputFile out = OutputFile::Temporary(folder, EndingOf(path), path);
  struct Cleanup {
    const std::string file;
    bool renamed = false;
    ~Cleanup() {
      if (!renamed) ::unlink(file.c_str());
    }
  } cleanup{out.path()};
  write(out);
  // Who may read the old file may read the new one, and nobody else.
  if (old && ::chmod(cleanup.file.c_str(), there.st_mode & 07777) != 0) {
    throw Error(KindOfFailedCreation(errno), path + ": cannot be written: " + std::strerror(errno));
  }
  if (kept == Kept::kOnDisk) out.Sync();
  out.Close();
  if (::rename(cleanup.file.c_str(), path.c_str()) != 0) {
    throw Error(KindOfFailedCreation(errno), path + ": cannot be written: " + std::strerror(errno));
  }
  cleanup.renamed = true;
  if (kept == Kept::kOnDisk) SyncFolder(folder);
}

}  // namespace

std::string ReadFile(const std::string& path, std::uint64_t max_bytes) {
  const ReadHandle file(path);
  if (file.size() > max_bytes) throw Error(ErrorKind::kBadData, TooLarge(path, max_bytes));
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  // One byte more: the end is seen.
  std::string content(static_cast<std::size_t>(file.size()) + 1, '\0');
  std::size_t size = 0;
  while (const std::size_t step = file.Read(content.data() + size, content.size() - size)) {
    size += step;
    if (size > max_bytes) throw Error(ErrorKind::kBadData, TooLarge(path, max_bytes));
    if (size == content.size()) content.resize(size + kPiece);  // It grows, or told no size.
  }
  content.resize(size);
  return content;
}

void ForEachLine(const std::string& path, std::uint64_t max_line_bytes,
                 const std::function<void(const std::string&, bool)>& use) {
  const ReadHandle file(path);
  std::array<char, 1 << 16> piece;
  std::string line;
  int number = 1;
  while (const std::size_t size = file.Read(piece.data(), piece.size())) {
    for (std::string_view rest(piece.data(), size); !rest.empty();) {
      const std::size_t end = rest.find('\n');
      line += rest.substr(0, end);
      if (line.size() > max_line_bytes) {
        throw Error(ErrorKind::kBadData,
                    TooLarge(path + ":" + std::to_string(number), max_line_bytes));
      }
      if (end == std::string_view::npos) break;
      use(line, true);
      line.clear();
      ++number;
      rest.remove_prefix(end + 1);
    }
  }
  if (!line.empty()) use(line, false);
}

void WriteFileAtomically(const std::string& path, std::string_view content) {
  Replace(path, Kept::kOnDisk, [&](OutputFile& out) { out.Write(content); });
}

void WriteFileInPieces(const std::string& path, const std::function<void(OutputFile& out)>& write) {
  Replace(path, Kept::kOnDisk, write);
}

void WriteThroughTemporary(const std::string& path,
                           const std::function<void(const std::string&)>& write) {
  Replace(path, Kept::kOnDisk, [&](OutputFile& out) { write(out.path()); });
}

void WriteMessageFile(const std::string& path, std::string_view content) {
  Replace(path, Kept::kUntilPowerCut, [&](OutputFile& out) { out.Write(content); });
}

void RenameDurably(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) {
    throw Error(ErrorKind::kIo, to + ": cannot be made of " + from + ": " + std::strerror(errno));
  }
  SyncFolder(FolderOf(to));
  if (FolderOf(from) != FolderOf(to)) SyncFolder(FolderOf(from));
}

void MakeFolder(const std::string& path) {
  std::error_code code;
  std::vector<fs::path> missing;  // From below.
  for (fs::path at(path); !at.empty() && !fs::exists(at, code); at = at.parent_path()) {
    missing.push_back(at);
  }
  fs::create_directories(path, code);
  if (std::error_code ignored; !fs::is_directory(path, ignored)) {
    const int error = code ? code.value() : ENOTDIR;
    if (error == ENAMETOOLONG) throw Error(ErrorKind::kCannotCreate, NameTooLong(path));
    throw Error(KindOfFailedCreation(error),
                path + ": cannot be made a folder: " +
                    (error == ENOTDIR ? "a file is there" : std::strerror(error)));
  }
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    throw Error(
        KindOfFailedCreation(errno),
        path + (errno == EACCES ? std::string(": no permission to write here")
                                : ": cannot be written: " + std::string(std::strerror(errno))));
  }
  for (const fs::path& made : missing) SyncFolder(FolderOf(made.string()));
}

std::string Fingerprint(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325ull;  // FNV-1a
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(h));
  return hex;
}

}  // namespace tubetwin

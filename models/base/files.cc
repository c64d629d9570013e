#include "models/base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "models/base/error.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void FailToRead(const std::string& path, int error) {
  if (error == ENOENT || error == ENOTDIR) {
    throw Error(ErrorKind::kMissing, path + ": no such file");
  }
  throw Error(error == EIO ? ErrorKind::kIo : ErrorKind::kMissing,
              path + ": cannot be read: " + std::strerror(error));
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
  if (::stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode)) {
    // The rename would put a file in the device's place, for everybody.
    throw Error(ErrorKind::kCannotCreate,
                path + (S_ISDIR(there.st_mode)
                            ? ": is a folder, a file name is needed"
                            : ": is a device, pipe or socket; the name of a file is needed"));
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
  if (kept == Kept::kOnDisk) out.Sync();
  out.Close();
  if (::rename(cleanup.file.c_str(), path.c_str()) != 0) {
    throw Error(KindOfFailedCreation(errno), path + ": cannot be written: " + std::strerror(errno));
  }
  cleanup.renamed = true;
  if (kept == Kept::kOnDisk) SyncFolder(folder);
}

}  // namespace

std::string ReadFile(const std::string& path) {
  const Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.fd < 0) FailToRead(path, errno);
  std::string content;
  char piece[65536];
  for (;;) {
    const ssize_t got = ::read(opened.fd, piece, sizeof piece);
    if (got == 0) return content;
    if (got < 0 && errno == EISDIR) {
      throw Error(ErrorKind::kMissing, path + ": is a folder, a file is needed");
    }
    if (got < 0 && errno != EINTR) FailToRead(path, errno);
    if (got > 0) content.append(piece, static_cast<std::size_t>(got));
  }
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

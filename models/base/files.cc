#include "models/base/files.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "models/base/error.h"

namespace tubetwin {
namespace fs = std::filesystem;

std::string ReadFile(const std::string& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) throw Error(ErrorKind::kMissing, path + ": no such file");
  if (fs::is_directory(status)) {
    throw Error(ErrorKind::kMissing, path + ": is a folder, a file is needed");
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) throw Error(ErrorKind::kIo, path + ": cannot be read: " + std::strerror(errno));
  return std::move(content).str();
}

void WriteThroughTemporary(const std::string& path,
                           const std::function<void(const std::string&)>& write) {
  const fs::path target(path);
  if (target.has_parent_path()) MakeFolder(target.parent_path().string());
  const fs::file_status there = fs::status(target);
  if (fs::is_directory(there)) {
    throw Error(ErrorKind::kCannotCreate, path + ": is a folder, a file name is needed");
  }
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    // The rename would put a file in the device's place, for everybody.
    throw Error(ErrorKind::kCannotCreate,
                path + ": is a device, pipe or socket; the name of a file is needed");
  }
  // Unique per process and call, the ending kept: libraries choose a format by it.
  static std::atomic<unsigned> counter{0};
  const fs::path temporary =
      target.parent_path() / ("." + target.stem().string() + "." + std::to_string(::getpid()) +
                              "." + std::to_string(counter++) + target.extension().string());
  struct Cleanup {
    const fs::path& file;
    ~Cleanup() {
      std::error_code ignored;  // After a successful rename there is nothing to remove.
      fs::remove(file, ignored);
    }
  } cleanup{temporary};
  write(temporary.string());
  std::error_code code;
  fs::rename(temporary, target, code);
  if (code) throw Error(ErrorKind::kIo, path + ": cannot be written: " + code.message());
}

void WriteFileAtomically(const std::string& path, std::string_view content) {
  WriteThroughTemporary(path, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    if (!out) {
      throw Error(ErrorKind::kCannotCreate, path + ": cannot be created: " + std::strerror(errno));
    }
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) throw Error(ErrorKind::kIo, path + ": writing failed: " + std::strerror(errno));
  });
}

void MakeFolder(const std::string& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (!fs::is_directory(path)) {
    throw Error(ErrorKind::kCannotCreate,
                path + ": cannot be made a folder: " + (code ? code.message() : "a file is there"));
  }
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    throw Error(ErrorKind::kCannotCreate, path + ": no permission to write here");
  }
}

std::string Fingerprint(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325ull;  // FNV-1a
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(h));
  return hex;
}

}  // namespace tubetwin

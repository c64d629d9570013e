#include "tests/fuzz/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kLongest_s = 20;

}  // namespace

void DieOf(const std::string& reader, const std::string& problem) {
  std::fprintf(stderr, "%s: %s\n", reader.c_str(), problem.c_str());
  std::abort();
}

MemoryFile::MemoryFile(const std::string& name) : handle_(::memfd_create(name.c_str(), 0)) {
  if (handle_ < 0) DieOf(name, "no file in memory");
  path_ = "/proc/self/fd/" + std::to_string(handle_);
  if (!fs::path(name).has_extension()) return;
  folder_ = (fs::temp_directory_path() / "tubetwin-fuzz-XXXXXX").string();
  if (::mkdtemp(folder_.data()) == nullptr) DieOf(name, "no temporary folder");
  fs::create_symlink(path_, folder_ + "/" + name);
  path_ = folder_ + "/" + name;
}

MemoryFile::~MemoryFile() {
  ::close(handle_);
  std::error_code ignored;  // Leaving a link behind harms nobody.
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void MemoryFile::Fill(std::string_view bytes) {
  if (::ftruncate(handle_, 0) != 0 ||
      ::pwrite(handle_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    DieOf(path_, "cannot be written");
  }
}

void TryReader(const std::string& reader, const std::string& source,
               const std::function<void()>& read, const std::vector<ErrorKind>& allowed) {
  ::alarm(kLongest_s);
  try {
    read();
  } catch (const Error& error) {
    const std::string what = error.what();
    if (std::find(allowed.begin(), allowed.end(), error.kind()) == allowed.end()) {
      DieOf(reader, "another kind of error: " + what);
    }
    if (what.find(source) == std::string::npos) DieOf(reader, "the file is not named: " + what);
    if (std::count(what.begin(), what.end(), '\n') > 3) DieOf(reader, "over four lines: " + what);
    std::string lines = what;
    std::replace(lines.begin(), lines.end(), '\n', ' ');
    if (!IsPlainUtf8(lines)) DieOf(reader, "no printable text: " + Printable(what));
  } catch (const std::exception& error) {
    DieOf(reader, std::string("not an Error: ") + error.what());
  }
  ::alarm(0);
}

}  // namespace tubetwin

#include "models/base/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

ErrorKind KindOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    CHECK_FALSE(std::string(e.what()).empty());
    return e.kind();
  }
  return ErrorKind::kInternal;
}

int CountFiles(const std::string& folder) {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) ++count;
  return count;
}

}  // namespace

TEST_CASE("a file is written with its folders and read back byte by byte") {
  const TemporaryFolder folder;
  const std::string content("a\0b\r\n\xff", 6);
  WriteFileAtomically(folder / "x/y/f.bin", content);
  CHECK(ReadFile(folder / "x/y/f.bin") == content);
  CHECK(CountFiles(folder / "x/y") == 1);
}

TEST_CASE("a writer that fails leaves the old file and nothing else") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "f.txt", "old");
  CHECK_THROWS_WITH(WriteThroughTemporary(folder / "f.txt",
                                          [](const std::string& temporary) {
                                            std::ofstream(temporary) << "half";
                                            throw std::runtime_error("disk full");
                                          }),
                    "disk full");
  CHECK(ReadFile(folder / "f.txt") == "old");
  CHECK(CountFiles(folder.path()) == 1);
}

TEST_CASE("a temporary file keeps the ending by which libraries choose a format") {
  const TemporaryFolder folder;
  WriteThroughTemporary(folder / "film.mp4", [](const std::string& temporary) {
    CHECK(fs::path(temporary).extension() == ".mp4");
    std::ofstream(temporary) << "x";
  });
  CHECK(ReadFile(folder / "film.mp4") == "x");
}

TEST_CASE("reading what is not there or is a folder is missing input") {
  const TemporaryFolder folder;
  CHECK(KindOf([&] { ReadFile(folder / "none"); }) == ErrorKind::kMissing);
  CHECK(KindOf([&] { ReadFile(folder.path()); }) == ErrorKind::kMissing);
}

TEST_CASE("writing below a file or onto a folder cannot be created") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "file", "x");
  CHECK(KindOf([&] { WriteFileAtomically(folder / "file/below", "y"); }) ==
        ErrorKind::kCannotCreate);
  CHECK(KindOf([&] { MakeFolder(folder / "file"); }) == ErrorKind::kCannotCreate);
  fs::create_directory(folder / "dir");
  CHECK(KindOf([&] { WriteFileAtomically(folder / "dir", "y"); }) == ErrorKind::kCannotCreate);
}

TEST_CASE(
    "what the standard library says of the machine has its own exit code and the file's name") {
  const auto kind_of = [](int code) {
    const fs::filesystem_error thrown("cannot", "p/f.json",
                                      std::error_code(code, std::generic_category()));
    const auto error = MachineError(thrown);
    REQUIRE(error.has_value());
    CHECK_THAT(error->what(), Catch::Matchers::StartsWith("p/f.json: "));
    return error->kind();
  };
  CHECK(kind_of(EIO) == ErrorKind::kIo);
  CHECK(kind_of(ENOSPC) == ErrorKind::kIo);
  CHECK(kind_of(EACCES) == ErrorKind::kCannotCreate);
  CHECK(kind_of(ENOENT) == ErrorKind::kMissing);
  CHECK(MachineError(std::bad_alloc())->kind() == ErrorKind::kInterrupted);
  CHECK_FALSE(MachineError(std::logic_error("a bug")).has_value());
}

TEST_CASE("what is no file is not replaced by one") {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe", link = folder / "link";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink(pipe, link);
  for (const std::string& target : {pipe, link}) {
    CHECK_THROWS_WITH(WriteFileAtomically(target, "x"),
                      Catch::Matchers::Contains("is a device, pipe or socket"));
    CHECK_THROWS_WITH(WriteFileAtomically(target, "x"), Catch::Matchers::Contains(target));
  }
  CHECK(fs::is_fifo(pipe));
  CHECK(fs::is_symlink(link));
  CHECK(CountFiles(folder / ".") == 2);
}

TEST_CASE("what is written anew keeps who may read it") {
  const TemporaryFolder folder;
  const std::string file = folder / "a";
  WriteFileAtomically(file, "old");
  for (const fs::perms mode : {fs::perms(0600), fs::perms(0640)}) {
    fs::permissions(file, mode);
    WriteFileAtomically(file, "new");
    CHECK(fs::status(file).permissions() == mode);
  }
}

TEST_CASE("an empty name and a name of several lines are told as such") {
  CHECK_THROWS_WITH(ReadFile(""), "the name of a file is empty");
  CHECK_THROWS_WITH(ReadFile("a\nb"), "a\\x0Ab: no such file");
}

TEST_CASE("writing into a folder without permission cannot be created") {
  // Permissions do not bind root; the kernel's own file systems do.
  const TemporaryFolder folder;
  std::string closed = folder / "closed";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
  if (::geteuid() == 0) closed = "/proc/tubetwin";
  CHECK(KindOf([&] { WriteFileAtomically(closed + "/f", "x"); }) == ErrorKind::kCannotCreate);
}

TEST_CASE("a full disk is a failure of writing that names the target, which stays as it was") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "f", "old");
  std::string said;
  ErrorKind kind = ErrorKind::kInternal;
  {
    const FullDisk full(1000);
    try {
      WriteFileAtomically(folder / "f", std::string(5000, 'x'));
    } catch (const Error& e) {
      said = e.what();
      kind = e.kind();
    }
  }
  CHECK(kind == ErrorKind::kIo);
  CHECK(said == folder / "f" + ": cannot be written at byte 1000: File too large");
  CHECK(ReadFile(folder / "f") == "old");
  CHECK(CountFiles(folder.path()) == 1);
}

TEST_CASE("a file that cannot be read to its end is no shorter file") {
  // The address 0 of a process is nobody's: the kernel says EIO.
  CHECK(KindOf([&] { ReadFile("/proc/self/mem"); }) == ErrorKind::kIo);
}

TEST_CASE("a link is replaced and what it points to stays") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "precious", "mine");
  fs::create_symlink("precious", folder / "f");
  WriteFileAtomically(folder / "f", "new");
  CHECK(ReadFile(folder / "precious") == "mine");
  CHECK_FALSE(fs::is_symlink(folder / "f"));
  CHECK(ReadFile(folder / "f") == "new");
}

TEST_CASE("temporary names are new each time, are nobody's before, and fit beside long names") {
  const TemporaryFolder folder;
  std::set<std::string> names;
  const auto note = [&](const std::string& temporary) {
    names.insert(temporary);
    CHECK(fs::file_size(temporary) == 0);
  };
  for (int i = 0; i < 50; ++i) WriteThroughTemporary(folder / "f.txt", note);
  CHECK(names.size() == 50);
  const std::string longest = folder / (std::string(255 - 4, 'n') + ".txt");
  WriteFileAtomically(longest, "x");
  CHECK(ReadFile(longest) == "x");
  CHECK(KindOf([&] { WriteFileAtomically(longest + "n", "x"); }) == ErrorKind::kCannotCreate);
}

TEST_CASE("a fingerprint is the published FNV-1a of the text") {
  CHECK(Fingerprint("") == "cbf29ce484222325");
  CHECK(Fingerprint("a") == "af63dc4c8601ec8c");
  CHECK(Fingerprint("foobar") == "85944171f73967e8");
}

TEST_CASE("what is no regular file is missing input, at once") {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    CHECK_THROWS_WITH(ReadFile(path), path +
                                          ": is a device, pipe or socket; the name of a file is "
                                          "needed");
    CHECK(KindOf([&] { ReadFile(path); }) == ErrorKind::kMissing);
  }
}

TEST_CASE("a name that no file can have is told as such, reading and writing") {
  const TemporaryFolder folder;
  const std::string name = folder / std::string(256, 'n');
  CHECK_THROWS_WITH(ReadFile(name),
                    Catch::Matchers::Contains("the name is too long; allowed: 255"));
  CHECK(KindOf([&] { ReadFile(name); }) == ErrorKind::kMissing);
  CHECK_THROWS_WITH(WriteFileAtomically(name, "x"),
                    Catch::Matchers::Contains("the name is too long; allowed: 255"));
  CHECK(KindOf([&] { WriteFileAtomically(name, "x"); }) == ErrorKind::kCannotCreate);
  CHECK(KindOf([&] { MakeFolder(name); }) == ErrorKind::kCannotCreate);
}

TEST_CASE("a file above what is allowed is refused before it takes memory") {
  const TemporaryFolder folder;
  const std::string path = folder / "sparse";
  std::ofstream(path) << "x";
  fs::resize_file(path, std::uintmax_t{1} << 40);
  CHECK_THROWS_WITH(ReadFile(path),
                    path +
                        ": holds more than 1073741824 bytes; allowed: up to that for a file of "
                        "this kind");
  CHECK(KindOf([&] { ReadFile(path); }) == ErrorKind::kBadData);
  fs::resize_file(path, 3);
  CHECK(ReadFile(path, 3).size() == 3);
  CHECK_THROWS_WITH(ReadFile(path, 2), Catch::Matchers::Contains("holds more than 2 bytes"));
}

TEST_CASE("lines come one by one, and the last says whether its break is there") {
  const TemporaryFolder folder;
  const std::string path = folder / "lines", longest(100000, 'a');
  std::vector<std::pair<std::string, bool>> lines;
  const auto read = [&](const std::string& content, std::uint64_t most) {
    lines.clear();
    WriteFileAtomically(path, content);
    ForEachLine(path, most,
                [&](const std::string& line, bool whole) { lines.emplace_back(line, whole); });
  };
  read("a\n\n" + longest + "\nb", longest.size());
  CHECK(lines == std::vector<std::pair<std::string, bool>>{
                     {"a", true}, {"", true}, {longest, true}, {"b", false}});
  read("", 1);
  CHECK(lines.empty());
  CHECK_THROWS_WITH(read("a\n" + longest + "\n", longest.size() - 1),
                    Catch::Matchers::Contains(path + ":2: holds more than 99999 bytes"));
}

}  // namespace tubetwin

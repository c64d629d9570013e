#include "models/base/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "models/base/error.h"
#include "tests/support/catch.h"
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

TEST_CASE("writing into a folder without permission cannot be created") {
  // Permissions do not bind root; the kernel's own file systems do.
  const TemporaryFolder folder;
  std::string closed = folder / "closed";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
  if (::geteuid() == 0) closed = "/proc/tubetwin";
  CHECK(KindOf([&] { WriteFileAtomically(closed + "/f", "x"); }) == ErrorKind::kCannotCreate);
}

TEST_CASE("a full disk is a failure of writing, and the target stays absent") {
  const TemporaryFolder folder;
  CHECK(KindOf([&] {
          WriteThroughTemporary(folder / "f", [](const std::string& temporary) {
            fs::create_symlink("/dev/full", temporary);
            std::ofstream out(temporary);
            out << "x";
            out.close();
            if (!out) throw Error(ErrorKind::kIo, "f: writing failed");
          });
        }) == ErrorKind::kIo);
  CHECK_FALSE(fs::exists(folder / "f"));
}

TEST_CASE("a fingerprint is the published FNV-1a of the text") {
  CHECK(Fingerprint("") == "cbf29ce484222325");
  CHECK(Fingerprint("a") == "af63dc4c8601ec8c");
  CHECK(Fingerprint("foobar") == "85944171f73967e8");
}

}  // namespace tubetwin

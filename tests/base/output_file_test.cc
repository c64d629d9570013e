// Files that grow piece by piece, and locks: what is somebody else's is never opened.

#include "models/base/disk/output_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "models/base/disk/file_lock.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/full_disk.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("a new file takes the place of a link or a second name, and leaves theirs alone") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "precious", "mine");
  fs::create_symlink("precious", folder / "link");
  fs::create_hard_link(folder / "precious", folder / "name");
  for (const char* name : {"link", "name"}) {
    OutputFile file = OutputFile::Create(folder / name);
    file.Write("new");
    file.Close();
    CHECK(ReadFile(folder / name) == "new");
    CHECK(ReadFile(folder / "precious") == "mine");
  }
}

TEST_CASE("no folder, device or missing folder becomes a file") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "dir");
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  for (const std::string& path : {folder / "dir", folder / "pipe", folder / "none/f"}) {
    const Error refused = Refused([&] { OutputFile::Create(path); });
    CHECK(refused.kind() == ErrorKind::kCannotCreate);
    CHECK_THAT(refused.what(), Contains(path));
  }
  CHECK(fs::is_fifo(folder / "pipe"));
}

TEST_CASE("only a regular file is continued, behind its end") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "f", "one ");
  OutputFile file = OutputFile::Continue(folder / "f");
  CHECK(file.size() == 4);
  file.Append("two");
  CHECK(ReadFile(folder / "f") == "one two");
  fs::create_symlink("f", folder / "link");
  CHECK_THAT(Refused([&] { OutputFile::Continue(folder / "link"); }).what(),
             Contains("is a symbolic link"));
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK(Refused([&] { OutputFile::Continue(folder / "pipe"); }).kind() == ErrorKind::kCannotCreate);
}

TEST_CASE("what is appended is there whole or not at all, and room lets it go on") {
  const TemporaryFolder folder;
  OutputFile file = OutputFile::Create(folder / "f");
  file.Append("first\n");
  {
    const FullDisk full(10);
    const Error refused = Refused([&] { file.Append("second\n"); });
    CHECK(refused.kind() == ErrorKind::kIo);
    CHECK(refused.what() == folder / "f" + ": cannot be written at byte 10: File too large");
  }
  CHECK(ReadFile(folder / "f") == "first\n");
  file.Append("third\n");
  CHECK(ReadFile(folder / "f") == "first\nthird\n");
}

TEST_CASE("a file whose name or folder was taken away is told from one that is in place") {
  const TemporaryFolder folder;
  const std::function<void()> kinds[] = {
      [&] { fs::remove(folder / "d/f"); },
      [&] { fs::remove_all(folder / "d"); },
      [&] { fs::rename(folder / "d", folder / "e"); },
      [&] { WriteFileAtomically(folder / "d/f", "another's"); },
  };
  for (const auto& take_away : kinds) {
    fs::create_directory(folder / "d");
    OutputFile file = OutputFile::Create(folder / "d/f");
    file.RequireInPlace();
    take_away();
    const Error refused = Refused([&] { file.RequireInPlace(); });
    CHECK(refused.kind() == ErrorKind::kIo);
    CHECK_THAT(refused.what(), Contains("removed or renamed"));
    fs::remove_all(folder / "d");
  }
}

TEST_CASE("a lock is nobody else's file, link or pipe") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "precious", "PRECIOUS");
  fs::create_symlink("precious", folder / "link.lock");
  fs::create_symlink("nothing", folder / "dangling.lock");
  fs::create_hard_link(folder / "precious", folder / "name.lock");
  fs::copy_file(folder / "precious", folder / "copy.lock");
  WriteFileAtomically(folder / "short.lock", "proc");
  REQUIRE(::mkfifo((folder / "pipe.lock").c_str(), 0600) == 0);
  for (const char* name :
       {"link.lock", "dangling.lock", "name.lock", "copy.lock", "short.lock", "pipe.lock"}) {
    INFO(name);
    const Error refused = Refused([&] { FileLock::TryTake(folder / name, 0.0); });
    CHECK(refused.kind() == ErrorKind::kCannotCreate);
    CHECK_THAT(refused.what(), Contains(folder / name));
  }
  CHECK(ReadFile(folder / "precious") == "PRECIOUS");
  CHECK(ReadFile(folder / "copy.lock") == "PRECIOUS");
  CHECK_FALSE(fs::exists(folder / "nothing"));
}

TEST_CASE("a lock is had by one, says whose it is, and is free again after its owner") {
  const TemporaryFolder folder;
  {
    const auto lock = FileLock::TryTake(folder / "l", 0.0);
    REQUIRE(lock != nullptr);
    lock->Sign();
    CHECK(FileLock::TryTake(folder / "l", 0.0) == nullptr);
    CHECK(ReadFile(folder / "l") == ThisProcess());
  }
  CHECK(FileLock::TryTake(folder / "l", 0.0) != nullptr);
}

}  // namespace tubetwin

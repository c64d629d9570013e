#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/error.h"

namespace tubetwin {

/// Ends the process as a fuzzer wants it, saying what was tried and what was wrong.
[[noreturn]] void DieOf(const std::string& reader, const std::string& problem);

/// A regular file in memory, known by a path; where readers go by the ending of a name, by one in a
/// folder of its own.
class MemoryFile {
 public:
  /// `name`: of the file; one with an ending lies in a temporary folder until the end.
  explicit MemoryFile(const std::string& name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void Fill(std::string_view bytes);
  const std::string& path() const { return path_; }

 private:
  int handle_;
  std::string folder_, path_;
};

/// Calls a reader. It may throw an Error of an `allowed` kind, in at most four lines of printable
/// text that name `source`; anything else, and more than 20 s, ends the process. Error(kMissing) is
/// for what the file names.
void TryReader(const std::string& reader, const std::string& source,
               const std::function<void()>& read,
               const std::vector<ErrorKind>& allowed = {ErrorKind::kBadData, ErrorKind::kMissing});

}  // namespace tubetwin

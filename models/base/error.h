#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace tubetwin {

/// What went wrong, as the program's caller sees it: each kind is one exit code.
enum class ErrorKind {
  kUsage = 64,         ///< The command line asks for something that does not exist.
  kBadData = 65,       ///< An input was read but its content is wrong.
  kMissing = 66,       ///< An input (file, part name) does not exist.
  kDevice = 69,        ///< A device, or EGL when images are asked for, cannot be reached.
  kInternal = 70,      ///< A bug or a failure of an engine underneath.
  kCannotCreate = 73,  ///< The output exists and belongs to something else, or cannot be created.
  kIo = 74,            ///< Writing failed half way (disk full).
  kInterrupted = 75,   ///< Stopped on request; run again to resume.
  kConfig = 78,        ///< A configuration value is wrong, or a real arm is not armed.
};

/// Bad input, a broken device or an engine failure: everything that is neither a bug nor an
/// expected outcome. The message names who, what, the value, and what is allowed, in at most four
/// lines, without a trailing newline.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// A bug: an assumption of the program about itself does not hold.
class LogicError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// What the standard library says of the machine it runs on (files, memory, processes) as the Error
/// that it is; nothing for any other exception.
std::optional<Error> MachineError(const std::exception& thrown);

/// Throws LogicError naming expression and place. Called by TT_CHECK only.
[[noreturn]] void ThrowCheckFailed(const char* expression, const char* file, int line);

}  // namespace tubetwin

/// Always-on check of the program's own assumptions.
#define TT_CHECK(condition)                                         \
  do {                                                              \
    if (!(condition)) {                                             \
      ::tubetwin::ThrowCheckFailed(#condition, __FILE__, __LINE__); \
    }                                                               \
  } while (false)

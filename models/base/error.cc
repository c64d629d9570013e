#include "models/base/error.h"

#include <cerrno>
#include <filesystem>
#include <new>
#include <system_error>

namespace tubetwin {
namespace {

ErrorKind KindOfSystemError(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
    case EROFS:
    case ENAMETOOLONG:
    case ELOOP:
      return ErrorKind::kCannotCreate;
    case ENOENT:
      return ErrorKind::kMissing;
    case ENOMEM:
    case EAGAIN:
    case EMFILE:
    case ENFILE:
      return ErrorKind::kInterrupted;  // Later there may be room.
    default:
      return ErrorKind::kIo;
  }
}

}  // namespace

std::optional<Error> MachineError(const std::exception& thrown) {
  if (dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr) {
    return Error(ErrorKind::kInterrupted,
                 "out of memory; give it more, or less to do at a time (--threads, --jobs)");
  }
  const auto* system = dynamic_cast<const std::system_error*>(&thrown);
  if (system == nullptr) return std::nullopt;
  const std::string reason = system->code().message();
  const ErrorKind kind = KindOfSystemError(system->code().value());
  const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(system);
  if (file == nullptr || file->path1().empty()) return Error(kind, reason);
  return Error(kind, file->path1().string() + ": " + reason);
}

void ThrowCheckFailed(const char* expression, const char* file, int line) {
  throw LogicError(std::string(file) + ":" + std::to_string(line) +
                   ": this does not hold: " + expression);
}

}  // namespace tubetwin

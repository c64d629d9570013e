#include "hw_bridge/emulators/robotiq/serial_pty.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "models/base/error.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

std::string Reason() { return std::strerror(errno); }

}  // namespace

SerialPty::SerialPty(const std::string& who, const std::string& link) {
  const auto fail = [&](const std::string& what) {
    if (theirs_ >= 0) ::close(theirs_);
    if (ours_ >= 0) ::close(ours_);
    throw Error(ErrorKind::kDevice, who + ": " + what);
  };
  ours_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 256> name{};
  if (ours_ < 0 || ::grantpt(ours_) != 0 || ::unlockpt(ours_) != 0 ||
      ::ptsname_r(ours_, name.data(), name.size()) != 0) {
    fail("no pseudo-terminal: " + Reason());
  }
  device_ = name.data();
  theirs_ = ::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  termios settings{};
  if (theirs_ < 0 || ::tcgetattr(theirs_, &settings) != 0) {
    fail("no pseudo-terminal: " + Reason());
  }
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, B115200);
  if (::tcsetattr(theirs_, TCSANOW, &settings) != 0) fail("no pseudo-terminal: " + Reason());
  if (link.empty()) return;
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(link, error))) fs::remove(link, error);
  fs::create_symlink(device_, link, error);
  if (error) fail("cannot make the device '" + link + "': " + error.message());
  link_ = link;
}

SerialPty::~SerialPty() {
  std::error_code ignored;
  if (!link_.empty() && fs::read_symlink(link_, ignored) == device_) fs::remove(link_, ignored);
  ::close(theirs_);
  ::close(ours_);
}

std::string SerialPty::Read() {
  std::array<char, 4096> bytes;
  const ssize_t size = ::read(ours_, bytes.data(), bytes.size());
  return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : std::string();
}

void SerialPty::Write(std::string_view bytes) {
  // As much as the line takes; the client finds the rest missing.
  while (!bytes.empty()) {
    const ssize_t size = ::write(ours_, bytes.data(), bytes.size());
    if (size <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
}

}  // namespace tubetwin

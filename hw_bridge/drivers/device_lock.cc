#include "hw_bridge/drivers/device_lock.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr std::size_t kLongestCommand = 100;

/// An address without a file: the kernel frees it with its process, and nobody can put a link in
/// its way. Devices' own addresses may be longer than it allows, so it is made of their hash
/// (FNV-1a, 64 bits).
struct Address {
  explicit Address(const std::string& device) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char letter : device) {
      hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
    }
    where.sun_family = AF_UNIX;
    char* const name = where.sun_path + 1;  // The first byte is 0: no file.
    const int length = std::snprintf(name, sizeof where.sun_path - 1, "tubetwin/device/%016llx",
                                     static_cast<unsigned long long>(hash));
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 +
                                  static_cast<std::size_t>(length));
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&where); }
  sockaddr_un where{};
  socklen_t size = 0;
};

int Socket() {
  const int made = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (made < 0) {
    throw Error(ErrorKind::kInternal,
                std::string("device lock: no local socket: ") + std::strerror(errno));
  }
  return made;
}

/// What process `pid` was started as, in plain letters.
std::string CommandOf(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  while (!text.empty() && text.back() == '\0') text.pop_back();
  const std::size_t program = text.find_last_of('/', text.find('\0'));
  if (program != std::string::npos) text.erase(0, program + 1);
  for (char& letter : text) {
    if (letter < ' ' || letter > '~') letter = ' ';
  }
  return text.size() > kLongestCommand ? text.substr(0, kLongestCommand) + "..." : text;
}

}  // namespace

std::string DeviceLock::HolderOf(const std::string& device) {
  const Address address(device);
  const int asking = Socket();
  std::string holder;
  const bool connected = ::connect(asking, address.get(), address.size) == 0;
  if (connected || errno == EAGAIN) {
    holder = "another program";
    ucred peer{};
    socklen_t size = sizeof peer;
    if (connected && ::getsockopt(asking, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
        peer.pid > 0) {
      holder = "process " + std::to_string(peer.pid) + " (" + CommandOf(peer.pid) + ")";
    }
  }
  ::close(asking);
  return holder;
}

DeviceLock::DeviceLock(const std::string& device) : socket_(Socket()) {
  const Address address(device);
  if (::bind(socket_, address.get(), address.size) == 0 && ::listen(socket_, SOMAXCONN) == 0)
    return;
  const int why = errno;
  ::close(socket_);
  if (why != EADDRINUSE) {
    throw Error(ErrorKind::kInternal, "device lock: " + std::string(std::strerror(why)));
  }
  const std::string holder = HolderOf(device);
  throw Error(ErrorKind::kInterrupted, device + ": is in use by " +
                                           (holder.empty() ? "another program" : holder) +
                                           "; one program at a time may use it");
}

DeviceLock::~DeviceLock() {
  if (socket_ >= 0) ::close(socket_);
}

DeviceLock::DeviceLock(DeviceLock&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

}  // namespace tubetwin

#include "hw_bridge/emulators/photoneo/gvsp_sender.h"

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <thread>

#include "models/base/error.h"

namespace tubetwin {
namespace {

using asio::ip::udp;
using SteadyClock = std::chrono::steady_clock;

// Fits into the buffer that every UDP socket has at first (208 KiB with the kernel's own overhead),
// twice over.
constexpr std::size_t kBurst = 64000;
constexpr auto kMaxSilence = std::chrono::seconds(2);
constexpr double kEthernetBytesPerS = 100e6;

/// Bytes that wait to be read at a UDP port of this machine; nothing when nobody has it.
std::optional<unsigned long> Unread(const GvspClient& client) {
  std::ifstream sockets("/proc/net/udp");
  // Address as the machine stores it, so bytes reversed; a socket may be bound to all addresses.
  const std::uint32_t reversed = __builtin_bswap32(client.address);
  std::string line;
  while (std::getline(sockets, line)) {
    unsigned address = 0, port = 0;
    unsigned long unread = 0;
    const int read = std::sscanf(line.c_str(), "%*d: %8X:%4X %*8X:%*4X %*2X %*8X:%8lX", &address,
                                 &port, &unread);
    if (read == 3 && port == client.port && (address == reversed || address == 0)) return unread;
  }
  return std::nullopt;
}

}  // namespace

struct GvspSender::Impl {
  explicit Impl(const std::string& listen) : socket(io, udp::v4()) {
    asio::error_code error;
    socket.bind({asio::ip::make_address_v4(listen), 0}, error);
    if (error) {
      throw Error(ErrorKind::kDevice, "emulated scanner (GigE Vision): no port of " + listen +
                                          " for frames: " + error.message());
    }
  }

  /// Waits until the client can take a burst; false when there is no hope.
  bool AwaitRoom(const GvspClient& to, bool loopback, const std::atomic<bool>& stop) {
    if (!loopback) {
      const auto burst = std::chrono::duration<double>(kBurst / kEthernetBytesPerS);
      std::this_thread::sleep_for(burst);
      return !stop;
    }
    const auto began = SteadyClock::now();
    while (!stop && SteadyClock::now() - began < kMaxSilence) {
      const std::optional<unsigned long> unread = Unread(to);
      if (!unread) return false;
      if (*unread < kBurst) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

  asio::io_context io;
  udp::socket socket;
};

GvspSender::GvspSender(const std::string& listen) : impl_(std::make_unique<Impl>(listen)) {}
GvspSender::~GvspSender() = default;

void GvspSender::Send(const Frame& frame, const GvspClient& to, const std::atomic<bool>& stop) {
  constexpr std::size_t kMaxDatagram = 65000;
  if (frame.packet_size <= kGvspOverhead || frame.packet_size > kMaxDatagram) return;
  const asio::ip::address_v4 address(to.address);
  const udp::endpoint client(address, static_cast<std::uint16_t>(to.port));
  asio::error_code error;
  const auto put = [&](const auto& bytes) { impl_->socket.send_to(bytes, client, 0, error); };

  put(asio::buffer(EncodeGvspLeader(frame.image)));
  const std::size_t room = frame.packet_size - kGvspOverhead;
  const std::size_t packets = (frame.bytes.size() + room - 1) / room;
  const auto sent_packets = static_cast<std::size_t>(
      std::floor(std::clamp(frame.sent_share, 0.0, 1.0) * static_cast<double>(packets)));
  std::size_t burst = kBurst;  // The client makes room when it sees the leader.
  for (std::size_t i = 0; i < sent_packets && !error; ++i) {
    if (burst + frame.packet_size > kBurst) {
      if (!impl_->AwaitRoom(to, address.is_loopback(), stop)) return;
      burst = 0;
    }
    burst += frame.packet_size;
    const std::string header =
        EncodeGvspPayloadHeader(frame.image.frame_id, static_cast<std::uint32_t>(i + 1));
    const std::size_t at = i * room;
    put(std::array<asio::const_buffer, 2>{
        asio::buffer(header),
        asio::buffer(frame.bytes.data() + at, std::min(room, frame.bytes.size() - at))});
  }
  if (sent_packets < packets) return;
  put(asio::buffer(EncodeGvspTrailer(frame.image, static_cast<std::uint32_t>(packets + 1))));
}

}  // namespace tubetwin

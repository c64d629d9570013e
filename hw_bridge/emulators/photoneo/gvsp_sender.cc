#include "hw_bridge/emulators/photoneo/gvsp_sender.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
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
/// A client whose port keeps as much as that for so long reads elsewhere. aravis gives a frame up
/// that ceases for 100 ms; what a slow client loses meanwhile it asks for again.
constexpr auto kMaxSilence = std::chrono::milliseconds(40);
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
    // Packets are as large as was agreed on, or are not sent.
    const int whole = IP_PMTUDISC_DO;
    ::setsockopt(socket.native_handle(), IPPROTO_IP, IP_MTU_DISCOVER, &whole, sizeof whole);
  }

  /// Waits until the client can take a burst; false when there is no hope.
  bool AwaitRoom(const GvspClient& to, const std::atomic<bool>& stop) {
    const auto began = SteadyClock::now();
    while (!stop) {
      const std::optional<unsigned long> unread = to_loopback ? Unread(to) : 0;
      if (!unread) return false;
      if (to_loopback && *unread < kBurst) {
        by_time = false;
        return true;
      }
      by_time = by_time || !to_loopback || SteadyClock::now() - began > kMaxSilence;
      if (by_time) break;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    const auto burst = std::chrono::duration<double>(kBurst / kEthernetBytesPerS);
    std::this_thread::sleep_for(burst);
    return !stop;
  }

  static std::size_t Room(const Frame& frame) {
    return frame.packet_size - (frame.multipart ? kGvspPartsOverhead : kGvspImageOverhead);
  }
  static std::size_t PacketsOf(const Frame& frame, std::size_t part) {
    return (frame.bytes[part].size() + Room(frame) - 1) / Room(frame);
  }
  /// Of the payload; the leader comes before them, the trailer after them.
  static std::size_t Packets(const Frame& frame) {
    std::size_t packets = 0;
    for (std::size_t part = 0; part < frame.parts.size(); ++part) packets += PacketsOf(frame, part);
    return packets;
  }

  /// What a packet of the payload holds.
  struct Piece {
    std::size_t part = 0;
    std::size_t first = 0, size = 0;  ///< Bytes of the part.
    std::size_t before = 0;           ///< Bytes of the parts before it.
  };
  static Piece PieceOf(const Frame& frame, std::size_t packet) {
    Piece piece;
    std::size_t left = packet - 1;
    while (left >= PacketsOf(frame, piece.part)) {
      left -= PacketsOf(frame, piece.part);
      piece.before += frame.bytes[piece.part].size();
      ++piece.part;
    }
    piece.first = left * Room(frame);
    piece.size = std::min(Room(frame), frame.bytes[piece.part].size() - piece.first);
    return piece;
  }

  static std::string Leader(const Frame& frame) {
    if (frame.multipart) return EncodeGvspPartsLeader(frame.id, frame.parts);
    return EncodeGvspImageLeader(frame.id, frame.parts.front(), frame.chunks);
  }
  static std::string Trailer(const Frame& frame, std::uint32_t id) {
    if (frame.multipart) return EncodeGvspPartsTrailer(frame.id, id);
    return EncodeGvspImageTrailer(frame.id, frame.parts.front(), frame.chunks, id);
  }
  static std::string Header(const Frame& frame, std::uint32_t id, const Piece& piece) {
    if (!frame.multipart) return EncodeGvspImageHeader(frame.id, id);
    const auto part = static_cast<unsigned>(piece.part);
    return EncodeGvspPartsHeader(frame.id, id, part, piece.before + piece.first);
  }

  /// False: it cannot be sent.
  bool Put(const Frame& frame, std::size_t packet, const udp::endpoint& client) {
    asio::error_code error;
    const auto put = [&](const auto& bytes) { socket.send_to(bytes, client, 0, error); };
    const auto id = static_cast<std::uint32_t>(packet);
    if (packet == 0) {
      put(asio::buffer(Leader(frame)));
    } else if (packet > Packets(frame)) {
      put(asio::buffer(Trailer(frame, id)));
    } else {
      const Piece piece = PieceOf(frame, packet);
      const std::string header = Header(frame, id, piece);
      put(std::array<asio::const_buffer, 2>{
          asio::buffer(header),
          asio::buffer(frame.bytes[piece.part].data() + piece.first, piece.size)});
    }
    return !error;
  }

  asio::io_context io;
  udp::socket socket;
  bool to_loopback = false;
  bool by_time = false;  ///< The client's port does not tell how fast it reads.
  std::mutex mutex;      ///< Of `newest`.
  std::shared_ptr<const Frame> newest;
};

GvspSender::GvspSender(const std::string& listen) : impl_(std::make_unique<Impl>(listen)) {}
GvspSender::~GvspSender() = default;

void GvspSender::Send(Frame given, const GvspClient& to, const std::atomic<bool>& stop) {
  constexpr std::size_t kMaxDatagram = 65000;
  if (given.packet_size <= kGvspPartsOverhead || given.packet_size > kMaxDatagram) return;
  const auto frame = std::make_shared<const Frame>(std::move(given));
  {
    const std::lock_guard lock(impl_->mutex);
    // What was held back on purpose stays lost.
    impl_->newest = frame->sent_share < 1.0 ? nullptr : frame;
  }
  const asio::ip::address_v4 address(to.address);
  const udp::endpoint client(address, static_cast<std::uint16_t>(to.port));
  impl_->to_loopback = address.is_loopback();
  impl_->by_time = false;
  const std::size_t packets = Impl::Packets(*frame);
  const auto sent = static_cast<std::size_t>(
      std::floor(std::clamp(frame->sent_share, 0.0, 1.0) * static_cast<double>(packets)));
  bool ok = impl_->Put(*frame, 0, client);
  std::size_t burst = kBurst;  // The client makes room when it sees the leader.
  for (std::size_t packet = 1; packet <= sent && ok; ++packet) {
    if (burst + frame->packet_size > kBurst) {
      if (!impl_->AwaitRoom(to, stop)) return;
      burst = 0;
    }
    burst += frame->packet_size;
    ok = impl_->Put(*frame, packet, client);
  }
  if (sent == packets && ok) impl_->Put(*frame, packets + 1, client);
}

void GvspSender::SendAgain(const GvcpResend& packets, const GvspClient& to) {
  std::shared_ptr<const Frame> frame;
  {
    const std::lock_guard lock(impl_->mutex);
    frame = impl_->newest;
  }
  if (!frame || frame->multipart != packets.long_ids) return;
  const std::uint64_t id = frame->multipart ? frame->id.id : GvspShortId(frame->id);
  if (id != packets.frame_id) return;
  const udp::endpoint client(asio::ip::address_v4(to.address), static_cast<std::uint16_t>(to.port));
  const std::size_t end = std::min<std::size_t>(packets.last, Impl::Packets(*frame) + 1);
  for (std::size_t packet = packets.first; packet <= end; ++packet) {
    impl_->Put(*frame, packet, client);
  }
}

void GvspSender::SendTestPacket(const GvspClient& to, std::uint32_t packet_size) {
  constexpr std::uint32_t kIpAndUdp = 20 + 8;
  if (packet_size <= kIpAndUdp) return;
  const std::string bytes(packet_size - kIpAndUdp, '\0');
  asio::error_code too_large;
  impl_->socket.send_to(asio::buffer(bytes),
                        {asio::ip::address_v4(to.address), static_cast<std::uint16_t>(to.port)}, 0,
                        too_large);
}

}  // namespace tubetwin

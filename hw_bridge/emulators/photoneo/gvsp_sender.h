#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/codecs/gvcp.h"
#include "hw_bridge/codecs/gvsp.h"

namespace tubetwin {

/// Where a client awaits frames: IPv4 address and UDP port, host byte order.
struct GvspClient {
  std::uint32_t address = 0, port = 0;
  bool operator==(const GvspClient&) const = default;
};

/// Sends frames by GVSP, at the speed that the client can take: over Ethernet 100 MB/s, which
/// is what its wire holds; on loopback, where nothing else holds the sender back, as fast as the
/// client reads (the kernel tells how much waits at its port). A client that takes packets past its
/// port, as aravis does for root, leaves there what comes: to this one they go as over Ethernet.
class GvspSender {
 public:
  /// From a free port of `listen`. Throws Error(kDevice) when there is none.
  explicit GvspSender(const std::string& listen);
  ~GvspSender();

  struct Frame {
    GvspFrame id;
    bool multipart = false;  ///< Else one image: the only part.
    bool chunks = false;     ///< Of an image: see EncodeGvspImageLeader.
    std::vector<GvspPart> parts;
    std::vector<std::vector<std::byte>> bytes;  ///< Of each part.
    std::uint32_t packet_size = 0;              ///< As agreed on, with all headers.
    double sent_share = 1.0;                    ///< Of the payload packets, from the first one on.
  };
  /// Sends all of the frame. Returns early when `stop` is set, or the client has closed its port.
  /// Any thread, one frame at a time.
  void Send(Frame frame, const GvspClient& to, const std::atomic<bool>& stop);
  /// Packets of the newest frame again, of those that were meant to be sent; others are left out.
  /// Any thread.
  void SendAgain(const GvcpResend& packets, const GvspClient& to);
  /// One packet of that size with all headers, not to be cut in pieces on its way. Any thread.
  void SendTestPacket(const GvspClient& to, std::uint32_t packet_size);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

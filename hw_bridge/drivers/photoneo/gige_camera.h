#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <variant>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// Result of a wait that brought no cloud.
struct NoFrame {
  enum class Kind {
    kNotYet,      ///< Nothing came within the wait.
    kIncomplete,  ///< A frame of which packets are missing.
    kNoRange,     ///< A whole frame that holds no range image.
  } kind = Kind::kNotYet;
  std::string what;
};
using ReceivedFrame = std::variant<OrganizedCloud, NoFrame>;

/// A 3D scanner on GigE Vision, set up for range images on software trigger. A thin owner of
/// aravis's objects; one thread at a time.
///
/// On the network: packets go only to the camera's address, UDP port 3956. There is no broadcast,
/// no discovery and no raw socket. Two UDP ports are open, both on the local address that leads to
/// the camera: one for control, with a heartbeat each second, and one for frames. aravis does not
/// check who sent a datagram to these ports, so the scanner's network must be a private one.
class GigeCamera {
 public:
  /// Takes control of the camera and starts acquisition; nothing is scanned before Trigger(). Gives
  /// up within 8 s (a camera that vanishes half way: 13 s). Throws Error(kConfig) when `host` is no
  /// IPv4 address, Error(kDevice) naming device, place and what was awaited.
  explicit GigeCamera(const std::string& host);
  /// Releases the camera. At once, but up to 5 s when the link is broken, because aravis repeats
  /// its request.
  ~GigeCamera();

  /// "scanner HOST:3956 (GigE Vision)".
  const std::string& name() const;
  /// Whether control was lost: somebody else took it, or the camera has not answered for several
  /// seconds. It stays lost.
  bool lost() const;

  /// Asks for a frame; earlier ones are dropped. Throws Error(kDevice) when the camera does not
  /// confirm.
  void Trigger();
  /// Waits up to `wait` for a frame.
  ReceivedFrame Receive(std::chrono::milliseconds wait);
  /// Forgets frames that were asked for and have not come: they cannot arrive any more. Throws
  /// Error(kDevice).
  void Restart();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

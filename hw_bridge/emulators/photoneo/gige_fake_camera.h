#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hw_bridge/emulators/photoneo/gvsp_sender.h"

namespace tubetwin {

/// The control channel of an emulated GigE Vision scanner: aravis's fake camera, wearing the
/// description of a scanner. Aravis serves it on a thread of its own; the methods may be called
/// from one other thread. Aravis has no lock for registers: they are single words, of which either
/// side sees the old or the new.
///
/// Frames are sent by GvspSender, not by the fake camera: that one sends all packets of a frame at
/// once whether the client can follow or not, and nothing can hold back a frame that it has begun.
///
/// On the network: UDP port 3956 of the address, as the standard says. aravis also binds port 3956
/// of the interface's broadcast address and of 255.255.255.255, answers camera discovery there, and
/// does not validate control packets: a hostile one can end the program. Use it on loopback and
/// private networks only.
class GigeFakeCamera {
 public:
  /// Listens at once. Throws Error(kDevice) when `listen` is no IPv4 address of this machine or its
  /// port 3956 is taken.
  GigeFakeCamera(const std::string& listen, int width, int height);
  ~GigeFakeCamera();

  /// Whether a scan is wanted that TakeTrigger() has not returned.
  bool triggered() const;
  /// The client that wants a scan, once per trigger.
  std::optional<GvspClient> TakeTrigger();
  /// The client that frames can be sent to now; nothing while acquisition is stopped.
  std::optional<GvspClient> client() const;
  /// That this client has agreed to, with all headers.
  std::uint32_t packet_size() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

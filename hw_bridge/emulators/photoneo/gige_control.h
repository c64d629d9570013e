#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hw_bridge/emulators/photoneo/gige_registers.h"
#include "hw_bridge/emulators/photoneo/gvsp_sender.h"

namespace tubetwin {

/// The control channel of an emulated GigE Vision scanner: its registers over UDP port 3956 of one
/// address, as the standard says. A thread of its own serves it; the methods may be called from one
/// other thread. Whatever comes is judged before anything is done: the worst that a packet can do
/// is to be refused. One program has control, the one that asked first; it loses it by a second's
/// silence longer than the heartbeat that it has set. Packets of the newest frame are sent again on
/// request.
///
/// It also answers discovery on the broadcast addresses of loopback and of the whole network, where
/// these can be had; nothing else is answered there.
class GigeControl {
 public:
  /// Listens at once. Throws Error(kDevice) when `listen` is no IPv4 address of this machine or its
  /// port 3956 is taken. `sender` must outlive it.
  GigeControl(const std::string& listen, int width, int height, double focal_px,
              GvspSender& sender);
  ~GigeControl();

  /// Whether a scan is triggered that TakeTrigger() has not returned.
  bool triggered() const;
  /// The client that wants a scan: once per trigger; always while it takes frames without trigger.
  std::optional<GvspClient> TakeTrigger();
  /// The client that frames can be sent to now; nothing while acquisition is stopped.
  std::optional<GvspClient> client() const;
  /// That this client has agreed to, with all headers.
  std::uint32_t packet_size() const;
  /// What the next frame is to hold.
  GigeFrameSettings frame_settings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

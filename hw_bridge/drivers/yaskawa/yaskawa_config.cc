#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

void YaskawaConfig::Visit(ConfigVisitor& v) {
  constexpr Range kPort = {1, 65535};
  v.Field("host", "address of the controller", host);
  v.Field("motion_port", "TCP, trajectories", motion_port, kPort);
  v.Field("state_port", "TCP, joints and status", state_port, kPort);
  constexpr Range kPortOrNone = {0, 65535};
  v.Field("io_port", "TCP, inputs and outputs, read by `doctor`; 0: not there", io_port,
          kPortOrNone);
  v.Field("hses_port",
          "UDP, high-speed Ethernet server (files: the next port): names of alarms, pulses; 0: not "
          "there",
          hses_port, kPortOrNone);
  v.Choice("server",
           "what `emulate` serves: motoros1 takes what MotoROS 1.9.12 takes; strict refuses points "
           "that it takes without a look",
           server, {"motoros1", "strict"});
  v.Field("pulses_per_degree",
          "of the coarsest axis' encoder, where the high-speed Ethernet server does not tell it",
          pulses_per_degree, {1, 1e6});
}

void YaskawaConfig::ValidateOrThrow() const {
  if (host.empty()) {
    throw Error(ErrorKind::kConfig,
                "cell.arm.host is empty, the driver 'simple_message' needs an address");
  }
  if (!(rate > 0.0)) {
    throw Error(ErrorKind::kConfig, "rate is " + Number(rate) + ", allowed are numbers over 0");
  }
}

}  // namespace tubetwin

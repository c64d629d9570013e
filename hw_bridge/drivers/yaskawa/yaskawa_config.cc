#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/text.h"

namespace tubetwin {

void YaskawaConfig::Visit(ConfigVisitor& v) {
  v.Field("host", "the arm controller's address", host);
  v.Field("motion_port", "its TCP port of motion (simple_message)", motion_port, {1, 65535});
  v.Field("state_port", "its TCP port of states", state_port, {1, 65535});
  v.Field("io_port", "its TCP port of inputs and outputs", io_port, {1, 65535});
  v.Field("pulses_per_degree", "encoder pulses of a joint, the fewest of all six",
          pulses_per_degree, {10, 1e6});
  v.Field("armed", "the arm may be moved; otherwise nothing is sent to it", armed);
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

#include "hw_bridge/drivers/ati/netft_config.h"

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

void NetftConfig::Visit(ConfigVisitor& v) {
  v.Field("host", "address of the box", host);
  v.Field("port", "UDP, wrenches", port, {1, 65535});
  v.Field("http_port", "TCP, the box's configuration page", http_port, {1, 65535});
  v.Field("counts_per_N", "of the box's configuration", counts_per_N, {1, 1e9});
  v.Field("counts_per_Nm", "of the box's configuration", counts_per_Nm, {1, 1e9});
}

void NetftConfig::ValidateOrThrow() const {
  if (host.empty()) {
    throw Error(ErrorKind::kConfig, "cell.wrist.host is empty, the driver 'rdt' needs an address");
  }
  if (!(rate > 0.0)) {
    throw Error(ErrorKind::kConfig, "rate is " + Number(rate) + ", allowed are numbers over 0");
  }
}

std::string NetftConfig::Name() const {
  return "force/torque sensor " + host + ":" + std::to_string(port);
}

}  // namespace tubetwin

#include "hw_bridge/drivers/ati/netft_config.h"

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

void NetftConfig::Visit(ConfigVisitor& v) {
  v.Field("host", "the Net F/T box's address", host);
  v.Field("port", "its UDP port of raw data transfer", port, {1, 65535});
  v.Field("http_port", "its TCP port of the configuration page; 0: the page is not read", http_port,
          {0, 65535});
  v.Field("counts_per_N", "counts of a newton", counts_per_N, {1e-3, 1e9});
  v.Field("counts_per_Nm", "counts of a newton metre", counts_per_Nm, {1e-3, 1e9});
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

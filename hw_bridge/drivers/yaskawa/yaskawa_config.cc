#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

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

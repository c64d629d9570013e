#include "hw_bridge/drivers/robotiq/robotiq_config.h"

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

void RobotiqConfig::Visit(ConfigVisitor& v) {
  v.Field("host", "modbus_tcp: address", host);
  v.Field("port", "modbus_tcp: port", port, {1, 65535});
  v.Field("device", "modbus_rtu: serial device", device);
  v.Field("slave", "Modbus address", slave, {1, 247});
  v.Field("action_start", "first register to write; 0 behind Robotiq's own TCP unit", action_start,
          {0, 65533});
  v.Field("status_start", "first register to read; 0 behind Robotiq's own TCP unit", status_start,
          {0, 65533});
}

void RobotiqConfig::ValidateOrThrow() const {
  if (transport != "tcp" && transport != "rtu") {
    throw Error(ErrorKind::kConfig,
                "gripper transport is '" + transport + "', allowed are 'tcp' and 'rtu'");
  }
  if (transport == "tcp" && host.empty()) {
    throw Error(ErrorKind::kConfig,
                "cell.gripper.host is empty, the driver 'modbus_tcp' needs an address");
  }
  if (transport == "rtu" && device.empty()) {
    throw Error(ErrorKind::kConfig,
                "cell.gripper.device is empty, the driver 'modbus_rtu' needs a serial device");
  }
  if (!(rate > 0.0)) {
    throw Error(ErrorKind::kConfig, "rate is " + Number(rate) + ", allowed are numbers over 0");
  }
}

std::string RobotiqConfig::Name() const {
  return "gripper " + (transport == "rtu" ? device : host + ":" + std::to_string(port));
}

}  // namespace tubetwin

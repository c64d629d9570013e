#include "hw_bridge/drivers/registry.h"

#include "hw_bridge/drivers/ati/netft_driver.h"
#include "hw_bridge/drivers/photoneo/photoneo_driver.h"
#include "hw_bridge/drivers/robotiq/robotiq_driver.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_driver.h"

namespace tubetwin {

DeviceDrivers BuiltInDrivers() {
  DeviceDrivers drivers;
  drivers.arm.Add<YaskawaDriver>();
  drivers.gripper.Add<RobotiqDriver>();
  drivers.wrist.Add<NetftDriver>();
  drivers.scanner.Add<PhotoneoDriver>();
  return drivers;
}

}  // namespace tubetwin

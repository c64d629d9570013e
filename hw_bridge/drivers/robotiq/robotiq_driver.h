#pragma once

#include "hw_bridge/drivers/device_driver.h"
#include "hw_bridge/drivers/robotiq/robotiq_config.h"

namespace tubetwin {

/// What the registers of such a gripper mean.
GripperScale ScaleOf(const GripperSpec& gripper);

/// [cell.gripper] driver = "modbus_rtu" or "modbus_tcp": see RobotiqGripper.
class RobotiqDriver : public DeviceDriver<Gripper> {
 public:
  RobotiqConfig config;

  std::unique_ptr<DeviceDriver> Clone() const override;
  std::vector<DriverLink> Links() const override;
  std::string Summary() const override;
  void Visit(ConfigVisitor& v) override;
  std::unique_ptr<Gripper> Connect(const std::string& link,
                                   const DriverContext& context) const override;
  std::string Owned(const std::string& link) const override;
  void CountLink(const Gripper& device, Json& counts) const override;
};

}  // namespace tubetwin

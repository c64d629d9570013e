#pragma once

#include "hw_bridge/drivers/device_driver.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"

namespace tubetwin {

/// [cell.arm] driver = "simple_message": see YaskawaArm.
class YaskawaDriver : public DeviceDriver<Arm> {
 public:
  YaskawaConfig config;

  std::unique_ptr<DeviceDriver> Clone() const override;
  std::vector<DriverLink> Links() const override;
  std::string Summary() const override;
  void Visit(ConfigVisitor& v) override;
  std::string Address() const override;
  std::vector<DeviceFinding> Examine(const Arm& device,
                                     const DriverContext& context) const override;
  std::unique_ptr<Arm> Connect(const std::string& link,
                               const DriverContext& context) const override;
};

}  // namespace tubetwin

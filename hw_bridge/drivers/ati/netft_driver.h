#pragma once

#include "hw_bridge/drivers/ati/netft_config.h"
#include "hw_bridge/drivers/device_driver.h"

namespace tubetwin {

/// [cell.wrist] driver = "rdt": see NetftSensor.
class NetftDriver : public DeviceDriver<ForceTorqueSensor> {
 public:
  NetftConfig config;

  std::unique_ptr<DeviceDriver> Clone() const override;
  std::vector<DriverLink> Links() const override;
  std::string Summary() const override;
  void Visit(ConfigVisitor& v) override;
  std::unique_ptr<ForceTorqueSensor> Connect(const std::string& link,
                                             const DriverContext& context) const override;
  std::string Owned(const std::string& link) const override;
  void CountLink(const ForceTorqueSensor& device, Json& counts) const override;
};

}  // namespace tubetwin

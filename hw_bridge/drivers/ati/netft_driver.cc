#include "hw_bridge/drivers/ati/netft_driver.h"

#include "hw_bridge/drivers/ati/netft_sensor.h"
#include "models/base/json.h"

namespace tubetwin {

std::unique_ptr<DeviceDriver<ForceTorqueSensor>> NetftDriver::Clone() const {
  return std::make_unique<NetftDriver>(*this);
}

std::vector<DriverLink> NetftDriver::Links() const {
  return {{"rdt", "check power, address and [cell.wrist]; counts must be those of its page", ""}};
}

std::string NetftDriver::Summary() const { return "an ATI Net F/T box"; }

void NetftDriver::Visit(ConfigVisitor& v) { config.Visit(v); }

std::unique_ptr<ForceTorqueSensor> NetftDriver::Connect(const std::string&,
                                                        const DriverContext& context) const {
  NetftConfig used = config;
  used.rate = context.rate;
  return std::make_unique<NetftSensor>(used, context.clock);
}

std::string NetftDriver::Owned(const std::string&) const {
  return config.host + ":" + std::to_string(config.port);
}

void NetftDriver::CountLink(const ForceTorqueSensor& device, Json& counts) const {
  const auto* sensor = dynamic_cast<const NetftSensor*>(&device);
  if (sensor == nullptr) return;
  const NetftSensor::Statistics s = sensor->statistics();
  counts = Json{{"samples", s.samples},
                {"lost", s.lost},
                {"late", s.late},
                {"malformed", s.malformed},
                {"faulty", s.faulty}};
}

}  // namespace tubetwin

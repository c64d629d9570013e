#include "hw_bridge/drivers/yaskawa/yaskawa_driver.h"

#include "hw_bridge/drivers/yaskawa/supervision.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"

namespace tubetwin {
namespace {

constexpr const char* kController = "motoros";

}  // namespace

std::unique_ptr<DeviceDriver<Arm>> YaskawaDriver::Clone() const {
  return std::make_unique<YaskawaDriver>(*this);
}

std::vector<DriverLink> YaskawaDriver::Links() const {
  return {{"simple_message",
           "switch the controller on, start its job INIT_ROS, check host and ports in [cell.arm]",
           ""}};
}

std::string YaskawaDriver::Summary() const { return "a Yaskawa controller with MotoROS"; }

void YaskawaDriver::Visit(ConfigVisitor& v) { config.Visit(v); }

std::string YaskawaDriver::Address() const {
  return config.host + ":" + std::to_string(config.motion_port);
}

std::vector<DeviceFinding> YaskawaDriver::Examine(const Arm& device, const DriverContext&) const {
  return Supervise(config, device.State().q);
}

std::unique_ptr<Arm> YaskawaDriver::Connect(const std::string&,
                                            const DriverContext& context) const {
  if (context.model.arm.controller != kController) {
    throw Error(
        ErrorKind::kConfig,
        "cell.arm.driver: simple_message speaks for Yaskawa controllers; the cell model's arm "
        "is a " +
            context.model.arm.name + "; allowed are arms whose file says controller = \"motoros\"");
  }
  YaskawaConfig used = config;
  used.armed = context.may_move;
  used.rate = context.rate;
  return std::make_unique<YaskawaArm>(used, context.model.arm, context.clock);
}

}  // namespace tubetwin

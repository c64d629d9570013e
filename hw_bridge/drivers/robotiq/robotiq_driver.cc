#include "hw_bridge/drivers/robotiq/robotiq_driver.h"

#include <filesystem>

#include "hw_bridge/drivers/robotiq/robotiq_gripper.h"
#include "models/base/json.h"

namespace tubetwin {
namespace {

constexpr const char* kRtu = "modbus_rtu";
constexpr const char* kController = "robotiq";

}  // namespace

GripperScale ScaleOf(const GripperSpec& gripper) {
  return {gripper.stroke_m, gripper.min_speed_m_s, gripper.max_speed_m_s, gripper.min_force_N,
          gripper.max_force_N};
}

std::unique_ptr<DeviceDriver<Gripper>> RobotiqDriver::Clone() const {
  return std::make_unique<RobotiqDriver>(*this);
}

std::vector<DriverLink> RobotiqDriver::Links() const {
  const std::string fix = "check power, cable and [cell.gripper]";
  return {{kRtu, fix, ""}, {"modbus_tcp", fix, ""}};
}

std::string RobotiqDriver::Summary() const {
  return "a Robotiq 2F-85 or 2F-140 by serial line or network";
}

void RobotiqDriver::Visit(ConfigVisitor& v) { config.Visit(v); }

std::unique_ptr<Gripper> RobotiqDriver::Connect(const std::string& link,
                                                const DriverContext& context) const {
  if (context.model.gripper.controller != kController) {
    throw Error(ErrorKind::kConfig,
                "cell.gripper.driver: " + link +
                    " speaks Robotiq's registers; the cell model's "
                    "gripper is a " +
                    context.model.gripper.name +
                    "; allowed are grippers whose file says controller = \"robotiq\"");
  }
  RobotiqConfig used = config;
  used.transport = link == kRtu ? "rtu" : "tcp";
  used.rate = context.rate;
  used.scale = ScaleOf(context.model.gripper);
  used.activate = context.may_move;
  used.confirm = context.confirm;
  return std::make_unique<RobotiqGripper>(used, context.clock);
}

std::string RobotiqDriver::Owned(const std::string& link) const {
  return link == kRtu ? std::filesystem::weakly_canonical(config.device).string()
                      : config.host + ":" + std::to_string(config.port);
}

void RobotiqDriver::CountLink(const Gripper& device, Json& counts) const {
  if (const auto* gripper = dynamic_cast<const RobotiqGripper*>(&device)) {
    counts = Json{{"unanswered", gripper->unanswered()}, {"problem", gripper->LinkProblem()}};
  }
}

}  // namespace tubetwin

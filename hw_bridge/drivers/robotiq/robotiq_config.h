#pragma once

#include <functional>
#include <string>

#include "hw_bridge/codecs/robotiq_registers.h"
#include "models/base/config/config.h"

namespace tubetwin {

/// How to reach a Robotiq 2F gripper: `[cell.gripper]` of a cell file.
struct RobotiqConfig {
  /// "tcp" or "rtu": the cell file's drivers modbus_tcp, modbus_rtu.
  std::string transport = "tcp";
  std::string host = "192.168.1.11";    ///< tcp.
  int port = 1502;                      ///< tcp.
  std::string device = "/dev/ttyUSB0";  ///< rtu: serial device, 115200 baud 8N1.
  int slave = 9;
  /// First registers to write and to read. The gripper's own; gateways may map them elsewhere.
  int action_start = kGripperActionStart, status_start = kGripperStatusStart;
  /// Cell time per wall time: of the whole cell, so the cell file's own key and not visited here.
  double rate = 1.0;
  /// Activate the gripper when it is not: its fingers then open and close. Not visited: doctor, who
  /// moves nothing, goes without.
  bool activate = true;
  /// Asked before an activation whose motion could drop what the fingers hold: true is a person's
  /// word that it may. Empty: nobody is there. Not visited.
  std::function<bool(const std::string& what)> confirm;

  /// Figures of the cell's gripper. Not visited.
  GripperScale scale;

  /// Not `transport`, which the key `driver` says.
  void Visit(ConfigVisitor& v);
  /// Throws Error(kConfig) for what the fields' own ranges cannot say.
  void ValidateOrThrow() const;
  /// "gripper 127.0.0.1:1502", for messages.
  std::string Name() const;
};

}  // namespace tubetwin

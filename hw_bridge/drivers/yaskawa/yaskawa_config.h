#pragma once

#include <string>

#include "models/base/config/config.h"

namespace tubetwin {

/// How to reach a Yaskawa controller that runs MotoROS 1: `[cell.arm]` of a cell file.
struct YaskawaConfig {
  std::string host = "192.168.1.31";  ///< Factory address of the controller.
  int motion_port = 50240;            ///< TCP, simple_message.
  int state_port = 50241;
  /// Inputs and outputs (TCP) and high-speed Ethernet server (UDP), for supervision: `doctor` reads
  /// them; a session asks the latter for pulses and for the names of alarms. 0: there is none.
  int io_port = 50242, hses_port = 10040;
  /// What `emulate` serves on these ports: "motoros1" or "strict". Real controllers are the first.
  std::string server = "motoros1";
  /// Of the coarsest axis, for the controller compares starts in pulses: where supervision does not
  /// tell them.
  double pulses_per_degree = 1000;
  /// Without it nothing is sent: the motion port is not even connected. Not visited: the key of the
  /// same name concerns any arm.
  bool armed = false;
  /// Cell time per wall time: of the whole cell, so the cell file's own key and not visited here.
  double rate = 1.0;

  void Visit(ConfigVisitor& v);
  /// Throws Error(kConfig) for what the fields' own ranges cannot say.
  void ValidateOrThrow() const;
};

}  // namespace tubetwin

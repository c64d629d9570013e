#pragma once

#include <string>

namespace tubetwin {

/// How to reach a Yaskawa controller that runs MotoROS 1: `[cell.arm]` of a cell file.
struct YaskawaConfig {
  std::string host = "127.0.0.1";
  int motion_port = 50240;  ///< TCP, simple_message.
  int state_port = 50241;
  /// Not connected: nothing that the arm's interface offers needs it.
  int io_port = 50242;
  double pulses_per_degree = 1000;  ///< Of the coarsest axis: the controller compares starts in it.
  /// Without it nothing is sent: the motion port is not even connected.
  bool armed = false;
  /// Cell time per wall time: of the whole cell, so the cell file's own key.
  double rate = 1.0;

  /// Throws Error(kConfig) for what the fields' own ranges cannot say.
  void ValidateOrThrow() const;
};

}  // namespace tubetwin

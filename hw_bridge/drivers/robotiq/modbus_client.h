#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "hw_bridge/codecs/robotiq_registers.h"
#include "hw_bridge/drivers/robotiq/robotiq_config.h"

namespace tubetwin {

/// The gripper's registers over libmodbus, RTU or TCP. Every call waits for its answer, within the
/// limit that was set. One thread.
class ModbusClient {
 public:
  /// Connects. Throws Error(kDevice) naming device, place and reason when that fails or lasts
  /// longer than `limit`.
  ModbusClient(const RobotiqConfig& config, std::chrono::nanoseconds limit);
  ~ModbusClient();

  /// From here on: how long to wait for an answer, and within one for its next byte.
  void SetAnswerLimit(std::chrono::nanoseconds limit);

  enum class Result {
    kDone,
    kNoAnswer,  ///< In time, or one that cannot be understood: try again.
    kRefused,   ///< By a Modbus exception.
    kLost,      ///< The link is gone for good.
  };
  Result Write(const GripperRegisters& words);
  /// By function 3, or by 4 once the gripper has said that it does not know 3.
  Result Read(GripperRegisters& words);
  /// Why the last call was not done.
  const std::string& problem() const { return problem_; }

 private:
  Result Judge(bool done);
  struct Line;
  std::unique_ptr<Line> line_;
  int action_start_, status_start_;
  bool by_input_registers_ = false;
  std::string problem_;
};

}  // namespace tubetwin

#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "hw_bridge/codecs/hses.h"
#include "hw_bridge/emulators/yaskawa/arm_controller.h"

namespace tubetwin {

/// The High-Speed Ethernet Server of an emulated controller: status, alarms, positions, servo,
/// hold, reset, jobs, I/O bytes, registers and variables. Move commands are undefined here: motion
/// is MotoROS's.
class HsesResponder {
 public:
  /// `controller` must outlive it.
  explicit HsesResponder(ArmController& controller) : controller_(controller) {}

  hses::Answer AnswerTo(const hses::Request& request);

  /// Jobs that can be selected.
  std::vector<std::string> jobs = {"INIT_ROS"};

 private:
  void Read(const hses::Request& request, hses::Answer& answer) const;
  void ReadPosition(const hses::Request& request, hses::Answer& answer) const;
  void Write(const hses::Request& request, hses::Answer& answer);
  void Power(const hses::Request& request, std::uint32_t value, hses::Answer& answer);
  void SelectJob(const hses::Request& request, hses::Answer& answer);
  void Variable(const hses::Request& request, hses::Answer& answer);
  void ReadVariable(const hses::Request& request, hses::Answer& answer) const;
  void WriteVariable(const hses::Request& request, hses::Answer& answer);

  ArmController& controller_;
  /// By command and number; what is missing is zero.
  std::map<std::pair<std::uint16_t, std::uint16_t>, hses::Value> variables_;
};

}  // namespace tubetwin

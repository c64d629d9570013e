#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hw_bridge/codecs/hses.h"
#include "hw_bridge/emulators/yaskawa/arm_controller.h"

namespace tubetwin {

/// The High-Speed Ethernet Server of an emulated controller: status, alarms, positions, servo,
/// hold, reset, jobs, I/O bytes, registers and variables, one by one or several at once. What is
/// read is read whole (attribute 0) or by attribute. Move commands are refused while a job runs and
/// undefined otherwise: motion is MotoROS's.
class HsesResponder {
 public:
  /// `controller` must outlive it.
  explicit HsesResponder(ArmController& controller) : controller_(controller) {}

  hses::Answer AnswerTo(const hses::Request& request);
  /// What file control answers: there is none.
  static hses::Answer NoFiles(const hses::Request& request);

  /// Jobs that can be selected.
  std::vector<std::string> jobs = {"INIT_ROS"};

 private:
  using Answer = hses::Answer;
  using Request = hses::Request;

  /// All attributes of what can only be read; nothing: no such instance.
  std::optional<std::string> Whole(std::uint16_t command, std::uint16_t instance) const;
  std::string AlarmData(std::int32_t code) const;
  std::string StatusData() const;
  std::optional<std::string> PositionData(std::uint16_t instance) const;
  void Read(const Request& request, Answer& answer) const;
  void Control(const Request& request, Answer& answer);
  void Power(const Request& request, std::uint32_t value, Answer& answer);
  void Start(Answer& answer);
  void SelectJob(const Request& request, Answer& answer);

  // Variables, registers and I/O bytes, as bytes.
  std::optional<std::string> Element(std::uint16_t command, std::uint32_t number) const;
  /// The added status why not; 0: written.
  std::uint16_t Write(std::uint16_t command, std::uint32_t number, const std::string& bytes);
  void Variable(const Request& request, Answer& answer);
  void Plural(const Request& request, Answer& answer);

  ArmController& controller_;
  /// By command and number; what is missing is zero.
  std::map<std::pair<std::uint16_t, std::uint32_t>, std::string> variables_;
  std::uint32_t cycle_ = 3;  ///< 1 step, 2 one cycle, 3 continuous.
};

/// Refuses with an added status.
void RefuseHses(hses::Answer& answer, std::uint16_t why);

/// Of what has attributes of these sizes: all of it (attribute 0) or one of them (from 1), as
/// service and attribute ask. Nothing: no such service or attribute.
struct HsesSlice {
  std::size_t at = 0, size = 0;
};
std::optional<HsesSlice> SliceOf(const hses::Request& request, std::uint8_t all, std::uint8_t one,
                                 const std::vector<std::size_t>& sizes);

}  // namespace tubetwin

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "hw_bridge/codecs/hses.h"
#include "models/base/joint.h"

namespace tubetwin {

struct HsesConfig {
  std::string host = "127.0.0.1";
  int port = 10040;                 ///< UDP, robot control.
  double pulses_per_degree = 1000;  ///< Of each joint.
  double answer_s = 0.2;            ///< How long one try waits, wall time.
  int tries = 3;
  /// "arm supervision 127.0.0.1:10040", for messages.
  std::string Name() const;
};

/// Why there is no result.
struct HsesProblem {
  std::string reason;              ///< With device and place.
  bool silent = false;             ///< Nobody answered.
  std::uint16_t added_status = 0;  ///< Of a refusal: hses::kNotRemote...
};
template <typename T>
using HsesResult = std::variant<T, HsesProblem>;
struct HsesDone {};

/// Supervision of a Yaskawa controller by its High-Speed Ethernet Server: beside the motion ports,
/// and never for motion. Calls block until the answer is there, at most tries x answer_s; a
/// question without an answer is asked again, which these questions allow: all but StartJob say how
/// it is or shall be. One thread.
class HsesClient {
 public:
  /// Opens a socket; nothing is sent. Throws Error(kDevice) when the host cannot be resolved.
  explicit HsesClient(const HsesConfig& config);
  ~HsesClient();

  HsesResult<hses::Status> ReadStatus();
  /// The newest is 1, the oldest 4. Code 0: none.
  HsesResult<hses::Alarm> ReadAlarm(std::uint16_t which = 1);
  HsesResult<hses::Job> ReadJob();
  /// Of kPulses, kCartesian.
  HsesResult<hses::Position> ReadPosition(std::uint16_t instance = hses::kPulses);
  /// The pulses in radians.
  HsesResult<JointVector> ReadJoints();
  /// `command`: kIoByte, kRegister, kVariableB to kVariableS.
  HsesResult<hses::Value> ReadValue(std::uint16_t command, std::uint16_t number);
  HsesResult<HsesDone> WriteValue(std::uint16_t command, std::uint16_t number,
                                  const hses::Value& value);
  HsesResult<HsesDone> SetHold(bool on);
  HsesResult<HsesDone> SetServo(bool on);
  HsesResult<HsesDone> ResetAlarm();
  /// The selected job. Asked once: a second time might start it twice.
  HsesResult<HsesDone> StartJob();

  /// Datagrams that were no answer to what was asked, so far.
  int ignored() const;

 private:
  HsesResult<std::string> Ask(hses::Request request, int tries);
  HsesResult<HsesDone> Set(std::uint16_t command, std::uint16_t instance, std::uint32_t word,
                           int tries);
  template <typename T, typename Decode>
  HsesResult<T> Read(hses::Request request, Decode decode);

  HsesConfig config_;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

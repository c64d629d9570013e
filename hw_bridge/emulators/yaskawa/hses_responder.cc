#include "hw_bridge/emulators/yaskawa/hses_responder.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

using hses::Answer;
using hses::Request;

/// The robot's own frame lies in the shoulder, over the mounting face.
constexpr double kShoulderHeight_m = 0.275;
constexpr std::uint16_t kVariables = 100;  ///< Of each kind, the controller's default.
constexpr std::uint16_t kRegisters = 1000;
constexpr std::uint16_t kFirstNetworkInput = 2701, kLastNetworkInput = 2956;

void Refuse(Answer& answer, std::uint16_t why) {
  answer.status = hses::kRefused;
  answer.added_words = 1;
  answer.added_status = why;
}

bool IsVariable(std::uint16_t command) {
  return command == hses::kIoByte || (command >= hses::kRegister && command <= hses::kVariableS);
}

std::uint32_t If(bool condition, std::uint32_t bit) { return condition ? bit : 0; }

/// 0.001 mm and 0.0001 degrees, R = Rz Ry Rx.
std::array<std::int32_t, 8> CartesianWords(const RigidTransform& X_BF) {
  const Matrix3 R = X_BF.linear();
  const double ry = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double rx = std::atan2(R(2, 1), R(2, 2));
  const double rz = std::atan2(R(1, 0), R(0, 0));
  const Vector3 p = X_BF.translation() - Vector3(0, 0, kShoulderHeight_m);
  std::array<std::int32_t, 8> words{};
  for (int i = 0; i < 3; ++i) words[i] = static_cast<std::int32_t>(std::lround(p[i] * 1e6));
  const double angles[] = {rx, ry, rz};
  for (int i = 0; i < 3; ++i) {
    words[3 + i] = static_cast<std::int32_t>(std::lround(Degrees(angles[i]) * 1e4));
  }
  return words;
}

}  // namespace

Answer HsesResponder::AnswerTo(const Request& request) {
  Answer answer;
  answer.division = request.division;
  answer.id = request.id;
  answer.service = request.service & 0x7f;
  if (request.division != hses::Division::kRobot) {
    answer.status = hses::kCommandUndefined;
  } else if (IsVariable(request.command)) {
    Variable(request, answer);
  } else {
    switch (request.command) {
      case hses::kAlarm:
      case hses::kStatus:
      case hses::kExecutingJob:
      case hses::kPosition:
        request.service == hses::kGetAll ? Read(request, answer)
                                         : Refuse(answer, hses::kNoAttribute);
        break;
      case hses::kReset:
      case hses::kPower:
      case hses::kStartJob:
        request.service == hses::kSetOne ? Write(request, answer)
                                         : Refuse(answer, hses::kNoAttribute);
        break;
      case hses::kSelectJob:
        SelectJob(request, answer);
        break;
      default:
        answer.status = hses::kCommandUndefined;
        answer.added_words = 1;
        answer.added_status = hses::kNoCommand;
    }
  }
  return answer;
}

void HsesResponder::Read(const Request& request, Answer& answer) const {
  using hses::Status;
  const simple_message::RobotStatus now = controller_.Status();
  switch (request.command) {
    case hses::kAlarm: {
      if (request.instance < 1 || request.instance > 4) {
        return Refuse(answer, hses::kNoInstance);
      }
      hses::Alarm alarm;
      if (request.instance == 1 && controller_.alarm() != 0) {
        alarm.code = static_cast<std::uint32_t>(controller_.alarm());
        alarm.name = "ALARM " + std::to_string(controller_.alarm());
      }
      answer.data = hses::Encode(alarm);
      return;
    }
    case hses::kStatus: {
      if (request.instance != 1) return Refuse(answer, hses::kNoInstance);
      const bool play = now.mode == simple_message::RobotStatus::kPlay;
      answer.data =
          hses::Encode(Status{Status::kContinuous | If(controller_.running(), Status::kRunning) |
                                  If(!play, Status::kTeach) | If(play, Status::kPlay) |
                                  If(controller_.remote(), Status::kCommandRemote),
                              If(controller_.held(), Status::kCommandHold) |
                                  If(controller_.alarm() != 0, Status::kAlarm) |
                                  If(controller_.servo_on(), Status::kServoOn)});
      return;
    }
    case hses::kExecutingJob:
      if (request.instance != 1) return Refuse(answer, hses::kNoInstance);
      answer.data =
          hses::Encode(hses::Job{controller_.job(), controller_.running() ? 5u : 0u, 0, 100});
      return;
    default:
      return ReadPosition(request, answer);
  }
}

void HsesResponder::ReadPosition(const Request& request, Answer& answer) const {
  hses::Position position;
  if (request.instance == hses::kPulses) {
    const auto pulses = controller_.Pulses();
    std::copy(pulses.begin(), pulses.end(), position.axes.begin());
  } else if (request.instance == hses::kCartesian) {
    position.type = 16;
    position.axes = CartesianWords(FlangePose(controller_.model(), controller_.servo().q));
  } else {
    return Refuse(answer, hses::kNoInstance);
  }
  answer.data = hses::Encode(position);
}

void HsesResponder::Write(const Request& request, Answer& answer) {
  const auto word = hses::DecodeValue(hses::kVariableD, request.data);
  if (!std::holds_alternative<hses::Value>(word) || request.data.size() != 4) {
    return Refuse(answer, hses::kDataSize);
  }
  const auto value =
      static_cast<std::uint32_t>(std::get<std::int32_t>(std::get<hses::Value>(word)));
  if (!controller_.remote()) return Refuse(answer, hses::kNotRemote);
  switch (request.command) {
    case hses::kReset:
      if (request.instance != hses::kResetAlarm && request.instance != hses::kCancelError) {
        return Refuse(answer, hses::kNoInstance);
      }
      if (request.instance == hses::kResetAlarm) controller_.ResetAlarm();
      if (controller_.alarm() != 0) Refuse(answer, hses::kInAlarm);
      return;
    case hses::kPower:
      return Power(request, value, answer);
    default:
      if (controller_.held()) return Refuse(answer, hses::kHeldByCommand);
      if (controller_.alarm() != 0) return Refuse(answer, hses::kInAlarm);
      if (!controller_.servo_on()) return Refuse(answer, hses::kServoOff);
      if (!controller_.StartJob()) Refuse(answer, hses::kWrongMode);
  }
}

void HsesResponder::Power(const Request& request, std::uint32_t value, Answer& answer) {
  if (value != hses::kOn && value != hses::kOff) return Refuse(answer, hses::kOutOfRange);
  switch (request.instance) {
    case hses::kHold:
      return controller_.SetHold(value == hses::kOn);
    case hses::kServo:
      if (!controller_.SwitchServo(value == hses::kOn)) Refuse(answer, hses::kServoFails);
      return;
    default:
      return Refuse(answer, hses::kNoInstance);
  }
}

void HsesResponder::SelectJob(const Request& request, Answer& answer) {
  const auto selected = hses::DecodeJobSelection(request.data);
  if (const auto* job = std::get_if<hses::Job>(&selected)) {
    if (!controller_.remote()) return Refuse(answer, hses::kNotRemote);
    if (controller_.running()) return Refuse(answer, hses::kMoving);
    if (std::count(jobs.begin(), jobs.end(), job->name) == 0) {
      return Refuse(answer, hses::kNoSuchJob);
    }
    return controller_.SelectJob(job->name);
  }
  Refuse(answer, hses::kDataSize);
}

void HsesResponder::Variable(const Request& request, Answer& answer) {
  const std::uint16_t max_instance = request.command == hses::kIoByte     ? 9999
                                     : request.command == hses::kRegister ? kRegisters - 1
                                                                          : kVariables - 1;
  if (request.instance > max_instance) return Refuse(answer, hses::kNoInstance);
  if (request.attribute != 1) return Refuse(answer, hses::kNoAttribute);
  if (request.service == hses::kGetOne) return ReadVariable(request, answer);
  if (request.service == hses::kSetOne) return WriteVariable(request, answer);
  Refuse(answer, hses::kNoAttribute);
}

void HsesResponder::ReadVariable(const Request& request, Answer& answer) const {
  if (request.command == hses::kIoByte) {
    const auto group = controller_.io().Group(request.instance);
    if (!group) return Refuse(answer, hses::kNoInstance);
    answer.data = hses::Encode(hses::Value(*group));
    return;
  }
  if (request.command == hses::kRegister) {
    answer.data = hses::Encode(hses::Value(controller_.io().Register(request.instance)));
    return;
  }
  const auto found = variables_.find({request.command, request.instance});
  if (found != variables_.end()) {
    answer.data = hses::Encode(found->second);
  } else {  // Zero, in its kind's size.
    const auto zero = hses::DecodeValue(request.command, std::string(16, '\0'));
    answer.data = hses::Encode(std::get<hses::Value>(zero));
  }
}

void HsesResponder::WriteVariable(const Request& request, Answer& answer) {
  const auto value = hses::DecodeValue(request.command, request.data);
  if (!std::holds_alternative<hses::Value>(value)) return Refuse(answer, hses::kDataSize);
  if (!controller_.remote()) return Refuse(answer, hses::kNotRemote);
  const hses::Value& written = std::get<hses::Value>(value);
  if (request.command == hses::kIoByte) {
    if (request.instance < kFirstNetworkInput || request.instance > kLastNetworkInput) {
      return Refuse(answer, hses::kNoInstance);
    }
    controller_.io().Answer(
        simple_message::WriteGroup{request.instance, std::get<std::uint8_t>(written)});
  } else if (request.command == hses::kRegister) {
    controller_.io().SetRegister(request.instance, std::get<std::uint16_t>(written));
  } else {
    variables_[{request.command, request.instance}] = written;
  }
}

}  // namespace tubetwin

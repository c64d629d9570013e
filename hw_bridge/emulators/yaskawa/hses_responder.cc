#include "hw_bridge/emulators/yaskawa/hses_responder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tubetwin {
namespace {

using hses::Answer;
using hses::Request;

/// The robot's own frame lies in the shoulder, over the mounting face.
constexpr double kShoulderHeight_m = 0.275;
constexpr std::size_t kAxes = 8;

std::uint32_t If(bool condition, std::uint32_t bit) { return condition ? bit : 0; }

std::string Padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

std::string Words(const std::vector<std::int32_t>& words) {
  std::string out;
  for (const std::int32_t word : words) out += hses::Word(static_cast<std::uint32_t>(word));
  return out;
}

/// Sizes of the attributes of what can only be read.
std::vector<std::size_t> SizesOf(std::uint16_t command) {
  switch (command) {
    case hses::kAlarm:
    case hses::kAlarmHistory:
      return {4, 4, 4, 16, 32};
    case hses::kAlarmTexts:
    case hses::kAlarmHistoryTexts:
      return {4, 4, 4, 16, 32, 16, 96, 96};
    case hses::kStatus:
      return {4, 4};
    case hses::kExecutingJob:
      return {32, 4, 4, 4};
    case hses::kPosition:
      return std::vector<std::size_t>(5 + kAxes, 4);
    case hses::kManagementTime:
      return {16, 12};
    case hses::kSystemInfo:
      return {24, 16, 8};
    default:
      return std::vector<std::size_t>(kAxes, 4);
  }
}

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

std::string AlarmName(std::int32_t code) {
  switch (code) {
    case 1325:
      return "COMMUNICATION ERROR(ENCODER)";
    case 4107:
      return "OUT OF RANGE(ABSO DATA)";
    case 4315:
      return "COLLISION DETECT";
    case 4414:
      return "EXCESSIVE SEGMENT";
    default:
      return "ALARM " + std::to_string(code);
  }
}

}  // namespace

void RefuseHses(Answer& answer, std::uint16_t why) {
  answer.status = hses::kRefused;
  answer.added_words = 1;
  answer.added_status = why;
}

std::optional<HsesSlice> SliceOf(const Request& request, std::uint8_t all, std::uint8_t one,
                                 const std::vector<std::size_t>& sizes) {
  const std::size_t attribute = request.attribute;
  if (request.service == all) {
    // What has one attribute is whole by that, too.
    if (attribute != 0 && !(attribute == 1 && sizes.size() == 1)) return std::nullopt;
    return HsesSlice{0, std::accumulate(sizes.begin(), sizes.end(), std::size_t{0})};
  }
  if (request.service != one || attribute < 1 || attribute > sizes.size()) return std::nullopt;
  const auto own = sizes.begin() + static_cast<std::ptrdiff_t>(attribute - 1);
  return HsesSlice{std::accumulate(sizes.begin(), own, std::size_t{0}), *own};
}

Answer HsesResponder::NoFiles(const Request& request) {
  Answer answer;
  answer.division = request.division;
  answer.id = request.id;
  answer.service = request.service & 0x7f;
  answer.status = hses::kCommandUndefined;
  answer.added_words = 1;
  answer.added_status = hses::kNoCommand;
  return answer;
}

Answer HsesResponder::AnswerTo(const Request& request) {
  if (request.division != hses::Division::kRobot) return NoFiles(request);
  Answer answer;
  answer.division = request.division;
  answer.id = request.id;
  answer.service = request.service & 0x7f;
  const std::uint16_t command = request.command;
  const bool move = command == hses::kMoveCartesian || command == hses::kMovePulse;
  const bool reads = (command >= hses::kAlarm && command <= hses::kTorque) ||
                     command == hses::kManagementTime || command == hses::kSystemInfo ||
                     command == hses::kAlarmTexts || command == hses::kAlarmHistoryTexts;
  if (reads) {
    Read(request, answer);
  } else if ((command >= hses::kIoByte && command <= hses::kVariableEx) ||
             command == hses::kVariableS32) {
    Variable(request, answer);
  } else if ((command >= hses::kPluralIo && command <= hses::kPluralEx) ||
             command == hses::kPluralS32) {
    Plural(request, answer);
  } else if (command == hses::kSelectJob) {
    SelectJob(request, answer);
  } else if (command >= hses::kReset && command <= hses::kStartJob) {
    Control(request, answer);
  } else if (move && controller_.running()) {
    RefuseHses(answer, hses::kMoving);
  } else {
    return NoFiles(request);
  }
  return answer;
}

std::string HsesResponder::AlarmData(std::int32_t code) const {
  hses::Alarm alarm;
  if (code != 0) {
    alarm.code = static_cast<std::uint32_t>(code);
    alarm.name = AlarmName(code);
  }
  return hses::Encode(alarm);
}

std::string HsesResponder::StatusData() const {
  using hses::Status;
  const bool play = controller_.Status().mode == simple_message::RobotStatus::kPlay;
  return hses::Encode(Status{
      If(cycle_ == 1, Status::kStep) | If(cycle_ == 2, Status::kOneCycle) |
          If(cycle_ == 3, Status::kContinuous) | If(controller_.running(), Status::kRunning) |
          If(controller_.speed_limited(), Status::kSpeedLimited) | If(!play, Status::kTeach) |
          If(play, Status::kPlay) | If(controller_.remote(), Status::kCommandRemote),
      If(controller_.held(), Status::kCommandHold) | If(controller_.alarm() != 0, Status::kAlarm) |
          If(controller_.servo_on(), Status::kServoOn)});
}

std::optional<std::string> HsesResponder::PositionData(std::uint16_t instance) const {
  hses::Position position;
  if (instance == hses::kPulses) {
    const auto pulses = controller_.Pulses();
    std::copy(pulses.begin(), pulses.end(), position.axes.begin());
  } else if (instance == hses::kCartesian) {
    position.type = 16;
    position.axes = CartesianWords(FlangePose(controller_.model(), controller_.servo().q));
  } else {
    return std::nullopt;
  }
  return hses::Encode(position);
}

std::optional<std::string> HsesResponder::Whole(std::uint16_t command,
                                                std::uint16_t instance) const {
  constexpr std::uint16_t kAlarms = 4, kFirstOfKind = 1, kLastOfKind = 100, kKinds = 1000,
                          kLastKind = 4, kRobot = 11;
  const std::uint16_t of_kind = instance % kKinds;
  switch (command) {
    case hses::kAlarm:
      if (instance < 1 || instance > kAlarms) return std::nullopt;
      return AlarmData(instance == 1 ? controller_.alarm() : 0);
    case hses::kAlarmHistory:
      if (of_kind < kFirstOfKind || of_kind > kLastOfKind || instance / kKinds > kLastKind) {
        return std::nullopt;
      }
      return AlarmData(0);
    case hses::kAlarmTexts:
    case hses::kAlarmHistoryTexts: {  // No alarm of this controller has a sub-code.
      const bool history = command == hses::kAlarmHistoryTexts;
      const auto alarm = Whole(history ? hses::kAlarmHistory : hses::kAlarm, instance);
      if (!alarm) return std::nullopt;
      return Padded(*alarm, alarm->size() + 16 + 96 + 96);
    }
    case hses::kManagementTime:
      return Padded("", 16 + 12);
    case hses::kSystemInfo:
      if (instance != kRobot) return std::nullopt;
      return Padded("", 24) + Padded(controller_.model().name, 16) + Padded("", 8);
    case hses::kPosition:
      return PositionData(instance);
    default:
      break;
  }
  if (instance != 1) return std::nullopt;
  switch (command) {
    case hses::kStatus:
      return StatusData();
    case hses::kExecutingJob:
      return hses::Encode(hses::Job{controller_.job(), controller_.running() ? 5u : 0u, 0, 100});
    case hses::kAxisNames: {
      std::string names;
      for (const char* name : {"S", "L", "U", "R", "B", "T"}) names += Padded(name, 4);
      return Padded(names, 4 * kAxes);
    }
    case hses::kPositionError: {
      std::vector<std::int32_t> pulses(kAxes, 0);
      const ServoState servo = controller_.servo();
      const JointVector off = servo.q_commanded - servo.q;
      for (int i = 0; i < kNumJoints; ++i) {
        pulses[i] = static_cast<std::int32_t>(std::lround(off[i] * controller_.pulses_per_rad()));
      }
      return Words(pulses);
    }
    default:  // Torque: unknown here.
      return Words(std::vector<std::int32_t>(kAxes, 0));
  }
}

void HsesResponder::Read(const Request& request, Answer& answer) const {
  const auto slice = SliceOf(request, hses::kGetAll, hses::kGetOne, SizesOf(request.command));
  if (!slice) return RefuseHses(answer, hses::kNoAttribute);
  const std::optional<std::string> whole = Whole(request.command, request.instance);
  if (!whole) return RefuseHses(answer, hses::kNoInstance);
  answer.data = whole->substr(slice->at, slice->size);
}

void HsesResponder::Control(const Request& request, Answer& answer) {
  if (!SliceOf(request, hses::kSetAll, hses::kSetOne, {4})) {
    return RefuseHses(answer, hses::kNoAttribute);
  }
  constexpr std::size_t kTextSize = 32;
  if (request.command == hses::kPendantText) {
    if (request.data.size() > kTextSize) RefuseHses(answer, hses::kDataSize);
    return;
  }
  const auto word = hses::DecodeValue(hses::kVariableD, request.data);
  if (!std::holds_alternative<hses::Value>(word) || request.data.size() != 4) {
    return RefuseHses(answer, hses::kDataSize);
  }
  const auto value =
      static_cast<std::uint32_t>(std::get<std::int32_t>(std::get<hses::Value>(word)));
  if (!controller_.remote()) return RefuseHses(answer, hses::kNotRemote);
  constexpr std::uint16_t kCycleInstance = 2;
  switch (request.command) {
    case hses::kReset:
      if (request.instance != hses::kResetAlarm && request.instance != hses::kCancelError) {
        return RefuseHses(answer, hses::kNoInstance);
      }
      if (value != 1) return RefuseHses(answer, hses::kOutOfRange);
      if (request.instance == hses::kResetAlarm) controller_.ResetAlarm();
      if (controller_.alarm() != 0) RefuseHses(answer, hses::kInAlarm);
      return;
    case hses::kPower:
      return Power(request, value, answer);
    case hses::kCycle:
      if (request.instance != kCycleInstance) return RefuseHses(answer, hses::kNoInstance);
      if (value < 1 || value > 3) return RefuseHses(answer, hses::kOutOfRange);
      cycle_ = value;
      return;
    default:
      if (request.instance != 1) return RefuseHses(answer, hses::kNoInstance);
      if (value != 1) return RefuseHses(answer, hses::kOutOfRange);
      return Start(answer);
  }
}

void HsesResponder::Power(const Request& request, std::uint32_t value, Answer& answer) {
  constexpr std::uint16_t kPendantLock = 3;
  if (value != hses::kOn && value != hses::kOff) return RefuseHses(answer, hses::kOutOfRange);
  switch (request.instance) {
    case hses::kHold:
      return controller_.SetHold(value == hses::kOn);
    case hses::kServo:
      if (!controller_.SwitchServo(value == hses::kOn)) RefuseHses(answer, hses::kServoFails);
      return;
    case kPendantLock:
      return;
    default:
      return RefuseHses(answer, hses::kNoInstance);
  }
}

void HsesResponder::Start(Answer& answer) {
  if (controller_.running()) return RefuseHses(answer, hses::kMoving);
  if (controller_.held()) return RefuseHses(answer, hses::kHeldByCommand);
  if (controller_.alarm() != 0) return RefuseHses(answer, hses::kInAlarm);
  if (!controller_.servo_on()) return RefuseHses(answer, hses::kServoOff);
  if (!controller_.StartJob()) RefuseHses(answer, hses::kWrongMode);
}

void HsesResponder::SelectJob(const Request& request, Answer& answer) {
  constexpr std::size_t kName = 32, kLine = 4;
  constexpr std::uint16_t kFirstMaster = 10, kLastMaster = 15;
  const auto slice = SliceOf(request, hses::kSetAll, hses::kSetOne, {kName, kLine});
  if (!slice) return RefuseHses(answer, hses::kNoAttribute);
  const bool master = request.instance >= kFirstMaster && request.instance <= kLastMaster;
  if (request.instance != 1 && !master) return RefuseHses(answer, hses::kNoInstance);
  if (request.data.size() != slice->size) return RefuseHses(answer, hses::kDataSize);
  if (!controller_.remote()) return RefuseHses(answer, hses::kNotRemote);
  if (controller_.running()) return RefuseHses(answer, hses::kMoving);
  if (slice->at != 0) return;  // A line of the job that is selected.
  const std::string name(request.data.substr(0, std::min(kName, request.data.find('\0'))));
  if (std::count(jobs.begin(), jobs.end(), name) == 0) {
    return RefuseHses(answer, hses::kNoSuchJob);
  }
  controller_.SelectJob(name);
}

}  // namespace tubetwin

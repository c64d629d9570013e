#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "hw_bridge/codecs/decode_error.h"

/// Yaskawa's High-Speed Ethernet Server: one UDP datagram asks, one answers; robot control on port
/// 10040; little-endian.
namespace tubetwin::hses {

inline constexpr std::size_t kHeaderSize = 32;
inline constexpr std::size_t kMaxData = 479;

enum class Division : std::uint8_t { kRobot = 1, kFile = 2 };

// Commands of the robot control division.
inline constexpr std::uint16_t kAlarm = 0x70, kAlarmHistory = 0x71, kStatus = 0x72,
                               kExecutingJob = 0x73, kAxisNames = 0x74, kPosition = 0x75,
                               kPositionError = 0x76, kTorque = 0x77, kIoByte = 0x78,
                               kRegister = 0x79, kVariableB = 0x7A, kVariableI = 0x7B,
                               kVariableD = 0x7C, kVariableR = 0x7D, kVariableS = 0x7E,
                               kVariableP = 0x7F, kVariableBp = 0x80, kVariableEx = 0x81,
                               kReset = 0x82, kPower = 0x83, kCycle = 0x84, kPendantText = 0x85,
                               kStartJob = 0x86, kSelectJob = 0x87, kManagementTime = 0x88,
                               kSystemInfo = 0x89, kMoveCartesian = 0x8A, kMovePulse = 0x8B,
                               kVariableS32 = 0x8C;
/// Several of kIoByte, kRegister, kVariableB to kVariableEx at once: kPluralIo + n; of
/// kVariableS32.
inline constexpr std::uint16_t kPluralIo = 0x300, kPluralEx = 0x309, kPluralS32 = 0x30C;
/// kAlarm and kAlarmHistory with the texts of their sub-codes.
inline constexpr std::uint16_t kAlarmTexts = 0x30A, kAlarmHistoryTexts = 0x30B;

// Services.
inline constexpr std::uint8_t kGetAll = 0x01, kSetAll = 0x02, kGetOne = 0x0E, kSetOne = 0x10,
                              kReadPlural = 0x33, kWritePlural = 0x34;

// Instances: of kPosition, of kReset, of kPower, of moves.
inline constexpr std::uint16_t kPulses = 1, kCartesian = 101;
inline constexpr std::uint16_t kResetAlarm = 1, kCancelError = 2;
inline constexpr std::uint16_t kHold = 1, kServo = 2;
inline constexpr std::uint16_t kJointAbsolute = 1, kStraightAbsolute = 2, kStraightIncrement = 3;

// Status of an answer.
inline constexpr std::uint8_t kOk = 0x00, kCommandUndefined = 0x08, kBadElement = 0x09,
                              kRefused = 0x1F, kInstanceMissing = 0x28;

// Added status of kRefused.
inline constexpr std::uint16_t kMoving = 0x2010, kHeldByPendant = 0x2020, kHeldByPanel = 0x2030,
                               kHeldExternally = 0x2040, kHeldByCommand = 0x2050, kInAlarm = 0x2060,
                               kServoOff = 0x2070, kWrongMode = 0x2080, kNotRemote = 0x2100,
                               kServoFails = 0x3450, kNoSuchJob = 0x4040, kNoCommand = 0xA000,
                               kNoInstance = 0xA001, kNoAttribute = 0xA002, kDataSize = 0xB003,
                               kOutOfRange = 0xB004, kWrongGroup = 0xB008, kWrongSpeed = 0xB009;

struct Request {
  Division division = Division::kRobot;
  std::uint8_t ack = 0;  ///< 1: data or acknowledgement of a file transfer.
  std::uint8_t id = 0;   ///< Echoed.
  std::uint32_t block = 0;
  std::uint16_t command = 0, instance = 0;
  std::uint8_t attribute = 0, service = kGetAll;
  std::string data;
  bool operator==(const Request&) const = default;
};

struct Answer {
  Division division = Division::kRobot;
  std::uint8_t id = 0;
  std::uint32_t block = 0x80000000;
  std::uint8_t service = kGetAll;  ///< That of the request, without its highest bit.
  std::uint8_t status = kOk;
  std::uint8_t added_words = 0;  ///< 0 to 2.
  std::uint16_t added_status = 0;
  std::string data;
  bool operator==(const Answer&) const = default;
};

/// Precondition: at most kMaxData bytes of data.
std::string Encode(const Request& request);
std::string Encode(const Answer& answer);
/// One datagram each; whatever the bytes are: never throws.
std::variant<Request, DecodeError> DecodeRequest(std::string_view datagram);
std::variant<Answer, DecodeError> DecodeAnswer(std::string_view datagram);

/// "wrong mode (0x1f, 0x2080)"; "normal" for 0.
std::string StatusText(const Answer& answer);

// What the data hold, by command. Decoders fail when there are too few bytes; answers of newer
// controllers may be longer.

struct Status {
  std::uint32_t data1 = 0, data2 = 0;
  // data1
  static constexpr std::uint32_t kStep = 1u << 0, kOneCycle = 1u << 1, kContinuous = 1u << 2,
                                 kRunning = 1u << 3, kSpeedLimited = 1u << 4, kTeach = 1u << 5,
                                 kPlay = 1u << 6, kCommandRemote = 1u << 7;
  // data2
  static constexpr std::uint32_t kPendantHold = 1u << 1, kExternalHold = 1u << 2,
                                 kCommandHold = 1u << 3, kAlarm = 1u << 4, kError = 1u << 5,
                                 kServoOn = 1u << 6;
  bool operator==(const Status&) const = default;
};
std::string Encode(const Status& status);
std::variant<Status, DecodeError> DecodeStatus(std::string_view data);

struct Alarm {
  std::uint32_t code = 0, data = 0, type = 0;
  std::string time;  ///< "2026/01/31 12:00", at most 16 bytes.
  std::string name;  ///< At most 32 bytes.
  bool operator==(const Alarm&) const = default;
};
std::string Encode(const Alarm& alarm);
std::variant<Alarm, DecodeError> DecodeAlarm(std::string_view data);

struct Job {
  std::string name;  ///< At most 32 bytes.
  std::uint32_t line = 0, step = 0, speed_override = 0;
  bool operator==(const Job&) const = default;
};
std::string Encode(const Job& job);
std::variant<Job, DecodeError> DecodeJob(std::string_view data);

/// Of kPosition: encoder pulses of each axis, or X Y Z in 0.001 mm and Rx Ry Rz Re in 0.0001
/// degrees.
struct Position {
  std::uint32_t type = 0;  ///< 0 pulses, 16 base coordinates.
  std::uint32_t form = 0, tool = 0, user = 0, extended_form = 0;
  std::array<std::int32_t, 8> axes{};
  bool operator==(const Position&) const = default;
};
std::string Encode(const Position& position);
std::variant<Position, DecodeError> DecodePosition(std::string_view data);

/// Data of kMoveCartesian.
struct CartesianMove {
  std::uint32_t robot = 1, station = 0;
  std::uint32_t speed_class = 0;  ///< 0: 0.01 %, 1: 0.1 mm/s, 2: 0.1 degrees/s.
  std::uint32_t speed = 0;
  std::uint32_t coordinate = 17;       ///< 16 base, 17 robot, 18 user, 19 tool.
  std::array<std::int32_t, 7> pose{};  ///< X Y Z 0.001 mm, Rx Ry Rz Re 0.0001 degrees.
  std::uint32_t reserved = 0, form = 0, extended_form = 0, tool = 0, user = 0;
  std::array<std::int32_t, 9> stations{};
  bool operator==(const CartesianMove&) const = default;
};
std::string Encode(const CartesianMove& move);
std::variant<CartesianMove, DecodeError> DecodeCartesianMove(std::string_view data);

/// Data of kMovePulse.
struct PulseMove {
  std::uint32_t robot = 1, station = 0, speed_class = 0, speed = 0;
  std::array<std::int32_t, 7> pulses{};  ///< S L U R B T E.
  std::uint32_t reserved = 0, tool = 0;
  std::array<std::int32_t, 9> stations{};
  bool operator==(const PulseMove&) const = default;
};
std::string Encode(const PulseMove& move);
std::variant<PulseMove, DecodeError> DecodePulseMove(std::string_view data);

/// Value of a register (u16) or of a variable B (u8), I (i16), D (i32), R (f32) or S (16 bytes).
using Value =
    std::variant<std::uint8_t, std::int16_t, std::int32_t, float, std::uint16_t, std::string>;
std::string Encode(const Value& value);
/// `command`: kRegister, kVariableB to kVariableS or kIoByte; fails for others, too.
std::variant<Value, DecodeError> DecodeValue(std::uint16_t command, std::string_view data);

/// A data word: on and off of kPower, the 1 of kReset and kStartJob, the cycle of kCycle.
std::string Word(std::uint32_t value);
inline constexpr std::uint32_t kOn = 1, kOff = 2;

/// Data of kSelectJob.
std::string JobSelection(const std::string& name, std::uint32_t line);
std::variant<Job, DecodeError> DecodeJobSelection(std::string_view data);

}  // namespace tubetwin::hses

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "hw_bridge/codecs/decode_error.h"
#include "models/base/joint.h"

/// simple_message as MotoROS 1 speaks it on a YRC1000 over TCP: motion 50240, state 50241, I/O
/// 50242; little-endian words of 32 bits. One control group.
namespace tubetwin::simple_message {

enum class Comm : std::int32_t { kTopic = 1, kRequest = 2, kReply = 3 };
enum class ReplyCode : std::int32_t { kInvalid = 0, kSuccess = 1, kFailure = 2 };

/// One number per joint, S L U R B T first, then zeros.
inline constexpr int kSlots = 10;
using Slots = std::array<float, kSlots>;
/// NaN and infinity are passed on.
Slots ToSlots(const JointVector& joints);
JointVector ToJoints(const Slots& slots);

struct Ping {
  bool operator==(const Ping&) const = default;
};

/// Pushed on the state port. -1: unknown.
struct RobotStatus {
  std::int32_t drives_powered = 0;
  std::int32_t e_stopped = 0;
  std::int32_t error_code = 0;  ///< Alarm number.
  std::int32_t in_error = 0;
  std::int32_t in_motion = 0;
  std::int32_t mode = 2;  ///< kTeach or kPlay.
  std::int32_t motion_possible = 0;
  static constexpr std::int32_t kTeach = 1, kPlay = 2;
  bool operator==(const RobotStatus&) const = default;
};

// Bits of valid_fields.
inline constexpr std::int32_t kTime = 1, kPosition = 2, kVelocity = 4, kAcceleration = 8;

/// A point of a streamed trajectory.
struct JointPoint {
  std::int32_t group = 0;
  std::int32_t sequence = 0;  ///< 0: the first.
  std::int32_t valid_fields = kTime | kPosition | kVelocity;
  float time_s = 0;  ///< From the trajectory's start.
  Slots q_rad{}, qd_rad_s{}, qdd_rad_s2{};
  bool operator==(const JointPoint&) const = default;
};

/// One group's part of a point for several of them.
struct GroupPoint {
  std::int32_t group = 0;
  std::int32_t valid_fields = kTime | kPosition | kVelocity;
  float time_s = 0;
  Slots q_rad{}, qd_rad_s{}, qdd_rad_s2{};
  bool operator==(const GroupPoint&) const = default;
};
inline constexpr int kGroups = 4;

/// A point of up to four groups. Clients may leave out the groups that are not there.
struct JointPointEx {
  std::int32_t groups = 1;
  std::int32_t sequence = 0;
  std::array<GroupPoint, kGroups> points{};
  bool operator==(const JointPointEx&) const = default;
};

/// Asks for the arm's geometry.
struct GetDhParameters {
  bool operator==(const GetDhParameters&) const = default;
};
/// Theta, d, a, alpha of 8 links of each of four groups.
struct DhParameters {
  static constexpr int kLinks = 8, kNumbers = 4;
  std::array<float, kGroups * kLinks * kNumbers> values{};
  bool operator==(const DhParameters&) const = default;
};

/// Pushed on the state port.
struct JointFeedback {
  std::int32_t group = 0;
  std::int32_t valid_fields = kPosition | kVelocity;
  float time_s = 0;
  Slots q_rad{}, qd_rad_s{}, qdd_rad_s2{};
  bool operator==(const JointFeedback&) const = default;
};

/// What MotionControl asks for.
enum class Command : std::int32_t {
  kCheckMotionReady = 200101,
  kCheckQueueCount = 200102,
  kStopMotion = 200111,
  kStartServos = 200112,
  kStopServos = 200113,
  kResetAlarm = 200114,
  kStartTrajectoryMode = 200121,
  kStopTrajectoryMode = 200122,
  kDisconnect = 200130,
};

struct MotionControl {
  std::int32_t group = 0;
  std::int32_t sequence = 0;  ///< Echoed.
  Command command = Command::kCheckMotionReady;
  Slots data{};
  bool operator==(const MotionControl&) const = default;
};

enum class Result : std::int32_t {
  kSuccess = 0,
  kBusy = 1,
  kFailure = 2,
  kInvalid = 3,
  kAlarm = 4,
  kNotReady = 5,
  kMotoPlusFailure = 6,
};

/// Why, beside Result::kInvalid.
enum class Invalid : std::int32_t {
  kUnspecified = 3000,
  kMessageSize = 3001,
  kHeader = 3002,
  kMessageType = 3003,
  kGroup = 3004,
  kSequence = 3005,
  kCommand = 3006,
  kData = 3010,
  kStartPosition = 3011,
  kPosition = 3012,
  kSpeed = 3013,
  kAcceleration = 3014,
  kInsufficient = 3015,
  kTime = 3016,
  kTool = 3017,
};

/// Why, beside Result::kNotReady, or Result::kFailure of kCheckMotionReady.
enum class NotReady : std::int32_t {
  kUnspecified = 5000,
  kAlarm = 5001,
  kError = 5002,
  kEmergencyStop = 5003,
  kNotPlay = 5004,
  kNotRemote = 5005,
  kServoOff = 5006,
  kHold = 5007,
  kNotStarted = 5008,
  kWaiting = 5009,  ///< The job is not at its WAIT.
  kSkillSend = 5010,
  kContactStop = 5011,  ///< Power and force limiting is active.
  kIncrementMove = 5012,
};

/// "start position (3011)", "12345" for what is not known.
std::string SubcodeText(std::int32_t subcode);
std::string ToString(Result result);

/// The one answer to each motion request.
struct MotionReply {
  std::int32_t group = 0;
  std::int32_t sequence = 0;
  std::int32_t command = 0;  ///< Or the message id that is answered: 14, 2018.
  Result result = Result::kSuccess;
  std::int32_t subcode = 0;  ///< Of kCheckQueueCount: increments in the queue.
  Slots data{};
  bool operator==(const MotionReply&) const = default;
};

struct SelectTool {
  std::int32_t group = 0;
  std::int32_t tool = 0;  ///< 0 to 63.
  std::int32_t sequence = 0;
  bool operator==(const SelectTool&) const = default;
};

// I/O port. Results: 0, 1001 read address, 1002 write address, 1003 write value, 1004 and 1005 the
// controller's own failures. Bit addresses end in 0 to 7; a group's address is a bit's / 10.
inline constexpr std::int32_t kIoReadAddress = 1001, kIoWriteAddress = 1002, kIoWriteValue = 1003,
                              kIoReadFailure = 1004, kIoWriteFailure = 1005;

struct ReadBit {
  std::int32_t address = 0;
  bool operator==(const ReadBit&) const = default;
};
struct ReadBitReply {
  std::int32_t value = 0, result = 0;
  bool operator==(const ReadBitReply&) const = default;
};
struct WriteBit {
  std::int32_t address = 0, value = 0;
  bool operator==(const WriteBit&) const = default;
};
struct WriteBitReply {
  std::int32_t result = 0;
  bool operator==(const WriteBitReply&) const = default;
};
struct ReadGroup {
  std::int32_t address = 0;
  bool operator==(const ReadGroup&) const = default;
};
struct ReadGroupReply {
  std::int32_t value = 0, result = 0;
  bool operator==(const ReadGroupReply&) const = default;
};
struct WriteGroup {
  std::int32_t address = 0, value = 0;
  bool operator==(const WriteGroup&) const = default;
};
struct WriteGroupReply {
  std::int32_t result = 0;
  bool operator==(const WriteGroupReply&) const = default;
};
struct ReadRegister {  ///< M registers 0 to 999, or 1000000 to 1000999.
  std::int32_t address = 0;
  bool operator==(const ReadRegister&) const = default;
};
struct ReadRegisterReply {
  std::int32_t value = 0, result = 0;
  bool operator==(const ReadRegisterReply&) const = default;
};
struct WriteRegister {
  std::int32_t address = 0, value = 0;
  bool operator==(const WriteRegister&) const = default;
};
struct WriteRegisterReply {
  std::int32_t result = 0;
  bool operator==(const WriteRegisterReply&) const = default;
};

using Body =
    std::variant<Ping, RobotStatus, JointPoint, JointFeedback, MotionControl, MotionReply,
                 SelectTool, ReadBit, ReadBitReply, WriteBit, WriteBitReply, ReadGroup,
                 ReadGroupReply, WriteGroup, WriteGroupReply, ReadRegister, ReadRegisterReply,
                 WriteRegister, WriteRegisterReply, JointPointEx, GetDhParameters, DhParameters>;

struct Message {
  Comm comm = Comm::kRequest;
  ReplyCode reply = ReplyCode::kInvalid;
  Body body;
  bool operator==(const Message&) const = default;
};
inline Message Topic(const Body& body) { return {Comm::kTopic, ReplyCode::kInvalid, body}; }
inline Message Request(const Body& body) { return {Comm::kRequest, ReplyCode::kInvalid, body}; }
inline Message Reply(const Body& body) { return {Comm::kReply, ReplyCode::kSuccess, body}; }

/// The message with its length before it.
std::string Encode(const Message& message);

/// Length and header together: what a receiver needs to know a message's size.
inline constexpr std::size_t kHeadSize = 16;
/// Of any message that is known.
inline constexpr std::size_t kLargestMessage = 552;

/// Size in bytes, length included, of a message of that id; registers have one id for request and
/// reply. Nothing when the id is unknown.
std::optional<std::size_t> MessageSize(std::int32_t id, Comm comm);

/// Why the bytes do not begin with a message, as the controller tells it apart.
struct NoMessage {
  enum class Kind {
    kIncomplete,  ///< Fewer bytes than the head, or than a message of that id.
    kUnknownId,
    kComm,    ///< No comm type, or not one for that id.
    kLength,  ///< The length before it is another than that of the id.
  } kind = Kind::kIncomplete;
  std::int32_t id = 0;  ///< 0 when even that is missing.
  std::string reason;
};

/// The message that `bytes` begin with; its size is MessageSize. Whatever the bytes are: never
/// throws. `use_length` false: the length before it is not looked at.
std::variant<Message, NoMessage> DecodeFront(std::string_view bytes, bool use_length);

/// A request and how many bytes it has.
struct FrontRequest {
  Message message;
  std::size_t size = 0;
};
/// The request that `bytes` begin with, as a controller reads it: by its id alone. Neither the
/// length before it nor comm type and reply code are looked at; a JointPointEx has as many groups
/// as it says. Whatever the bytes are: never throws.
std::variant<FrontRequest, NoMessage> DecodeRequestFront(std::string_view bytes);

/// A client's side of a TCP stream: bytes come in any pieces, messages go out. After an error the
/// stream has lost its place and yields nothing more.
class StreamReader {
 public:
  /// Precondition: Next() has been called until it gave nothing; so at most one message waits.
  void Append(std::string_view bytes);
  /// The next whole message, the error that ends the stream (once), or nothing yet.
  std::optional<std::variant<Message, DecodeError>> Next();

 private:
  std::string buffer_;
  bool broken_ = false;
};

}  // namespace tubetwin::simple_message

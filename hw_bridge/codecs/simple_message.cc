#include "hw_bridge/codecs/simple_message.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "hw_bridge/codecs/little_endian.h"

namespace tubetwin::simple_message {
namespace {

// Each body lists its fields once; writing, reading and the size all go through that list.
void Visit(auto&, Ping&) {}
void Visit(auto& v, RobotStatus& b) {
  v(b.drives_powered, b.e_stopped, b.error_code, b.in_error, b.in_motion, b.mode,
    b.motion_possible);
}
void Visit(auto& v, JointPoint& b) {
  v(b.group, b.sequence, b.valid_fields, b.time_s, b.q_rad, b.qd_rad_s, b.qdd_rad_s2);
}
void Visit(auto& v, JointFeedback& b) {
  v(b.group, b.valid_fields, b.time_s, b.q_rad, b.qd_rad_s, b.qdd_rad_s2);
}
void Visit(auto& v, MotionControl& b) { v(b.group, b.sequence, b.command, b.data); }
void Visit(auto& v, MotionReply& b) {
  v(b.group, b.sequence, b.command, b.result, b.subcode, b.data);
}
void Visit(auto& v, SelectTool& b) { v(b.group, b.tool, b.sequence); }
void Visit(auto& v, ReadBit& b) { v(b.address); }
void Visit(auto& v, ReadBitReply& b) { v(b.value, b.result); }
void Visit(auto& v, WriteBit& b) { v(b.address, b.value); }
void Visit(auto& v, WriteBitReply& b) { v(b.result); }
void Visit(auto& v, ReadGroup& b) { v(b.address); }
void Visit(auto& v, ReadGroupReply& b) { v(b.value, b.result); }
void Visit(auto& v, WriteGroup& b) { v(b.address, b.value); }
void Visit(auto& v, WriteGroupReply& b) { v(b.result); }
void Visit(auto& v, ReadRegister& b) { v(b.address); }
void Visit(auto& v, ReadRegisterReply& b) { v(b.value, b.result); }
void Visit(auto& v, WriteRegister& b) { v(b.address, b.value); }
void Visit(auto& v, WriteRegisterReply& b) { v(b.result); }
void Visit(auto& v, JointPointEx& b) { v(b.groups, b.sequence, b.points); }
void Visit(auto&, GetDhParameters&) {}
void Visit(auto& v, DhParameters& b) { v(b.values); }

struct Writer {
  std::string& out;

  void One(std::int32_t value) { PutLe32(out, static_cast<std::uint32_t>(value)); }
  void One(float value) { PutLeFloat(out, value); }
  template <typename T, std::size_t N>
  void One(const std::array<T, N>& values) {
    for (const T& value : values) One(value);
  }
  void One(const GroupPoint& point) {
    One(point.group);
    One(point.valid_fields);
    One(point.time_s);
    for (const Slots* slots : {&point.q_rad, &point.qd_rad_s, &point.qdd_rad_s2}) One(*slots);
  }
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void One(Enum value) { One(static_cast<std::int32_t>(value)); }
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (One(fields), ...);
  }
};

struct Reader {
  std::string_view bytes;
  std::size_t at = 0;

  std::size_t Step() { return std::exchange(at, at + 4); }
  void One(std::int32_t& value) { value = LeInt32At(bytes, Step()); }
  void One(float& value) { value = LeFloatAt(bytes, Step()); }
  template <typename T, std::size_t N>
  void One(std::array<T, N>& values) {
    for (T& value : values) One(value);
  }
  void One(GroupPoint& point) {
    One(point.group);
    One(point.valid_fields);
    One(point.time_s);
    for (Slots* slots : {&point.q_rad, &point.qd_rad_s, &point.qdd_rad_s2}) One(*slots);
  }
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void One(Enum& value) { value = static_cast<Enum>(LeInt32At(bytes, Step())); }
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (One(fields), ...);
  }
};

struct Size {
  std::size_t bytes = 0;
  template <typename... Fields>
  void operator()(Fields&...) {
    ((bytes += sizeof(Fields)), ...);
  }
};

struct Kind {
  std::int32_t id;
  Comm first, second;  ///< Comm types that may carry it.
  Body empty;
};

const std::array<Kind, std::variant_size_v<Body>>& Kinds() {
  static const std::array<Kind, std::variant_size_v<Body>> kinds = {{
      {1, Comm::kRequest, Comm::kReply, Ping{}},
      {13, Comm::kTopic, Comm::kTopic, RobotStatus{}},
      {14, Comm::kRequest, Comm::kTopic, JointPoint{}},
      {15, Comm::kTopic, Comm::kTopic, JointFeedback{}},
      {2001, Comm::kRequest, Comm::kRequest, MotionControl{}},
      {2002, Comm::kReply, Comm::kReply, MotionReply{}},
      {2018, Comm::kRequest, Comm::kRequest, SelectTool{}},
      {2003, Comm::kRequest, Comm::kRequest, ReadBit{}},
      {2004, Comm::kReply, Comm::kReply, ReadBitReply{}},
      {2005, Comm::kRequest, Comm::kRequest, WriteBit{}},
      {2006, Comm::kReply, Comm::kReply, WriteBitReply{}},
      {2007, Comm::kRequest, Comm::kRequest, ReadGroup{}},
      {2008, Comm::kReply, Comm::kReply, ReadGroupReply{}},
      {2009, Comm::kRequest, Comm::kRequest, WriteGroup{}},
      {2010, Comm::kReply, Comm::kReply, WriteGroupReply{}},
      {2012, Comm::kRequest, Comm::kRequest, ReadRegister{}},
      {2012, Comm::kReply, Comm::kReply, ReadRegisterReply{}},
      {2013, Comm::kRequest, Comm::kRequest, WriteRegister{}},
      {2013, Comm::kReply, Comm::kReply, WriteRegisterReply{}},
      {2016, Comm::kRequest, Comm::kRequest, JointPointEx{}},
      {2020, Comm::kRequest, Comm::kRequest, GetDhParameters{}},
      {2020, Comm::kReply, Comm::kReply, DhParameters{}},
  }};
  return kinds;
}

std::size_t SizeOf(const Kind& kind) {
  Size size;
  std::visit([&size](auto body) { Visit(size, body); }, kind.empty);
  return kHeadSize + size.bytes;
}

bool Carries(const Kind& kind, Comm comm) { return kind.first == comm || kind.second == comm; }

const Kind* Find(std::int32_t id, Comm comm) {
  for (const Kind& kind : Kinds()) {
    if (kind.id == id && Carries(kind, comm)) return &kind;
  }
  return nullptr;
}

bool IsKnown(std::int32_t id) {
  for (const Kind& kind : Kinds()) {
    if (kind.id == id) return true;
  }
  return false;
}

}  // namespace

Slots ToSlots(const JointVector& joints) {
  Slots slots{};
  for (int i = 0; i < kNumJoints; ++i) slots[i] = static_cast<float>(joints[i]);
  return slots;
}

JointVector ToJoints(const Slots& slots) {
  JointVector joints;
  for (int i = 0; i < kNumJoints; ++i) joints[i] = slots[i];
  return joints;
}

std::string Encode(const Message& message) {
  const Kind& kind = Kinds()[message.body.index()];
  std::string out;
  Writer writer{out};
  writer.One(static_cast<std::int32_t>(SizeOf(kind) - 4));
  writer.One(kind.id);
  writer.One(message.comm);
  writer.One(message.reply);
  std::visit([&writer](auto body) { Visit(writer, body); }, message.body);
  return out;
}

std::optional<std::size_t> MessageSize(std::int32_t id, Comm comm) {
  const Kind* const kind = Find(id, comm);
  if (kind == nullptr) return std::nullopt;
  return SizeOf(*kind);
}

std::variant<Message, NoMessage> DecodeFront(std::string_view bytes, bool use_length) {
  if (bytes.size() < kHeadSize) {
    const std::int32_t id = bytes.size() >= 8 ? LeInt32At(bytes, 4) : 0;
    return NoMessage{NoMessage::Kind::kIncomplete, id,
                     std::to_string(bytes.size()) + " bytes, a head has 16"};
  }
  const std::int32_t length = LeInt32At(bytes, 0), id = LeInt32At(bytes, 4);
  const std::int32_t comm = LeInt32At(bytes, 8), reply = LeInt32At(bytes, 12);
  if (!IsKnown(id)) {
    return NoMessage{NoMessage::Kind::kUnknownId, id, "message id " + std::to_string(id)};
  }
  const Kind* const kind = Find(id, static_cast<Comm>(comm));
  if (kind == nullptr || reply < 0 || reply > 2) {
    return NoMessage{NoMessage::Kind::kComm, id,
                     "comm type " + std::to_string(comm) + ", reply code " + std::to_string(reply) +
                         " of message id " + std::to_string(id)};
  }
  const std::size_t size = SizeOf(*kind);
  if (use_length && (length < 0 || static_cast<std::size_t>(length) != size - 4)) {
    return NoMessage{NoMessage::Kind::kLength, id,
                     "length " + std::to_string(length) + " of message id " + std::to_string(id) +
                         ", which has " + std::to_string(size - 4)};
  }
  if (bytes.size() < size) {
    return NoMessage{NoMessage::Kind::kIncomplete, id,
                     std::to_string(bytes.size()) + " bytes of message id " + std::to_string(id) +
                         ", which has " + std::to_string(size)};
  }
  Message message{static_cast<Comm>(comm), static_cast<ReplyCode>(reply), kind->empty};
  Reader reader{bytes, kHeadSize};
  std::visit([&reader](auto& body) { Visit(reader, body); }, message.body);
  return message;
}

namespace {

constexpr std::int32_t kPointExId = 2016;
constexpr std::size_t kGroupPointSize = 132;

/// Of the groups that it says to have; nothing for what no controller can hold.
std::optional<std::size_t> PointExSize(std::string_view bytes) {
  constexpr std::size_t kCounts = 8;
  if (bytes.size() < kHeadSize + 4) return kLargestMessage;
  const std::int32_t groups = LeInt32At(bytes, kHeadSize);
  if (groups > kGroups) return std::nullopt;
  return kHeadSize + kCounts + kGroupPointSize * static_cast<std::size_t>(std::max(0, groups));
}

const Kind* FindRequest(std::int32_t id) {
  for (const Kind& kind : Kinds()) {
    if (kind.id == id) return &kind;  // Requests come first.
  }
  return nullptr;
}

}  // namespace

std::variant<FrontRequest, NoMessage> DecodeRequestFront(std::string_view bytes) {
  const std::int32_t id = bytes.size() >= 8 ? LeInt32At(bytes, 4) : 0;
  const auto incomplete = [&] {
    return NoMessage{NoMessage::Kind::kIncomplete, id,
                     std::to_string(bytes.size()) + " bytes of message id " + std::to_string(id)};
  };
  if (bytes.size() < kHeadSize) return incomplete();
  const Kind* const kind = FindRequest(id);
  if (kind == nullptr) {
    return NoMessage{NoMessage::Kind::kUnknownId, id, "message id " + std::to_string(id)};
  }
  const std::optional<std::size_t> size =
      id == kPointExId ? PointExSize(bytes) : std::optional(SizeOf(*kind));
  if (!size || bytes.size() < *size) return incomplete();
  std::string whole(bytes.substr(0, *size));
  whole.resize(std::max(whole.size(), SizeOf(*kind)), '\0');
  FrontRequest front{{static_cast<Comm>(LeInt32At(bytes, 8)),
                      static_cast<ReplyCode>(LeInt32At(bytes, 12)), kind->empty},
                     *size};
  Reader reader{whole, kHeadSize};
  std::visit([&reader](auto& body) { Visit(reader, body); }, front.message.body);
  return front;
}

void StreamReader::Append(std::string_view bytes) {
  if (!broken_) buffer_.append(bytes);
}

std::optional<std::variant<Message, DecodeError>> StreamReader::Next() {
  if (broken_) return std::nullopt;
  std::variant<Message, NoMessage> front = DecodeFront(buffer_, true);
  if (auto* message = std::get_if<Message>(&front)) {
    buffer_.erase(0, 4 + Le32At(buffer_, 0));
    return std::move(*message);
  }
  const NoMessage& none = std::get<NoMessage>(front);
  if (none.kind == NoMessage::Kind::kIncomplete) return std::nullopt;
  broken_ = true;
  buffer_.clear();
  return DecodeError{none.reason};
}

namespace {

const char* InvalidText(Invalid code) {
  switch (code) {
    case Invalid::kUnspecified:
      return "invalid";
    case Invalid::kMessageSize:
      return "message size";
    case Invalid::kHeader:
      return "header";
    case Invalid::kMessageType:
      return "message type";
    case Invalid::kGroup:
      return "group number";
    case Invalid::kSequence:
      return "sequence";
    case Invalid::kCommand:
      return "command";
    case Invalid::kData:
      return "data";
    case Invalid::kStartPosition:
      return "start position";
    case Invalid::kPosition:
      return "position";
    case Invalid::kSpeed:
      return "speed";
    case Invalid::kAcceleration:
      return "acceleration";
    case Invalid::kInsufficient:
      return "insufficient data";
    case Invalid::kTime:
      return "time";
    case Invalid::kTool:
      return "tool number";
  }
  return nullptr;
}

const char* NotReadyText(NotReady code) {
  switch (code) {
    case NotReady::kUnspecified:
      return "not ready";
    case NotReady::kAlarm:
      return "alarm";
    case NotReady::kError:
      return "error";
    case NotReady::kEmergencyStop:
      return "emergency stop";
    case NotReady::kNotPlay:
      return "not in PLAY mode";
    case NotReady::kNotRemote:
      return "not in REMOTE mode";
    case NotReady::kServoOff:
      return "servo off";
    case NotReady::kHold:
      return "hold";
    case NotReady::kNotStarted:
      return "job not started";
    case NotReady::kWaiting:
      return "job does not wait for motion";
    case NotReady::kSkillSend:
      return "skill send";
    case NotReady::kContactStop:
      return "contact stop";
    case NotReady::kIncrementMove:
      return "increment move error";
  }
  return nullptr;
}

}  // namespace

std::string SubcodeText(std::int32_t subcode) {
  const char* text = InvalidText(static_cast<Invalid>(subcode));
  if (text == nullptr) text = NotReadyText(static_cast<NotReady>(subcode));
  if (text == nullptr) return std::to_string(subcode);
  return std::string(text) + " (" + std::to_string(subcode) + ")";
}

std::string ToString(Result result) {
  switch (result) {
    case Result::kSuccess:
      return "success";
    case Result::kBusy:
      return "busy";
    case Result::kFailure:
      return "failure";
    case Result::kInvalid:
      return "invalid";
    case Result::kAlarm:
      return "alarm";
    case Result::kNotReady:
      return "not ready";
    case Result::kMotoPlusFailure:
      return "MotoPlus failure";
  }
  return "result " + std::to_string(static_cast<std::int32_t>(result));
}

}  // namespace tubetwin::simple_message

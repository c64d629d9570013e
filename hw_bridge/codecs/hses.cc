#include "hw_bridge/codecs/hses.h"

#include <algorithm>
#include <cstdio>

#include "hw_bridge/codecs/little_endian.h"
#include "models/base/error.h"

namespace tubetwin::hses {
namespace {

constexpr std::string_view kIdentifier = "YERC";
constexpr std::string_view kReserved = "99999999";
constexpr std::size_t kNameSize = 32, kTimeSize = 16, kTextSize = 16;
constexpr std::uint8_t kAnswered = 0x80;

std::string Hex(unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", value);
  return text;
}

void PutText(std::string& out, const std::string& text, std::size_t size) {
  out.append(text, 0, size);
  out.append(size - std::min(size, text.size()), '\0');
}

std::string TextAt(std::string_view bytes, std::size_t at, std::size_t size) {
  const std::string_view field = bytes.substr(at, size);
  return std::string(field.substr(0, field.find('\0')));
}

struct Head {
  Division division;
  std::uint8_t ack, id;
  std::uint32_t block;
};

void PutHead(std::string& out, const Head& head, std::size_t data_size) {
  TT_CHECK(data_size <= kMaxData);
  out += kIdentifier;
  PutLe16(out, kHeaderSize);
  PutLe16(out, static_cast<unsigned>(data_size));
  PutLe8(out, 0x03);
  PutLe8(out, static_cast<unsigned>(head.division));
  PutLe8(out, head.ack);
  PutLe8(out, head.id);
  PutLe32(out, head.block);
  out += kReserved;
}

/// Everything before the sub-header; the sizes agree afterwards.
std::variant<Head, DecodeError> DecodeHead(std::string_view bytes) {
  if (bytes.size() < kHeaderSize) {
    return DecodeError{std::to_string(bytes.size()) + " bytes, a header has 32"};
  }
  if (bytes.substr(0, 4) != kIdentifier) return DecodeError{"does not begin with YERC"};
  if (Le16At(bytes, 4) != kHeaderSize) {
    return DecodeError{"header size " + std::to_string(Le16At(bytes, 4)) + ", 32 allowed"};
  }
  const std::size_t data = Le16At(bytes, 6);
  if (data > kMaxData || bytes.size() != kHeaderSize + data) {
    return DecodeError{"data size " + std::to_string(data) + " in a datagram of " +
                       std::to_string(bytes.size()) + " bytes"};
  }
  const std::uint8_t division = Le8At(bytes, 9);
  if (division != 1 && division != 2) {
    return DecodeError{"division " + std::to_string(division) + ", 1 or 2 allowed"};
  }
  return Head{static_cast<Division>(division), Le8At(bytes, 10), Le8At(bytes, 11),
              Le32At(bytes, 12)};
}

DecodeError TooShort(std::string_view data, std::size_t needed) {
  return {std::to_string(data.size()) + " bytes of data, " + std::to_string(needed) + " needed"};
}

/// Words of 32 bits one after another, of either sign.
struct Words {
  std::string_view data;
  std::size_t at = 0;
  void operator()(std::uint32_t& value) {
    value = Le32At(data, at);
    at += 4;
  }
  void operator()(std::int32_t& value) {
    value = LeInt32At(data, at);
    at += 4;
  }
};

struct PutWords {
  std::string& out;
  void operator()(const std::uint32_t& value) { PutLe32(out, value); }
  void operator()(const std::int32_t& value) { PutLe32(out, static_cast<std::uint32_t>(value)); }
};

template <typename Visitor, typename Move>
void VisitCartesian(Visitor& v, Move& m) {
  v(m.robot), v(m.station), v(m.speed_class), v(m.speed), v(m.coordinate);
  for (auto& value : m.pose) v(value);
  v(m.reserved), v(m.form), v(m.extended_form), v(m.tool), v(m.user);
  for (auto& value : m.stations) v(value);
}

template <typename Visitor, typename Move>
void VisitPulse(Visitor& v, Move& m) {
  v(m.robot), v(m.station), v(m.speed_class), v(m.speed);
  for (auto& value : m.pulses) v(value);
  v(m.reserved), v(m.tool);
  for (auto& value : m.stations) v(value);
}

template <typename Visitor, typename Where>
void VisitPosition(Visitor& v, Where& p) {
  v(p.type), v(p.form), v(p.tool), v(p.user), v(p.extended_form);
  for (auto& value : p.axes) v(value);
}

}  // namespace

std::string Encode(const Request& request) {
  std::string out;
  PutHead(out, {request.division, request.ack, request.id, request.block}, request.data.size());
  PutLe16(out, request.command);
  PutLe16(out, request.instance);
  PutLe8(out, request.attribute);
  PutLe8(out, request.service);
  PutLe16(out, 0);
  return out + request.data;
}

std::string Encode(const Answer& answer) {
  std::string out;
  PutHead(out, {answer.division, 1, answer.id, answer.block}, answer.data.size());
  PutLe8(out, answer.service | kAnswered);
  PutLe8(out, answer.status);
  PutLe8(out, answer.added_words);
  PutLe8(out, 0);
  PutLe16(out, answer.added_status);
  PutLe16(out, 0);
  return out + answer.data;
}

std::variant<Request, DecodeError> DecodeRequest(std::string_view datagram) {
  const std::variant<Head, DecodeError> head = DecodeHead(datagram);
  if (const auto* error = std::get_if<DecodeError>(&head)) return *error;
  const auto& [division, ack, id, block] = std::get<Head>(head);
  if (ack > 1) return DecodeError{"ACK " + std::to_string(ack) + ", 0 or 1 allowed"};
  return Request{division,
                 ack,
                 id,
                 block,
                 Le16At(datagram, 24),
                 Le16At(datagram, 26),
                 Le8At(datagram, 28),
                 Le8At(datagram, 29),
                 std::string(datagram.substr(kHeaderSize))};
}

std::variant<Answer, DecodeError> DecodeAnswer(std::string_view datagram) {
  const std::variant<Head, DecodeError> head = DecodeHead(datagram);
  if (const auto* error = std::get_if<DecodeError>(&head)) return *error;
  const auto& [division, ack, id, block] = std::get<Head>(head);
  const std::uint8_t service = Le8At(datagram, 24), words = Le8At(datagram, 26);
  if (ack != 1) return DecodeError{"ACK " + std::to_string(ack) + " of an answer, 1 allowed"};
  if ((service & kAnswered) == 0) return DecodeError{"service " + Hex(service) + " of an answer"};
  if (words > 2) return DecodeError{std::to_string(words) + " words of added status, 2 allowed"};
  return Answer{division,
                id,
                block,
                static_cast<std::uint8_t>(service & ~kAnswered),
                Le8At(datagram, 25),
                words,
                Le16At(datagram, 28),
                std::string(datagram.substr(kHeaderSize))};
}

std::string Encode(const Status& status) { return Word(status.data1) + Word(status.data2); }

std::variant<Status, DecodeError> DecodeStatus(std::string_view data) {
  if (data.size() < 8) return TooShort(data, 8);
  return Status{Le32At(data, 0), Le32At(data, 4)};
}

std::string Encode(const Alarm& alarm) {
  std::string out = Word(alarm.code) + Word(alarm.data) + Word(alarm.type);
  PutText(out, alarm.time, kTimeSize);
  PutText(out, alarm.name, kNameSize);
  return out;
}

std::variant<Alarm, DecodeError> DecodeAlarm(std::string_view data) {
  constexpr std::size_t kSize = 12 + kTimeSize + kNameSize;
  if (data.size() < kSize) return TooShort(data, kSize);
  return Alarm{Le32At(data, 0), Le32At(data, 4), Le32At(data, 8), TextAt(data, 12, kTimeSize),
               TextAt(data, 12 + kTimeSize, kNameSize)};
}

std::string Encode(const Job& job) {
  std::string out;
  PutText(out, job.name, kNameSize);
  return out + Word(job.line) + Word(job.step) + Word(job.speed_override);
}

std::variant<Job, DecodeError> DecodeJob(std::string_view data) {
  if (data.size() < kNameSize + 12) return TooShort(data, kNameSize + 12);
  return Job{TextAt(data, 0, kNameSize), Le32At(data, kNameSize), Le32At(data, kNameSize + 4),
             Le32At(data, kNameSize + 8)};
}

std::string Encode(const Position& position) {
  std::string out;
  PutWords put{out};
  VisitPosition(put, position);
  return out;
}

std::variant<Position, DecodeError> DecodePosition(std::string_view data) {
  // Seven or eight axes, by controller.
  constexpr std::size_t kMin = 4 * (5 + 7), kWhole = 4 * (5 + 8);
  if (data.size() < kMin) return TooShort(data, kMin);
  std::string padded(data);
  padded.resize(std::max(padded.size(), kWhole));
  Position position;
  Words words{padded};
  VisitPosition(words, position);
  return position;
}

std::string Encode(const CartesianMove& move) {
  std::string out;
  PutWords put{out};
  VisitCartesian(put, move);
  return out;
}

std::variant<CartesianMove, DecodeError> DecodeCartesianMove(std::string_view data) {
  if (data.size() < 104) return TooShort(data, 104);
  CartesianMove move;
  Words words{data};
  VisitCartesian(words, move);
  return move;
}

std::string Encode(const PulseMove& move) {
  std::string out;
  PutWords put{out};
  VisitPulse(put, move);
  return out;
}

std::variant<PulseMove, DecodeError> DecodePulseMove(std::string_view data) {
  if (data.size() < 88) return TooShort(data, 88);
  PulseMove move;
  Words words{data};
  VisitPulse(words, move);
  return move;
}

std::string Encode(const Value& value) {
  struct Writer {
    std::string out;
    void operator()(std::uint8_t v) { PutLe8(out, v); }
    void operator()(std::int16_t v) { PutLe16(out, static_cast<std::uint16_t>(v)); }
    void operator()(std::int32_t v) { PutLe32(out, static_cast<std::uint32_t>(v)); }
    void operator()(float v) { PutLeFloat(out, v); }
    void operator()(std::uint16_t v) { PutLe16(out, v); }
    void operator()(const std::string& v) { PutText(out, v, kTextSize); }
  } writer;
  std::visit(writer, value);
  return writer.out;
}

std::variant<Value, DecodeError> DecodeValue(std::uint16_t command, std::string_view data) {
  const auto known = [&](std::size_t size, auto read) -> std::variant<Value, DecodeError> {
    if (data.size() < size) return TooShort(data, size);
    return Value{read()};
  };
  switch (command) {
    case kIoByte:
    case kVariableB:
      return known(1, [&] { return Le8At(data, 0); });
    case kVariableI:
      return known(2, [&] { return static_cast<std::int16_t>(Le16At(data, 0)); });
    case kVariableD:
      return known(4, [&] { return LeInt32At(data, 0); });
    case kVariableR:
      return known(4, [&] { return LeFloatAt(data, 0); });
    case kRegister:
      return known(2, [&] { return Le16At(data, 0); });
    case kVariableS:
      return known(kTextSize, [&] { return TextAt(data, 0, kTextSize); });
    default:
      return DecodeError{"command " + Hex(command) + " has no value"};
  }
}

std::string Word(std::uint32_t value) {
  std::string out;
  PutLe32(out, value);
  return out;
}

std::string JobSelection(const std::string& name, std::uint32_t line) {
  std::string out;
  PutText(out, name, kNameSize);
  return out + Word(line);
}

std::variant<Job, DecodeError> DecodeJobSelection(std::string_view data) {
  if (data.size() < kNameSize + 4) return TooShort(data, kNameSize + 4);
  return Job{TextAt(data, 0, kNameSize), Le32At(data, kNameSize), 0, 0};
}

namespace {

const char* AddedText(std::uint16_t added) {
  switch (added) {
    case kMoving:
      return "the arm is moving";
    case kHeldByPendant:
      return "held by the pendant";
    case kHeldByPanel:
      return "held by the panel";
    case kHeldExternally:
      return "held externally";
    case kHeldByCommand:
      return "held by command";
    case kInAlarm:
      return "alarm or error";
    case kServoOff:
      return "servo off";
    case kWrongMode:
      return "wrong mode";
    case kNotRemote:
      return "command remote is not set";
    case kServoFails:
      return "servo cannot be turned on";
    case kNoSuchJob:
      return "no such job";
    case kNoCommand:
      return "undefined command";
    case kNoInstance:
      return "undefined instance";
    case kNoAttribute:
      return "undefined attribute";
    case kDataSize:
      return "data size";
    case kOutOfRange:
      return "value out of range";
    case kWrongGroup:
      return "control group";
    case kWrongSpeed:
      return "speed";
    default:
      return "refused";
  }
}

}  // namespace

std::string StatusText(const Answer& answer) {
  if (answer.status == kOk) return "normal";
  const std::string codes = " (" + Hex(answer.status) + ", " + Hex(answer.added_status) + ")";
  switch (answer.status) {
    case kRefused:
      return AddedText(answer.added_status) + codes;
    case kCommandUndefined:
      return "undefined command" + codes;
    case kBadElement:
      return "bad element number" + codes;
    case kInstanceMissing:
      return "no such instance" + codes;
    default:
      return "refused" + codes;
  }
}

}  // namespace tubetwin::hses

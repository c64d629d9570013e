#include <cstdio>
#include <cstdlib>

#include "hw_bridge/codecs/hses.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {
namespace {

using namespace hses;

[[noreturn]] void Die(const char* problem) {
  std::fprintf(stderr, "HSES: %s\n", problem);
  std::abort();
}

template <typename Decoded>
void RequireReason(const Decoded& decoded) {
  const auto* error = std::get_if<DecodeError>(&decoded);
  if (error != nullptr && error->reason.empty()) Die("no reason");
}

void TryData(std::uint16_t command, std::string_view data) {
  RequireReason(DecodeStatus(data));
  RequireReason(DecodeAlarm(data));
  RequireReason(DecodeJob(data));
  RequireReason(DecodePosition(data));
  RequireReason(DecodeCartesianMove(data));
  RequireReason(DecodePulseMove(data));
  RequireReason(DecodeJobSelection(data));
  RequireReason(DecodeValue(command, data));
}

}  // namespace

void TryBytes(std::string_view bytes) {
  const auto request = DecodeRequest(bytes);
  RequireReason(request);
  if (const auto* r = std::get_if<Request>(&request)) {
    TryData(r->command, r->data);
    const auto again = DecodeRequest(Encode(*r));
    if (!std::holds_alternative<Request>(again) || std::get<Request>(again) != *r) {
      Die("a request comes back as another");
    }
  }
  const auto answer = DecodeAnswer(bytes);
  RequireReason(answer);
  if (const auto* a = std::get_if<Answer>(&answer)) {
    TryData(a->added_status, a->data);
    if (StatusText(*a).empty()) Die("no status text");
    const auto again = DecodeAnswer(Encode(*a));
    if (!std::holds_alternative<Answer>(again) || std::get<Answer>(again) != *a) {
      Die("an answer comes back as another");
    }
  }
}

std::vector<std::string> ByteCorpus() {
  std::vector<std::string> out;
  const auto ask = [&out](std::uint16_t command, std::uint16_t instance, std::uint8_t attribute,
                          std::uint8_t service, const std::string& data) {
    out.push_back(Encode(Request{Division::kRobot, 0, static_cast<std::uint8_t>(out.size()), 0,
                                 command, instance, attribute, service, data}));
  };
  ask(kStatus, 1, 0, kGetAll, "");
  ask(kPower, kServo, 1, kSetOne, Word(kOn));
  ask(kMoveCartesian, kStraightAbsolute, 1, kSetAll, Encode(CartesianMove{}));
  ask(kMovePulse, kJointAbsolute, 1, kSetAll, Encode(PulseMove{}));
  ask(kSelectJob, 1, 0, kSetAll, JobSelection("INIT_ROS", 0));
  ask(kVariableS, 3, 1, kSetOne, Encode(Value(std::string("text"))));
  for (const std::string& data :
       {Encode(Status{0xc4, 0x40}), Encode(Alarm{4100, 1, 2, "2026/01/31 12:00", "OVERRUN"}),
        Encode(Job{"INIT_ROS", 3, 0, 100}), Encode(Position{}), std::string()}) {
    out.push_back(Encode(Answer{.data = data}));
  }
  out.push_back(Encode(Answer{.service = kSetOne,
                              .status = kRefused,
                              .added_words = 1,
                              .added_status = kWrongMode,
                              .data = {}}));
  return out;
}

}  // namespace tubetwin

// The gripper's registers: an action is the same after a round trip, a status is refused or the
// same after one.

#include <cstdio>
#include <cstdlib>

#include "hw_bridge/codecs/robotiq_registers.h"
#include "tests/fuzz/byte_target.h"
#include "tests/support/paper_scale.h"

namespace tubetwin {
namespace {

void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "gripper registers: %s\n", what);
  std::abort();
}

}  // namespace

void TryBytes(std::string_view bytes) {
  GripperRegisters words{};
  for (std::size_t i = 0; i < bytes.size() && i < 6; ++i) {
    words[i / 2] =
        static_cast<std::uint16_t>(words[i / 2] << 8 | static_cast<std::uint8_t>(bytes[i]));
  }
  const GripperAction action = DecodeGripperAction(words);
  Require(DecodeGripperAction(EncodeGripperAction(action)) == action, "another action");
  const auto decoded = DecodeGripperStatus(words);
  if (const auto* error = std::get_if<DecodeError>(&decoded)) {
    Require(!error->reason.empty(), "refused without a reason");
    return;
  }
  const GripperStatus status = std::get<GripperStatus>(decoded);
  const auto again = DecodeGripperStatus(EncodeGripperStatus(status));
  Require(std::holds_alternative<GripperStatus>(again) && std::get<GripperStatus>(again) == status,
          "another status");
  const GripperScale scale = PaperScale();
  const double opening_m = scale.OpeningOf(status.position);
  Require(opening_m >= 0.0 && opening_m <= scale.stroke_m, "an opening that no gripper has");
}

std::vector<std::string> ByteCorpus() {
  return {std::string("\x09\x00\x00\xff\xff\xff", 6), std::string("\xb9\x00\x05\xff\xbd\x00", 6),
          std::string("\x11\x00\x00\x00\x00\x00", 6)};
}

}  // namespace tubetwin

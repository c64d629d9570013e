#include <array>
#include <cmath>

#include "hw_bridge/recording/event_codec.h"
#include "hw_bridge/recording/event_tags.h"

namespace tubetwin {
namespace {

// Steps in which devices that are known report: encoders, speeds, counts of the sensor. Others are
// read as well, only longer.
constexpr double kAngleStep_rad = 1e-5, kSpeedStep_rad_s = 1e-4;
constexpr std::array<double, 6> kWrenchStep = {1.0 / 80.0,     1.0 / 80.0,     1.0 / 40.0,
                                               10.0 / 13333.0, 10.0 / 13333.0, 10.0 / 13333.0};

// Codes of a number; from kFirstStep on they count steps from what was expected.
constexpr std::uint64_t kPlain = 0, kNegativeZero = 1, kFirstStep = 2;
constexpr double kMaxSteps = 0x1p52;

}  // namespace

EventContext::EventContext() {
  for (NumberTrack& track : q) track = NumberTrack(kAngleStep_rad, true);
  for (NumberTrack& track : qd) track = NumberTrack(kSpeedStep_rad_s, false);
  for (std::size_t i = 0; i < wrench.size(); ++i) wrench[i] = NumberTrack(kWrenchStep[i], false);
}

std::int64_t NumberTrack::Expected() const { return linear_ ? 2 * steps_ - steps_before_ : steps_; }

void NumberTrack::Remember(double value) {
  last_ = value;
  steps_before_ = steps_;
  const double steps = value / step_;
  steps_ = std::abs(steps) < kMaxSteps ? std::llround(steps) : 0;
}

void NumberTrack::Write(double value, ByteWriter& out) {
  const double steps = value / step_;
  if (SameBits(value, -0.0)) {
    out.Varint(kNegativeZero);
  } else if (std::abs(steps) < kMaxSteps &&
             SameBits(static_cast<double>(std::llround(steps)) * step_, value)) {
    out.Varint(kFirstStep + ByteWriter::ZigZag(std::llround(steps) - Expected()));
  } else {
    out.Varint(kPlain);
    out.F64(value);
  }
  Remember(value);
}

double NumberTrack::Read(ByteReader& in) {
  const std::uint64_t code = in.Varint();
  double value = -0.0;
  if (code == kPlain) {
    value = in.F64();
  } else if (code != kNegativeZero) {
    const std::int64_t off = ByteReader::UnZigZag(code - kFirstStep);
    constexpr auto kFarthest = static_cast<std::int64_t>(8 * kMaxSteps);
    if (off < -kFarthest || off > kFarthest) in.Fail("a step too far");
    value = static_cast<double>(Expected() + off) * step_;
  }
  Remember(value);
  return value;
}

}  // namespace tubetwin

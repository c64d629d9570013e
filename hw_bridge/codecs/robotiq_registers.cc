#include "hw_bridge/codecs/robotiq_registers.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kOpenCount = 3.0, kClosedCount = 230.0;

unsigned Bit(bool set, int place) { return set ? 1u << place : 0u; }
bool HasBit(unsigned byte, int place) { return (byte >> place & 1u) != 0; }

unsigned High(std::uint16_t value) { return value >> 8; }
unsigned Low(std::uint16_t value) { return value & 0xffu; }
std::uint16_t Pair(unsigned high, unsigned low) {
  return static_cast<std::uint16_t>(high << 8 | low);
}

std::uint8_t ByteOf(double value, double low, double high) {
  const double share = (value - low) / (high - low);
  if (!(share > 0.0)) return 0;
  return static_cast<std::uint8_t>(std::lround(255.0 * std::min(share, 1.0)));
}

double FromByte(std::uint8_t byte, double low, double high) {
  return low + (high - low) * byte / 255.0;
}

}  // namespace

std::string GripperFaultText(int fault) {
  switch (fault) {
    case 0:
      return "";
    case kGripperFaultDelayed:
      return "action delayed until the activation is complete";
    case kGripperFaultNotActivated:
      return "not activated";
    case kGripperFaultHot:
      return "over-temperature";
    case kGripperFaultSilence:
      return "no communication for 1 s";
    case kGripperFaultVoltage:
      return "under-voltage";
    case kGripperFaultReleasing:
      return "automatic release is running";
    case kGripperFaultInternal:
      return "internal fault";
    case kGripperFaultActivation:
      return "activation failed";
    case kGripperFaultCurrent:
      return "over-current";
    case kGripperFaultReleased:
      return "automatic release is done";
    default:
      return "unknown fault " + std::to_string(fault);
  }
}

GripperRegisters EncodeGripperAction(const GripperAction& action) {
  const unsigned request = Bit(action.activate, 0) | Bit(action.go_to, 3) |
                           Bit(action.automatic_release, 4) | Bit(action.release_opens, 5);
  return {Pair(request, 0), Pair(0, action.position), Pair(action.speed, action.force)};
}

GripperAction DecodeGripperAction(const GripperRegisters& registers) {
  const unsigned request = High(registers[0]);
  GripperAction action;
  action.activate = HasBit(request, 0);
  action.go_to = HasBit(request, 3);
  action.automatic_release = HasBit(request, 4);
  action.release_opens = HasBit(request, 5);
  action.position = static_cast<std::uint8_t>(Low(registers[1]));
  action.speed = static_cast<std::uint8_t>(High(registers[2]));
  action.force = static_cast<std::uint8_t>(Low(registers[2]));
  return action;
}

GripperRegisters EncodeGripperStatus(const GripperStatus& status) {
  TT_CHECK(status.fault < 16 && status.controller_fault < 16);
  const unsigned state = Bit(status.activate, 0) | Bit(status.go_to, 3) |
                         static_cast<unsigned>(status.activation) << 4 |
                         static_cast<unsigned>(status.motion) << 6;
  const unsigned faults = status.fault | static_cast<unsigned>(status.controller_fault) << 4;
  return {Pair(state, 0), Pair(faults, status.position_request),
          Pair(status.position, status.current)};
}

std::variant<GripperStatus, DecodeError> DecodeGripperStatus(const GripperRegisters& registers) {
  const unsigned state = High(registers[0]);
  const unsigned activation = state >> 4 & 3u;
  if (activation == 2) return DecodeError{"activation state (gSTA) is 2; allowed: 0, 1, 3"};
  GripperStatus status;
  status.activate = HasBit(state, 0);
  status.go_to = HasBit(state, 3);
  status.activation = static_cast<GripperActivation>(activation);
  status.motion = static_cast<GripperMotion>(state >> 6 & 3u);
  status.fault = static_cast<std::uint8_t>(High(registers[1]) & 15u);
  status.controller_fault = static_cast<std::uint8_t>(High(registers[1]) >> 4);
  status.position_request = static_cast<std::uint8_t>(Low(registers[1]));
  status.position = static_cast<std::uint8_t>(High(registers[2]));
  status.current = static_cast<std::uint8_t>(Low(registers[2]));
  return status;
}

std::uint8_t GripperScale::PositionOf(double opening_m) const {
  double closed = 1.0 - opening_m / stroke_m;
  if (!(closed > 0.0)) closed = 0.0;
  closed = std::min(closed, 1.0);
  return static_cast<std::uint8_t>(std::lround(kOpenCount + (kClosedCount - kOpenCount) * closed));
}

double GripperScale::OpeningOf(std::uint8_t position) const {
  const double share = (kClosedCount - position) / (kClosedCount - kOpenCount);
  return stroke_m * std::clamp(share, 0.0, 1.0);
}

std::uint8_t GripperScale::SpeedOf(double speed_m_s) const {
  return ByteOf(speed_m_s, min_speed_m_s, max_speed_m_s);
}
double GripperScale::SpeedFrom(std::uint8_t speed) const {
  return FromByte(speed, min_speed_m_s, max_speed_m_s);
}
std::uint8_t GripperScale::ForceOf(double force_N) const {
  return ByteOf(force_N, min_force_N, max_force_N);
}
double GripperScale::ForceFrom(std::uint8_t force) const {
  return FromByte(force, min_force_N, max_force_N);
}

}  // namespace tubetwin

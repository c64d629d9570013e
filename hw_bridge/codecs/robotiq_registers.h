#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "hw_bridge/codecs/decode_error.h"

namespace tubetwin {

// The registers of a Robotiq 2F-85: three to write, three to read, two bytes each, the byte with
// the even number high.

inline constexpr int kGripperSlave = 9;
inline constexpr int kGripperActionStart = 0x03E8;
inline constexpr int kGripperStatusStart = 0x07D0;
using GripperRegisters = std::array<std::uint16_t, 3>;

/// What is written to the gripper.
struct GripperAction {
  bool activate = false;              ///< rACT: cleared, the gripper is reset.
  bool go_to = false;                 ///< rGTO: go to the position.
  bool automatic_release = false;     ///< rATR: slow emergency release.
  bool release_opens = false;         ///< rARD: which way that goes.
  std::uint8_t position = 0;          ///< rPR: 0 open to 255 closed.
  std::uint8_t speed = 0, force = 0;  ///< rSP, rFR.

  bool operator==(const GripperAction&) const = default;
};

enum class GripperActivation { kReset = 0, kRunning = 1, kDone = 3 };              // gSTA
enum class GripperMotion { kMoving, kStoppedOpening, kStoppedClosing, kArrived };  // gOBJ

/// What is read from the gripper.
struct GripperStatus {
  bool activate = false;  ///< gACT, echo of rACT.
  bool go_to = false;     ///< gGTO, echo of rGTO.
  GripperActivation activation = GripperActivation::kReset;
  GripperMotion motion = GripperMotion::kMoving;  ///< Valid with go_to.
  std::uint8_t fault = 0;                         ///< gFLT, see the codes below.
  std::uint8_t controller_fault = 0;              ///< kFLT, four bits as well.
  std::uint8_t position_request = 0;              ///< gPR, echo of rPR.
  std::uint8_t position = 0;                      ///< gPO: about 3 open to 230 closed.
  std::uint8_t current = 0;                       ///< gCU, 10 mA each.

  bool operator==(const GripperStatus&) const = default;
};

// Fault codes (gFLT). The first two clear with their cause, the next two are minor, the rest stops
// the gripper until it is activated anew.
inline constexpr int kGripperFaultDelayed = 0x05, kGripperFaultNotActivated = 0x07;
inline constexpr int kGripperFaultHot = 0x08, kGripperFaultSilence = 0x09;
inline constexpr int kGripperFaultVoltage = 0x0A, kGripperFaultReleasing = 0x0B;
inline constexpr int kGripperFaultInternal = 0x0C, kGripperFaultActivation = 0x0D;
inline constexpr int kGripperFaultCurrent = 0x0E, kGripperFaultReleased = 0x0F;
/// "over-current", "unknown fault 3"; empty for 0.
std::string GripperFaultText(int fault);

/// Bits and bytes without meaning are 0.
GripperRegisters EncodeGripperAction(const GripperAction& action);
/// Every value is an action; bits and bytes without meaning are not looked at.
GripperAction DecodeGripperAction(const GripperRegisters& registers);

/// Preconditions: both faults below 16.
GripperRegisters EncodeGripperStatus(const GripperStatus& status);
/// Fails for the activation state 2, which no gripper has. Bits and bytes without meaning are not
/// looked at.
std::variant<GripperStatus, DecodeError> DecodeGripperStatus(const GripperRegisters& registers);

// Units. Position counts run from 3 (open) to 230 (closed) with normal fingertips; a request
// beyond is clamped by the fingers. Speed and force bytes span their whole range.

/// Bytes and spans of one gripper: metres, m/s, newtons.
struct GripperScale {
  double stroke_m = 0.0;
  double min_speed_m_s = 0.0, max_speed_m_s = 0.0;
  double min_force_N = 0.0, max_force_N = 0.0;

  /// Nearest count, clamped to what the fingers reach; NaN is the open end.
  std::uint8_t PositionOf(double opening_m) const;
  double OpeningOf(std::uint8_t position) const;  ///< 0 to stroke_m.
  std::uint8_t SpeedOf(double speed_m_s) const;   ///< Nearest, clamped; NaN is the slowest.
  double SpeedFrom(std::uint8_t speed) const;
  std::uint8_t ForceOf(double force_N) const;  ///< Nearest, clamped; NaN is the weakest.
  double ForceFrom(std::uint8_t force) const;
};

}  // namespace tubetwin

#pragma once

#include <bit>
#include <cstdint>

#include "models/base/joint.h"
#include "models/base/time.h"

namespace tubetwin {

// The bytes of events: what encoder and decoder share. Internal to event_codec.

/// What a tag byte says; numbers are part of the file format.
enum class Tag : std::uint8_t {
  kTimeRead = 1,
  kTimeAdvanced = 2,
  kOnePeriod = 3,  ///< One control period on, and exactly there.
  kArmRead = 4,
  kArmStarted = 5,
  kArmAppended = 6,
  kArmStopped = 7,
  kPayloadSet = 8,
  kGripperRead = 9,
  kGripperCommanded = 10,
  kWristRead = 11,
  kScanTriggered = 12,
  kScanStatusRead = 13,
  kScanTaken = 14,
  kScanFailureRead = 15,
  kCaption = 16,
  kResult = 17,
  kArmRecovered = 18,
};

// First byte of a device's state: what follows it.
inline constexpr std::uint8_t kTimeOld = 1;    ///< The time it said last, not the cell's.
inline constexpr std::uint8_t kTimeOther = 2;  ///< A difference to the cell's time follows.
inline constexpr std::uint8_t kRest = 4;       ///< What seldom changes.
inline constexpr std::uint8_t kNumbers = 8;    ///< What often changes.
inline constexpr std::uint8_t kMoreNumbers = 16;
inline constexpr std::uint8_t kProblem = 16;  ///< Of gripper and wrist: another text of its driver.
inline constexpr std::uint8_t kProgressOn = 32;  ///< One control period on.
inline constexpr std::uint8_t kProgressOther = 64;
inline constexpr std::uint8_t kSaturated = 128;

inline constexpr double kPeriod_s = 0.001;
static_assert(kControlPeriod == std::chrono::milliseconds(1));

/// Of a trajectory point: time, positions, speeds, accelerations.
inline constexpr std::size_t kPointNumbers = 1 + 3 * kNumJoints;

inline bool SameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace tubetwin

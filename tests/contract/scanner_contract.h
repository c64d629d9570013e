#pragma once

#include <functional>

#include "hw_bridge/cell/devices.h"

namespace tubetwin {

/// A scanner under test with all that must run for it to work.
class ScannerRig {
 public:
  virtual ~ScannerRig() = default;
  virtual Scanner& scanner() = 0;
  /// Lets a little time pass: some milliseconds of the device's, about one of the wall's.
  virtual void Step() = 0;
};

/// Steps while the scanner is busy. Fails the test when that never ends (no result depends on how
/// long it takes).
ScanStatus AwaitScan(ScannerRig& rig);

/// Steps until `holds()` returns true, as what threads behind the scanner do takes the time it
/// takes. Fails the test when that never happens.
void StepUntil(ScannerRig& rig, const std::function<bool()>& holds);

/// Triggers, waits, takes; the test fails, with the scanner's reason, when that does.
OrganizedCloud TakeScan(ScannerRig& rig);

/// What any Scanner owes the pick cycle.
void CheckScannerContract(ScannerRig& rig);

/// Valid in the same places, and there equal in each coordinate within `tolerance` of its size.
void CheckSamePoints(const OrganizedCloud& got, const OrganizedCloud& wanted, float tolerance);

/// float32 millimetres and back: two roundings of 2^-24.
inline constexpr float kMillimetreRounding = 1.3e-7f;

}  // namespace tubetwin

#pragma once

#include <string>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// What can go wrong with one scan of an emulated scanner.
enum class ScanFault {
  kNone,
  kNoAnswer,    ///< The trigger is taken up and never answered.
  kLate,        ///< The answer comes later.
  kTruncated,   ///< Three fifths of the answer's bytes.
  kGarbage,     ///< Bytes that are no scan.
  kRefused,     ///< The scanner says no.
  kEmptyCloud,  ///< A whole scan in which no point is valid, as with a covered lens.
};

/// The faults that a script has ordered for the next scans. One thread, that of the emulators.
class ScanFaults {
 public:
  /// The next `scans` scans have `fault`; replaces what was ordered before.
  void Order(ScanFault fault, int scans);
  void OrderLate(double delay_s, int scans);  ///< Cell time.
  void OrderRefusal(const std::string& reason, int scans);

  struct Ordered {
    ScanFault fault = ScanFault::kNone;
    double delay_s = 0;
    std::string reason;
  };
  /// The fault of the scan that starts now.
  Ordered Next();

 private:
  Ordered ordered_;
  int left_ = 0;
};

/// The same cloud, seen through a covered lens.
void ClearPoints(OrganizedCloud& cloud);

}  // namespace tubetwin

#pragma once

#include <string>

#include "hw_bridge/cell/devices.h"
#include "models/base/error.h"

namespace tubetwin {

/// A scanner of whom tests decide all: how long it takes, what it sees, whether it works.
class FakeScanner : public Scanner {
 public:
  OrganizedCloud sees;
  TimeNs now{0};
  TimeNs takes = FromSeconds(0.05);
  std::string refuses, fails;  ///< Reasons; empty: it does not.
  int triggers = 0;

  CommandResult Trigger() override {
    if (!refuses.empty()) return {CommandResult::Status::kRejected, refuses};
    if (Status() == ScanStatus::kBusy) return {CommandResult::Status::kRejected, "busy"};
    ++triggers;
    triggered_ = true;
    ready_ = now + takes;
    return {};
  }
  ScanStatus Status() const override {
    if (!triggered_) return ScanStatus::kIdle;
    if (now < ready_) return ScanStatus::kBusy;
    return fails.empty() ? ScanStatus::kReady : ScanStatus::kFailed;
  }
  OrganizedCloud Take() override {
    TT_CHECK(Status() == ScanStatus::kReady);
    triggered_ = false;
    return sees;
  }
  std::string FailureReason() const override { return fails; }

 private:
  bool triggered_ = false;
  TimeNs ready_{0};
};

/// A small organised cloud of points that a scanner could see, some of them invalid, different for
/// each seed. It has labels and a pose, which must not cross a wire.
OrganizedCloud SomeScan(std::uint64_t seed, int width = 40, int height = 30);

}  // namespace tubetwin

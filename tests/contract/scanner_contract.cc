#include "tests/contract/scanner_contract.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {

void StepUntil(ScannerRig& rig, const std::function<bool()>& holds) {
  for (int i = 0; !holds(); ++i) {
    if (i == 100000) FAIL("what is waited for does not happen");
    rig.Step();
  }
}

ScanStatus AwaitScan(ScannerRig& rig) {
  StepUntil(rig, [&rig] { return rig.scanner().Status() != ScanStatus::kBusy; });
  return rig.scanner().Status();
}

OrganizedCloud TakeScan(ScannerRig& rig) {
  const CommandResult triggered = rig.scanner().Trigger();
  INFO(triggered.reason);
  REQUIRE(triggered.accepted());
  const ScanStatus status = AwaitScan(rig);
  INFO(rig.scanner().FailureReason());
  REQUIRE(status == ScanStatus::kReady);
  return rig.scanner().Take();
}

void CheckScannerContract(ScannerRig& rig) {
  Scanner& scanner = rig.scanner();
  CHECK(scanner.Status() == ScanStatus::kIdle);
  CHECK_THROWS_AS(scanner.Take(), LogicError);

  REQUIRE(scanner.Trigger().accepted());
  CHECK(scanner.Status() == ScanStatus::kBusy);
  CHECK_THROWS_AS(scanner.Take(), LogicError);
  const CommandResult again = scanner.Trigger();
  CHECK_FALSE(again.accepted());
  CHECK(again.reason == "a scan is running");

  REQUIRE(AwaitScan(rig) == ScanStatus::kReady);
  rig.Step();
  CHECK(scanner.Status() == ScanStatus::kReady);  // It waits to be taken.
  const OrganizedCloud first = scanner.Take();
  CHECK(first.organized());
  CHECK(first.size() == static_cast<std::size_t>(first.width) * first.height);
  CHECK(first.X_NS.matrix().allFinite());
  CHECK(scanner.Status() == ScanStatus::kIdle);
  CHECK_THROWS_AS(scanner.Take(), LogicError);  // A scan is taken once.

  REQUIRE(scanner.Trigger().accepted());  // One that nobody takes is forgotten.
  REQUIRE(AwaitScan(rig) == ScanStatus::kReady);
  const OrganizedCloud next = TakeScan(rig);
  CHECK(next.width == first.width);
  CHECK(next.height == first.height);
}

void CheckSamePoints(const OrganizedCloud& got, const OrganizedCloud& wanted, float tolerance) {
  REQUIRE(got.width == wanted.width);
  REQUIRE(got.height == wanted.height);
  REQUIRE(got.size() == wanted.size());
  std::size_t valid = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const Eigen::Vector3f &p = got.p_SP[i], &q = wanted.p_SP[i];
    if (IsValid(p) != IsValid(q)) FAIL("point " << i << " is valid on one side only");
    if (!IsValid(p)) continue;
    ++valid;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(p[k] - q[k]) > tolerance * std::abs(q[k])) {
        FAIL("point " << i << ": " << p.transpose() << " instead of " << q.transpose());
      }
    }
  }
  CHECK(valid > got.size() / 10);  // Otherwise nothing was compared.
}

}  // namespace tubetwin

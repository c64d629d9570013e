#pragma once

#include "hw_bridge/cell/cell.h"
#include "tests/support/catch.h"

namespace tubetwin::test {

/// Lets time pass until `condition()` holds, for 30 s of cell time at most.
template <typename Condition>
void AdvanceUntil(Cell& cell, Condition condition) {
  constexpr double kPatience_s = 30.0;
  const TimeNs end = cell.clock.Now() + FromSeconds(kPatience_s);
  while (!condition()) {
    REQUIRE(cell.clock.Now() < end);
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
  }
}

/// The arm's state once it no longer moves.
inline ArmState WaitUntilStill(Cell& cell) {
  AdvanceUntil(cell, [&] { return cell.arm.State().mode != ArmMode::kMoving; });
  return cell.arm.State();
}

}  // namespace tubetwin::test

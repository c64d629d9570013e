#pragma once

#include "hw_bridge/cell/cell.h"

namespace tubetwin::test {

// What every device of every cell must do, whoever makes it: the twin, a replay, drivers before
// emulators. Each suite needs a cell whose arm stands still, ready, with room of 0.05 rad for each
// joint and nothing in the fingers, and leaves it so. They use Catch's assertions.

void CheckClockContract(Cell& cell);
void CheckArmContract(Cell& cell);
void CheckGripperContract(Cell& cell);
void CheckWristContract(Cell& cell);
void CheckScannerContract(Cell& cell);

/// All of them.
void CheckDeviceContracts(Cell& cell);

}  // namespace tubetwin::test

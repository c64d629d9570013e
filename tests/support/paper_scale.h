#pragma once

#include "hw_bridge/drivers/robotiq/robotiq_driver.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {

/// What the registers of the paper's gripper mean.
inline GripperScale PaperScale() { return ScaleOf(PaperCell().gripper); }

}  // namespace tubetwin

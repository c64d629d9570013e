#pragma once

#include "hw_bridge/codecs/robotiq_registers.h"

namespace tubetwin {

/// What the registers of the paper's gripper mean: its data sheet.
inline GripperScale PaperScale() { return {0.085, 0.020, 0.150, 20.0, 235.0}; }

}  // namespace tubetwin

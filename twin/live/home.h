#pragma once

#include "hw_bridge/cell/cell.h"

namespace tubetwin {

/// Drives E to over the middle of the bin at carry height, the tool pointing down: where a twin's
/// arm begins (HomePosition). On the way all that the cell model knows of is kept clear of, and E
/// keeps within the speed of a cell that is not proven. The fingers stay as they are. Returns the
/// joints there. Throws Error(kDevice): something is or may be between the fingers (nothing was
/// moved), no way is free, a device stopped it; Error(kInterrupted) when `cell.stop_at_once` did.
JointVector DriveHome(Cell& cell, double part_mass_kg);

}  // namespace tubetwin

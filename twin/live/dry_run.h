#pragma once

#include <memory>

#include "hw_bridge/cell/cell.h"

namespace tubetwin {

/// A cell in which nothing moves, for rehearsals: an arm and fingers that follow every command in
/// thought only, from where the real ones stand, and the real wrist and scanner. Scans show what
/// the scanner sees from where it really is. `cell` must outlive it; its gripper must have been
/// left as it is and its arm unarmed, or nobody else must command them.
class DryRunCell {
 public:
  explicit DryRunCell(Cell& cell);
  ~DryRunCell();
  Cell& cell();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

#pragma once

#include <memory>

#include "hw_bridge/cell/cell.h"

namespace tubetwin {

/// A cell for rehearsals in which nothing moves: a simulated arm and gripper that start where the
/// real ones are and follow every command exactly, with the real wrist sensor and scanner. Scans
/// show what the scanner sees from its real position. `cell` must outlive it, connected with
/// CellPurpose::kLook so that its arm and gripper take no commands.
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

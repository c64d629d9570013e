#pragma once

#include <memory>

#include "hw_bridge/cell/cell.h"
#include "twin/live/dry_run_report.h"

namespace tubetwin {

/// A cell for rehearsals in which nothing moves: a simulated arm and gripper that start where the
/// real ones are and follow every command exactly, with the real wrist sensor and scanner. Scans
/// show what the scanner sees from its real position. `cell` must outlive it, connected with
/// CellPurpose::kLook so that its arm and gripper take no commands.
class DryRunCell {
 public:
  /// `held_m`: fingers that close stop at that width, as on a part, so that lifting is rehearsed
  /// too; 0: they close on nothing. The wrist, which is the real one, weighs nothing either way.
  explicit DryRunCell(Cell& cell, double held_m = 0.0);
  ~DryRunCell();
  Cell& cell();
  /// What the motions so far show, none of which was sent.
  DryRunReport Report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

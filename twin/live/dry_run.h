#pragma once

#include <memory>

#include "hw_bridge/cell/cell.h"
#include "twin/live/dry_run_report.h"

namespace tubetwin {

/// What rehearsed fingers close on, so that lifting and laying down are rehearsed too.
struct RehearsedPart {
  double width_m = 0.0;  ///< 0: they close on nothing.
  double mass_kg = 0.0;
};

/// A cell for rehearsals in which nothing moves: a simulated arm and gripper that start where the
/// real ones are and follow every command exactly, with the real scanner and the real wrist sensor,
/// to which the weight of the rehearsed part is added while it is held. Scans show what the scanner
/// sees from its real position. `cell` must outlive it, connected with CellPurpose::kLook so that
/// its arm and gripper take no commands.
class DryRunCell {
 public:
  explicit DryRunCell(Cell& cell, const RehearsedPart& held = {});
  ~DryRunCell();
  Cell& cell();
  /// What the motions so far show, none of which was sent.
  DryRunReport Report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

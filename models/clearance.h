#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/base/joint.h"
#include "models/bin.h"
#include "models/cell_model.h"

namespace tubetwin {

/// Distances of arm, tool, scanner housing, gripper and fingers against bin, tray, base, cell
/// plate, keep-out boxes and each other (FCL, primitive shapes). Pairs that the joints hold apart
/// or together (neighbours) are left out. The fingers stand where `opening_m` puts them. Immutable
/// after construction; const calls are thread safe.
class ClearanceChecker {
 public:
  /// `model` must outlive this; the bin is copied.
  ClearanceChecker(const CellModel& model, const Bin& bin);
  ~ClearanceChecker();

  /// The nearest pair of a kind.
  struct Nearest {
    double clearance_m = 0.0;  ///< Smallest signed distance; negative or zero means contact.
    std::string moving;        ///< Names of the pair, for messages; empty when nothing is near.
    std::string obstacle;
  };
  struct Result : Nearest {  ///< Over all pairs.
    Nearest fingers;         ///< The fingers against the bin's floor and walls only.
    Nearest others;          ///< Every pair but those.
  };
  /// Smallest clearances at q, at most `enough_m` (search stops there). `opening_m`: gripper.
  Result Check(const JointVector& q, double opening_m, double enough_m = 0.05) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Two things of a cell that stand, and how far apart they are (negative: into each other).
struct StandingPair {
  std::string a, b;
  double clearance_m = 0.0;
  std::string remedy_key;  ///< Of the configuration: what moves `a`.
};

/// Bin (with its plinth) and tray against each other, the plate, the arm's base and first link, and
/// what else stands in the cell. In a fixed order.
std::vector<StandingPair> StandingClearances(const CellModel& model, const Bin& bin);

}  // namespace tubetwin

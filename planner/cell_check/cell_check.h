#pragma once

#include <optional>
#include <vector>

#include "models/base/finding.h"
#include "models/cell_model.h"
#include "models/part.h"

namespace tubetwin {

/// What is to be judged before anything is simulated or moved. References must outlive the call.
struct CellCheckInput {
  const CellModel& model;
  const Bin& bin;
  const Part& part;
  std::vector<RigidTransform> views_BS;  ///< Where the scanner looks from.
  int count = 0;                         ///< Tubes in the pile; 0: not known.
  /// The scanner's pose is the model's nominal one, and scanner or arm are real.
  bool nominal_scanner_pose = false;
};

/// Judges a cell: whether bin, tray and what stands there are apart; what arm and tool reach; what
/// the scanner sees of the bin; how full the bin is; whether poses look like metres. Always in the
/// same order, the good findings too. Pure and deterministic, within seconds.
std::vector<Finding> CheckCell(const CellCheckInput& input);

// Its parts.

/// Poses that cannot be metres; then nothing else is worth looking at. Empty when all can.
std::vector<Finding> CheckUnits(const CellModel& model, const Bin& bin);
/// Bin, tray, base, plate and what else stands there against each other.
std::vector<Finding> CheckStanding(const CellModel& model, const Bin& bin);
/// Volume of the tubes against the bin's, and their length against its floor.
Finding CheckFill(const Bin& bin, const Part& part, int count);

/// What the arm's file says against itself: the flange points along the last axis, the working
/// posture points the tool down. Doubts only.
std::vector<Finding> CheckArm(const ArmModel& arm);

/// Shares, 0 to 1, of the places where the tool gets to.
struct ReachShares {
  double floor_upright =
      0.0;  ///< Of the bin's floor, 5 cm or the open gripper from its walls: at any yaw.
  double floor_leaning = 0.0;  ///< The same with the tool leaning by 20 degrees to some side.
  double tray = 0.0;           ///< Of the tray's slots, upright.
  double station = 0.0;        ///< Of twelve tilts by 45 degrees at the station.
  double views = 0.0;          ///< Of the views, or of the place where a scanner on a stand looks.
  Vector3 first_missed_N = Vector3::Zero();  ///< A place of the floor out of reach, if any.
};
ReachShares ReachOf(const CellCheckInput& input);

/// Shares, 0 to 1, of places that camera and projector see past the walls in at least one view.
struct CoverageShares {
  double floor = 0.0;  ///< Of the floor.
  /// Of the floor, hidden from camera or projector by the arm where it waits for a scanner on a
  /// stand.
  double behind_arm = 0.0;
  double walls = 0.0;  ///< Of tubes that lie along the walls: their crowns.
};
CoverageShares CoverageOf(const CellCheckInput& input);

}  // namespace tubetwin

#pragma once

#include <vector>

#include "models/base/finding.h"
#include "models/cell_model.h"
#include "models/part.h"

namespace tubetwin {

/// What a part is judged against: figures of the devices, and of what the pick cycle does with
/// them. Defaults are those of the configuration; the room that owns a figure is named, and tests
/// hold the defaults against it. SI units.
struct PartFitCell {
  /// Of that cell, everything else as by default; the sensor's noise is one count.
  explicit PartFitCell(const CellModel& model);

  GripperSpec gripper;
  ScannerSpec scanner;
  /// Least room between tube and pad on either side with which a grasp is planned, and the room
  /// from which on more is worth little in a pile (planner/grasp).
  double least_side_room_m = 0.0045, easy_side_room_m = 0.011;
  double grip_force_N = 60.0;            ///< cycle.grip_force_N, per pad.
  double pad_friction = 0.6;             ///< Lower end of physics.pad_friction.
  double carry_acceleration_m_s2 = 1.0;  ///< cycle.transfer_acceleration_m_s2.
  /// Wrist sensor along gravity: one count, noise of one reading (one sigma), drift over ten
  /// minutes, largest reading.
  double count_N, noise_N, drift_N = 0.1, max_reading_N;
  int scan_width;          ///< Pixels of a row of the image that is taken (scan.resolution).
  double scan_distance_m;  ///< Camera to the bin's floor, along its view.
  /// Turn squared times gap at which the ends of a tube's hidden piece look as much like those of
  /// two tubes (perception/joining).
  double even_turn_m = 0.079;
};

/// What gripper, wrist sensor, scanner and modelling make of a part, one finding each, always in
/// the same order: opening, grip, weight on the sensor, points across and along, sharpest bend,
/// sag (hoses), fitted search. Pure; the part must have passed the checks of part files.
std::vector<Finding> JudgePart(const Part& part, const PartFitCell& cell);

}  // namespace tubetwin

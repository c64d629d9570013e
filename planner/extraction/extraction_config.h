#pragma once

#include <string>
#include <vector>

#include "models/base/config/config.h"

namespace tubetwin {

/// What extraction motions are like; keys of config table [planner]. Defaults are the paper's Table
/// 2 where it gives them.
struct ExtractionConfig {
  double lift_m = 0.40;  ///< Upward move.
  double escape_first_lift_m = 0.05;
  double escape_const_m =
      0.0375;                   ///< d_const; three radii of the tube are used where that is more.
  double wall_safety_m = 0.01;  ///< Escapes keep the whole tube this far from the bin's walls.
  double lift_speed_m_s = 0.25;
  double grasp_step_m = 0.01;  ///< Between grasp points along the tube.
  /// Kinds of the registry that are tried; empty: all.
  std::vector<std::string> motions;
  /// Escapes follow the occluded joints of the leao2020 modelling instead of the crossings. No key
  /// of its own: planner.classes says so.
  bool escape_along_joints = false;

  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/bin.h"
#include "models/layout.h"
#include "planner/motion/path_config.h"
#include "planner/motion/pick_path.h"

namespace tubetwin {

/// Config table [resolution]: what is done when several tubes hang in the fingers.
struct ResolutionConfig {
  std::string strategy = "plus45_minus45";  ///< A name of the registry.
  double angle_deg = 45.0;
  double speed_deg_s = 20.0;
  void Visit(ConfigVisitor& v);
};

/// What a strategy plans with; references outlive the call.
struct ResolutionInput {
  RigidTransform X_BE;    ///< Where E is: tool upright, at rest, several tubes in the fingers.
  Vector3 load_torque_K;  ///< Torque of the load, N m, frame K: about E's axes, as K's are E's.
  const CellLayout& layout;
  const Bin& bin;
  const ResolutionConfig& config;
  const PathConfig& paths;
  double lift_speed_m_s = 0.25;
  double ramp_s = 0.0;  ///< Period with which what is held swings; 0: rigid.
  /// The tool is turned so far about the vertical where it tilts. Several are tried, the smallest
  /// first, until the arm can run the path.
  double yaw_rad = 0.0;
};

/// What can be done when several tubes hang in the fingers.
struct ResolutionStrategy {
  std::string name;  ///< Its identity, in configuration and results.
  std::string help;  ///< "tilts about the load torque"; for people.
  /// The path from `X_BE` on. After each of its stages the load is weighed; the first stage after
  /// which one tube or none is left is the last. The tool stands upright and at rest at the end of
  /// each. What falls must fall into the bin. Null: the tubes are put back at once. Pure.
  PickPath (*make)(const ResolutionInput& input) = nullptr;
};

/// Every strategy. To add one: a file with its function and a line in registry.cc
/// (planner/resolution/README.md).
const std::vector<ResolutionStrategy>& ResolutionStrategies();

/// The strategy of that name. Throws Error(kConfig) naming those that there are.
const ResolutionStrategy& ResolutionStrategyOf(const std::string& name);

}  // namespace tubetwin

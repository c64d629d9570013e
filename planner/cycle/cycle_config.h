#pragma once

#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/base/frames.h"
#include "models/cell_model.h"
#include "planner/motion/path_config.h"

namespace tubetwin {

/// Config table [scan].
struct ScanConfig {
  int views = 8;           ///< Of the cell model's views, from the first.
  std::string resolution;  ///< "1032x772": one that the scanner has; empty: its first.
  /// One view straight down on the bin's centre from so high over its floor, image along the long
  /// side, in place of the scan poses; 0: the scan poses.
  double overhead_m = 0.0;
  bool rescan_all = false;  ///< Later scans of a round look everywhere again.
  void Visit(ConfigVisitor& v);
};

/// Config table [cycle]: what the paths of a pick are like, and the waits between them.
struct CycleConfig : PathConfig {
  double settle_s = 2.0;  ///< At most, until the load stands still after a motion.
  double weigh_window_s = 0.2;
  double tolerance_share = 0.5;  ///< F_tol in tube weights.
  /// The round ends where several tubes hang in the fingers, once the observer has heard of it.
  bool end_at_several = false;
  int attempts_per_tube = 4;  ///< The round ends after this many times the first count, plus ten.
  void Visit(ConfigVisitor& v);
};

/// Where a round looks from, X_BS, to see tubes of `radius_m`: at least one. Throws Error(kConfig)
/// when an overhead view is asked of a scanner on a stand.
std::vector<RigidTransform> ScanPoses(const ScanConfig& config, const CellModel& model,
                                      const Bin& bin, double radius_m);

}  // namespace tubetwin

#include "planner/cycle/cycle_config.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

void ScanConfig::Visit(ConfigVisitor& v) {
  v.Field("views", "how many of the scan poses are used", views, {1, 8});
  v.Field("resolution", "columns x rows of a scan, one that the scanner has; empty: its first",
          resolution);
  v.Field("overhead_m",
          "height over the floor of one view on the whole bin instead of the scan poses; 0: these",
          overhead_m, {0.0, 1.5});
  v.Field("rescan_all", "look everywhere again before every pick", rescan_all);
}

std::vector<RigidTransform> ScanPoses(const ScanConfig& config, const CellModel& model,
                                      const Bin& bin, double radius_m) {
  if (config.overhead_m > 0.0) {
    if (model.layout.scanner_mount == CellLayout::ScannerMount::kStand) {
      throw Error(ErrorKind::kConfig, "scan.overhead_m: is " + Number(config.overhead_m) +
                                          "; the scanner of " + model.name +
                                          " is on a stand and sees from there: only 0 is allowed");
    }
    const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, config.overhead_m));
    return {bin.X_BN * X_NS};
  }
  std::vector<RigidTransform> poses_BS = ScanPosesOf(model, bin, radius_m);
  poses_BS.resize(std::min(poses_BS.size(), static_cast<std::size_t>(config.views)));
  return poses_BS;
}

void CycleConfig::Visit(ConfigVisitor& v) {
  PathConfig::Visit(v);
  v.Field("settle_s", "at most, until the load stands still after a motion", settle_s, {0.1, 20});
  v.Field("weigh_window_s", "mean over", weigh_window_s, {0.02, 5});
  v.Field("tolerance_share", "F_tol in tube weights", tolerance_share, {0.1, 0.9});
  v.Field("end_at_several",
          "the round ends where several tubes hang in the fingers; the result folder holds that "
          "moment as held.pile.json, which pile.file takes",
          end_at_several);
  v.Field("attempts_per_tube", "the round ends after this many times the first count, plus ten",
          attempts_per_tube, {1, 100});
}

}  // namespace tubetwin

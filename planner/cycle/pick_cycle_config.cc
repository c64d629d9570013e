#include "planner/cycle/pick_cycle.h"

#include <algorithm>

#include "models/layout.h"

namespace tubetwin {

void ScanConfig::Visit(ConfigVisitor& v) {
  v.Field("views", "how many of the scan poses are used", views, {1, 8});
  v.Choice("resolution", "columns x rows of a scan", resolution, {"1032x772", "2064x1544"});
  v.Field("overhead_m",
          "height over the floor of one view on the whole bin instead of the scan poses; 0: these",
          overhead_m, {0.0, 1.5});
  v.Field("rescan_all", "look everywhere again before every pick", rescan_all);
}

std::vector<RigidTransform> ScanPoses(const ScanConfig& config, const Bin& bin) {
  if (config.overhead_m > 0.0) {
    const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, config.overhead_m));
    return {bin.X_BN * X_NS};
  }
  std::vector<RigidTransform> poses_BS = DefaultScanPoses(bin);
  poses_BS.resize(std::min(poses_BS.size(), static_cast<std::size_t>(config.views)));
  return poses_BS;
}

void ResolutionConfig::Visit(ConfigVisitor& v) {
  v.Choice(
      "strategy",
      "what is done when several tubes hang in the fingers: none releases them at once, plus45 "
      "tilts about the load torque, plus45_minus45 in both senses, perpendicular about the axis "
      "across it, putback lowers, rests and lifts again",
      strategy, ResolutionStrategyNames());
  v.Field("angle_deg", "tilt", angle_deg, {5, 60});
  v.Field("speed_deg_s", "speed of the tilt", speed_deg_s, {1, 90});
}

void CycleConfig::Visit(ConfigVisitor& v) {
  v.Field("transfer_speed_m_s", "carrying", transfer_speed_m_s, {0.05, 1.5});
  v.Field("transfer_acceleration_m_s2", "carrying", transfer_acceleration_m_s2, {0.1, 5});
  v.Field("approach_speed_m_s", "down to a grasp", approach_speed_m_s, {0.01, 0.5});
  v.Field("guarded_speed_m_s", "last part of the way down", guarded_speed_m_s, {0.002, 0.05});
  v.Field("guard_force_N", "force that ends a guarded descent", guard_force_N, {1, 60});
  v.Field("grip_force_N", "per pad", grip_force_N, {20, 235});
  v.Field("grip_speed_m_s", "of the opening", grip_speed_m_s, {0.02, 0.15});
  v.Field("approach_m", "height over the grasp where the straight descent begins", approach_m,
          {0.02, 0.3});
  v.Field("guarded_m", "length of the guarded part", guarded_m, {0.002, 0.05});
  v.Field("first_lift_m", "lift before the first weighing", first_lift_m, {0.005, 0.2});
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

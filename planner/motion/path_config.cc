#include "planner/motion/path_config.h"

namespace tubetwin {

void PathConfig::Visit(ConfigVisitor& v) {
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
}

}  // namespace tubetwin

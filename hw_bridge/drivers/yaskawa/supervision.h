#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/drivers/device_driver.h"
#include "hw_bridge/drivers/yaskawa/hses_client.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"

namespace tubetwin {

/// How the controller's High-Speed Ethernet Server is asked; `tries` of 0.2 s each.
HsesConfig SupervisionOf(const YaskawaConfig& config, int tries);

/// Encoder pulses per degree of the coarsest of the joints that are turned far enough to tell (5
/// degrees), by comparing pulses with joint angles of the same moment; nothing when none is, or
/// when a joint's pulses and angle have other signs (`wrong_joint`, from 1).
struct PulseScale {
  std::optional<double> pulses_per_degree;
  int wrong_joint = 0;
};
PulseScale PulsesPerDegree(const std::array<std::int32_t, 8>& pulses, const JointVector& q);

/// Alarm, mode, hold, drives, job and pulses by the High-Speed Ethernet Server, the outputs of
/// MotoROS by the I/O port; reads only. `q`: what the arm says by its state port. At most 3 s.
std::vector<DeviceFinding> Supervise(const YaskawaConfig& config, const JointVector& q);

}  // namespace tubetwin

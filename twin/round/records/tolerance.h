#pragma once

#include "models/base/json_fwd.h"

namespace tubetwin {

class ConfigVisitor;

/// How far a placed tube may lie from where it was meant to: scenario table [success].
struct PlacementTolerance {
  double position_mm = 20.0;  ///< Of its centre of mass from its slot's centre, horizontally.
  double yaw_deg = 10.0;      ///< Of its first principal axis from the slot's yaw, modulo 180.
  void Visit(ConfigVisitor& v);

  /// Both errors within it.
  bool Holds(double error_mm, double error_deg) const {
    return error_mm <= position_mm && error_deg <= yaw_deg;
  }
};

/// {position_mm, yaw_deg}. Reading throws Error(kBadData).
Json ToJson(const PlacementTolerance& tolerance);
PlacementTolerance ToleranceFromJson(const JsonView& view);

}  // namespace tubetwin

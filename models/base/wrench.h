#pragma once

#include "models/base/frames.h"

namespace tubetwin {

/// Force and torque that the *load* (everything below the sensor) exerts on the sensor, expressed
/// in frame K (z out of the tool), torque about K's origin. Hanging a mass m below a tool that
/// points down (K's z down) therefore reads force_N.z() = +m g; the paper's z+ axis points up, so
/// its F_z is -force_N.z() and falls when weight is added. The sign is fixed in twin/cell's sensor
/// model and nowhere else.
struct Wrench {
  Vector3 force_N = Vector3::Zero();
  Vector3 torque_Nm = Vector3::Zero();

  Wrench operator-(const Wrench& other) const {
    return {force_N - other.force_N, torque_Nm - other.torque_Nm};
  }
  Wrench operator+(const Wrench& other) const {
    return {force_N + other.force_N, torque_Nm + other.torque_Nm};
  }
  Wrench operator*(double s) const { return {force_N * s, torque_Nm * s}; }
};

}  // namespace tubetwin

#pragma once

#include <Eigen/Dense>

#include "hw_bridge/cell/devices.h"
#include "models/base/json_fwd.h"
#include "models/base/random.h"
#include "models/physics.h"
#include "models/wrist_spec.h"
#include "twin/cell/cell_world.h"

namespace tubetwin {

/// What stands between the forces in the wrist and the numbers that arrive: cross-talk, low-pass,
/// slow bias walk, white noise, range, resolution. Pure: no engine, so tests feed it known
/// wrenches. One call per millisecond; random numbers depend on the call's index only.
class WrenchChain {
 public:
  WrenchChain(const WristSpec& spec, const RoundPhysics& physics, RandomStream stream);

  /// The next reading of a true load. `time` is only passed on.
  WrenchSample Next(const Wrench& load_K, TimeNs time);

  /// Filter, bias and place in the random stream, and back.
  Json StoredState() const;
  void Restore(const JsonView& state);

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> cross_talk_;
  WristSpec spec_;
  RandomStream stream_;
  double noise_counts_, walk_counts_;
  Vector6 filtered_ = Vector6::Zero(), bias_ = Vector6::Zero();
  bool first_ = true;
};

/// The force/torque sensor of the twin. The one place where the sign of the wrench is fixed: the
/// engine reports what the arm must bear so that the tool stays on it; the load on the sensor is
/// its negative.
class TwinWrist : public ForceTorqueSensor {
 public:
  /// `world` must outlive it.
  TwinWrist(const WristSpec& spec, const CellWorld& world, const RoundPhysics& physics,
            RandomStream stream);

  WrenchSample Read() const override { return newest_; }
  /// Takes the sample of the step that has just been made (or of the world as it stands).
  void Sample();
  /// What the coming samples depend on besides the world, with the newest one, and back.
  Json StoredState() const;
  void Restore(const JsonView& state);
  /// The load without the sensor's faults.
  Wrench TrueLoad() const;

 private:
  const CellWorld& world_;
  const mjData& data_;
  int force_ = 0, torque_ = 0;  ///< Addresses in sensordata.
  WrenchChain chain_;
  WrenchSample newest_;
};

}  // namespace tubetwin

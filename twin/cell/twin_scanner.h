#pragma once

#include <optional>

#include "hw_bridge/cell/devices.h"
#include "models/base/parallel.h"
#include "models/base/random.h"
#include "twin/cell/cell_world.h"
#include "twin/cell/twin_arm.h"

namespace tubetwin {

/// The scanner of the twin. A scan takes the device's time; what it shows is the world at the
/// trigger, from the true pose (flange or stand, calibrated pose and its error). The cloud is cast
/// when it is taken, so scans that nobody takes cost nothing.
class TwinScanner : public Scanner {
 public:
  struct Setup {
    Bin bin;
    RoundPhysics physics;
    ScanSettings settings;
    Parallelism parallelism;
  };
  /// `model`, `world` and `arm` must outlive it.
  TwinScanner(const CellModel& model, const CellWorld& world, const TwinArm& arm, Setup setup,
              RandomStream stream);

  CommandResult Trigger() override;
  ScanStatus Status() const override;
  OrganizedCloud Take() override;
  std::function<OrganizedCloud()> TakeLater() override;

  /// Scans so far, which the noise of the next depends on. Precondition of reading: none runs or
  /// waits to be taken.
  std::uint64_t taken() const;
  void SetTaken(std::uint64_t taken) { taken_ = taken; }

  /// True pose of the scanner now.
  RigidTransform TrueX_BS() const;

 private:
  struct Shot {
    ScanGeometry geometry;
    RigidTransform X_BS;          ///< True.
    RigidTransform X_NSBelieved;  ///< From the measured joints.
    TimeNs ready{0};
    std::uint64_t index = 0;
  };

  const CellModel& model_;
  const CellWorld& world_;
  const TwinArm& arm_;
  Setup setup_;
  RandomStream stream_;
  std::optional<Shot> shot_;
  std::uint64_t taken_ = 0;
};

}  // namespace tubetwin

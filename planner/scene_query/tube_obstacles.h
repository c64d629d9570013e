#pragma once

#include <utility>
#include <vector>

#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// One tube that shall move and all others as they lie, for questions about shifts of the one.
class TubeObstacles {
 public:
  /// `tube` is one of the scene's and must outlive this.
  TubeObstacles(const TubeScene& scene, const PerceivedTube& tube);

  /// Does any other tube lie over the moved one?
  bool Covered(const Vector3& shift) const;
  /// Tubes that the moved one overlaps although it did not at the start.
  int NewlyTouched(const Vector3& shift) const;
  /// Ranges of arc length, every `step_m`, where a gripper would run into another tube if it held
  /// the tube there and went straight by `by_N`, from where the tube was shifted to.
  std::vector<std::pair<double, double>> BlockedGrasps(
      const Vector3& by_N, double step_m, const Vector3& shift = Vector3::Zero()) const;

 private:
  struct Other {
    Polyline line;
    double radius_m = 0.0;
    double distance_m = 0.0;  ///< Of the axes at the start.
  };
  bool GripperMeets(const Vector3& p, const Vector3& by_N) const;

  const PerceivedTube& tube_;
  const Polyline points_;
  std::vector<Other> others_;
};

}  // namespace tubetwin

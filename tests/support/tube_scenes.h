#pragma once

#include <vector>

#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// That of nearly all tubes in the tests, in metres: the part pvc_a's.
inline constexpr double kRadius = 0.0125;

/// For searches in scenes of tubes alone.
inline const std::vector<Vector3> kNoPoints;

/// A straight line of nodes at most 10 mm apart.
inline Polyline StraightLine(const Vector3& from, const Vector3& to) {
  return Resample({from, to}, 0.01);
}

/// What a perfect perception would say about these tubes: ids from 1, crossings and classes by the
/// common rule, everything seen.
inline TubeScene PerfectScene(const std::vector<Polyline>& lines_N, double radius_m) {
  TubeScene scene;
  for (const Polyline& line : lines_N) {
    PerceivedTube tube;
    tube.id = static_cast<int>(scene.tubes.size()) + 1;
    tube.centerline_N = line;
    tube.radius_m = radius_m;
    tube.length_m = Length(line);
    tube.visible_fraction = 1.0;
    tube.confidence = 1.0;
    tube.node_visible.assign(line.size(), 1);
    scene.tubes.push_back(tube);
  }
  AssignClasses(scene, radius_m);
  return scene;
}

/// Tube 1 along x on the floor from -0.25 to 0.25, tube 2 over it along y at x = 0.05.
inline TubeScene Cross() {
  return PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                       StraightLine({0.05, -0.2, 3 * kRadius}, {0.05, 0.2, 3 * kRadius})},
                      kRadius);
}

/// Tube 2 lies balanced across tube 1.
inline TubeScene Balanced() {
  return PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                       StraightLine({0.20, -0.25, 3 * kRadius}, {0.20, 0.25, 3 * kRadius})},
                      kRadius);
}

inline Polyline Shifted(const Polyline& line, const Vector3& by) {
  return Transformed(Translation(by), line);
}

}  // namespace tubetwin

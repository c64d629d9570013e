#pragma once

#include <array>
#include <string>
#include <vector>

#include "twin/render/recording.h"

namespace tubetwin {

/// What moved where during a part of a recording, small enough to be sent and drawn elsewhere:
/// plain shapes fixed to bodies, and for every body its pose at the moments when it changed.
/// Frame B, metres.
struct CellTrack {
  enum class Shape { kBox, kSphere, kCapsule, kCylinder };
  struct Geom {
    int body = 0;  ///< Index in bodies.
    std::string name;
    Shape shape = Shape::kBox;
    /// Box: half edges; sphere: radius; capsule and cylinder: radius, half length along z.
    std::array<double, 3> size_m = {};
    RigidTransform X_bodyGeom = RigidTransform::Identity();
    std::array<float, 4> rgba = {};
  };
  /// A body's pose at a sample; between two keys it moves evenly.
  struct Key {
    int sample = 0;
    RigidTransform X_BBody = RigidTransform::Identity();
  };
  struct Body {
    std::string name;
    std::vector<Key> keys;  ///< The first at sample 0.
  };
  double sample_s = 0.0;  ///< From one sample to the next, simulated.
  int samples = 0;
  std::vector<Body> bodies;    ///< That have geoms; "world" stands still.
  std::vector<Geom> geoms;     ///< Without planes and users' meshes.
  std::vector<Vector3> p_BPs;  ///< [samples] centre between the pads (geoms pad_left, pad_right).
};

/// Every `stride`-th frame of [from, to) of a recording. Throws Error(kBadData) when the cell's XML
/// does not compile or fits the frames not. Preconditions: stride >= 1, 0 <= from <= to <= frames.
CellTrack TrackOf(const Recording& recording, int from, int to, int stride);

/// Centerlines of the tubes (geoms NAME_g0, NAME_g1, ... of tubes named tube1, tube2, ...) at one
/// sample, frame B, in the order of the geoms.
std::vector<Polyline> TubesAt(const CellTrack& track, int sample);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/base/polyline.h"
#include "models/base/random.h"
#include "models/bin.h"

namespace tubetwin {

/// A second, independent image formation for tests of perception: exact ray casting of capsules, a
/// bin and boxes through a pinhole, projector shadow by a depth map, white depth noise. No Embree.
struct ToyScene {
  std::vector<Polyline> tubes_N;
  double radius_m = 0.0125;
  Bin bin;
  struct Box {
    Vector3 low_N, high_N;  ///< Aligned with N.
  };
  std::vector<Box> boxes;  ///< Foreign objects, labelled as cell.
};

struct ToyCamera {
  int width = 1032, height = 772;
  double focal_px = 1267.0;
  double baseline_m = 0.0;  ///< Projector at this x of S; 0: no shadow.
  double sigma_m = 0.0001;  ///< Along the ray.
  double drop_out = 0.0;    ///< Share of pixels without return.
};

/// Labelled cloud from the true pose `X_NS`, which is also stored as the believed one.
OrganizedCloud ToyScan(const ToyScene& scene, const ToyCamera& camera, const RigidTransform& X_NS,
                       RandomStream stream);

/// Camera looking straight down from `p_NS` with image x along N's -y (as the cell's scanner with
/// image x along B's x when the bin is turned by +90 degrees).
RigidTransform LookDown(const Vector3& p_NS);

/// The eight poses of the cell: four along the long side, two across, 0.515 m above the floor.
std::vector<RigidTransform> EightPoses();

/// `X` moved by up to `shift_m` and turned by up to `turn_rad` in a random direction.
RigidTransform Disturbed(const RigidTransform& X, double shift_m, double turn_rad,
                         RandomStream& stream);

/// A pile of the public set, `tube,index,x,y,z`; empty when the file is not there.
std::vector<Polyline> ReadPublicPile(const std::string& name);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/polyline.h"
#include "models/mesh/mesh.h"

namespace tubetwin {

/// What a picture of a tube found in a mesh shows.
struct TubeFitPicture {
  std::vector<MeshPoint> wall;  ///< Samples of the outer wall.
  Polyline line;                ///< Their axis, same frame.
  double radius_m = 0.0;
  std::string title;
};

/// Picture (PNG, 1280 x 720): the samples with the axis over them, seen along their flattest
/// direction and from the side, and each sample's radius along the axis. Needs no EGL. Throws
/// Error(kCannotCreate | kIo).
void DrawTubeFit(const TubeFitPicture& fit, const std::string& path);

}  // namespace tubetwin

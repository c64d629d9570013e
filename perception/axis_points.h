#pragma once

#include <cstdint>
#include <vector>

#include "models/bin.h"
#include "perception/view_image.h"

namespace tubetwin {

/// A surface point with the place where a tube's axis would be behind it. Frame N.
struct SurfacePoint {
  Eigen::Vector3f p_N;
  Eigen::Vector3f n_N;  ///< Unit normal, towards the view's sensor.
  Eigen::Vector3f a_N;  ///< p - r n.
  float weight;         ///< Cosine of the incidence.
};

/// Which points can belong to a tube in, on or out over the bin; everything else is the known cell.
class Foreground {
 public:
  /// `margin_m`: how far outside the walls a tube may reach.
  Foreground(const Bin& bin, double margin_m);
  bool Contains(const Eigen::Vector3f& p_N) const;

 private:
  float half_x_, half_y_, wall_, margin_;
};

/// Foreground blocks of a view with a normal from a small window of their neighbours; grazing ones,
/// edges and blocks whose window is no smooth surface are left out. `foreground_blocks` counts all
/// that passed the bin's filter.
struct SurfaceOfView {
  std::vector<SurfacePoint> points;
  std::vector<Eigen::Vector3f> rejected_N;  ///< Foreground without a usable normal.
};
SurfaceOfView FindSurface(const ViewImage& view, const Foreground& foreground, double radius_m);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/polyline.h"
#include "models/bin.h"

namespace tubetwin {

/// A perceived scene as a picture shows it. Frame N.
struct PerceivedPicture {
  struct Tube {
    int id = 0;
    Polyline centerline_N;
    std::vector<char> node_visible;  ///< [centerline_N.size()]
    double radius_m = 0.0;
    int tube_class = 0;  ///< 0 free, 1 weak, 2 strong.
  };
  Bin bin;
  std::vector<Tube> tubes;
  Polyline unexplained_N;                ///< Places, in no order.
  std::vector<Polyline> unseen_floor_N;  ///< Lines that hatch what no view saw.
  Polyline cloud_N;                      ///< Points of a scan, in no order; at most 3000 are drawn.
  std::string caption;
};

/// Picture (PNG, 1280 x 720) of the bin from above at an angle: tubes in the colours of their
/// classes with their ids, a dark line along what of them is hidden, unexplained places in magenta,
/// the unseen floor hatched. Throws Error(kDevice) when there is no EGL, Error(kCannotCreate | kIo)
/// when the file cannot be written.
void RenderPerceivedPicture(const PerceivedPicture& seen, const std::string& path);

}  // namespace tubetwin

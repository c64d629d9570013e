#pragma once

#include <vector>

#include "models/mesh/mesh.h"

namespace tubetwin {

/// Statistics of a surface's local radius of curvature.
struct LocalRadius {
  double radius_m = 0.0;             ///< The most common one.
  double low_m = 0.0, high_m = 0.0;  ///< 10th and 90th percentile.
  double round_share = 0.0;          ///< Of the surface that is round and bulges out.
  std::vector<MeshPoint> points;     ///< Where it was measured.
  std::vector<double> radii_m;       ///< Of each; 0 where the surface is flat or bulges in.
};

/// Local radii from pairs of neighbouring points: on a cylinder p - q = r (n_p - n_q) around the
/// axis, so r = (p - q).(n_p - n_q) / |n_p - n_q|^2 wherever the two lie along it. Pairs whose
/// normals turn most per distance look around the axis rather than along a bend. Inner walls bulge
/// in: their pairs are negative and not counted, nor are flat ends. About 0.2 s.
LocalRadius FindLocalRadius(const Mesh& mesh);

/// Those of the samples that lie where the surface is round and bulges out.
std::vector<MeshPoint> RoundSurface(const LocalRadius& local,
                                    const std::vector<MeshPoint>& samples);

}  // namespace tubetwin

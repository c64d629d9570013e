#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "models/bin.h"

namespace tubetwin {

/// A plane that bounds a bin: n_N.p = offset on it, n_N into the bin.
struct BinPlane {
  Vector3 n_N;
  double offset_m;
};

/// The floor, then the inner faces of the walls at +x, -x, +y and -y of N.
inline constexpr std::size_t kBinPlanes = 5;
using BinPlanes = std::array<BinPlane, kBinPlanes>;

inline BinPlanes PlanesOf(const Bin& bin) {
  return {BinPlane{Vector3::UnitZ(), 0.0}, BinPlane{-Vector3::UnitX(), -bin.half_x_m()},
          BinPlane{Vector3::UnitX(), -bin.half_x_m()}, BinPlane{-Vector3::UnitY(), -bin.half_y_m()},
          BinPlane{Vector3::UnitY(), -bin.half_y_m()}};
}

/// "floor", "wall +x", ...
inline const char* NameOfPlane(std::size_t k) {
  constexpr std::array<const char*, kBinPlanes> names = {"floor", "wall +x", "wall -x", "wall +y",
                                                         "wall -y"};
  return names.at(k);
}

/// Whether a point near plane `k` lies `inset_m` or more within its part that bounds the bin: off
/// the other planes and the rim.
inline bool WithinPlane(const Bin& bin, std::size_t k, const Vector3& p_N, double inset_m) {
  const bool in_x = std::abs(p_N.x()) < bin.half_x_m() - inset_m;
  const bool in_y = std::abs(p_N.y()) < bin.half_y_m() - inset_m;
  const bool in_z = p_N.z() > inset_m && p_N.z() < bin.wall_m() - inset_m;
  return k == 0 ? in_x && in_y : (k <= 2 ? in_y : in_x) && in_z;
}

}  // namespace tubetwin

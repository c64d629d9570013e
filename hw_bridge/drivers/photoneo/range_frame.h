#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// Bytes of one range image as GigE Vision carries it: pixel format Coord3D_ABC32f, that is x y z
/// as little-endian float32, row by row from the top left.
struct RangeImage {
  int width = 0, height = 0;
  const void* data = nullptr;  ///< Need not be aligned.
  std::size_t bytes = 0;
  double metres_per_unit = 1e-3;
};

/// The cloud in S, without pose; points that are 0 0 0 or not a number become invalid. Otherwise
/// what is wrong: the bytes are not those of width x height points.
std::variant<OrganizedCloud, std::string> CloudOfRange(const RangeImage& image);

}  // namespace tubetwin

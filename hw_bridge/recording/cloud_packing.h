#pragma once

#include <string>
#include <string_view>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// A cloud as bytes that compress well: which pixels are valid, each depth as its difference to
/// the neighbours', x and y as what is left after the pixel's ray times the depth (nothing, for a
/// camera whose image has straight columns and rows), all of it by byte planes. Every number of a
/// valid point, intensity, label and pose comes back with the same bits; invalid points come back
/// as InvalidPoint().
std::string PackCloud(const OrganizedCloud& cloud_S);

/// Largest cloud that can be recorded, pixels.
inline constexpr std::size_t kMaxCloudPixels = std::size_t{1} << 24;

/// Throws Error(kBadData) naming source and byte for bytes that are no such cloud, before anything
/// is allocated that they cannot fill.
OrganizedCloud UnpackCloud(std::string_view bytes, const std::string& source);

}  // namespace tubetwin

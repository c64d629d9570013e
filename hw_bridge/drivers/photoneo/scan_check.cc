#include "hw_bridge/drivers/photoneo/scan_check.h"

#include "models/base/text.h"

namespace tubetwin {

std::optional<std::string> NoScan(const OrganizedCloud& cloud) {
  constexpr float kMaxDistance_m = 20.0f;
  constexpr double kMaxShare = 0.001;
  if (!cloud.organized()) {
    return "the cloud has " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
           " points, an organised one (rows of the camera's image) is needed";
  }
  std::size_t valid = 0, wrong = 0, first = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.p_SP[i];
    if (!IsValid(p)) continue;
    ++valid;
    if (p.z() > 0 && p.squaredNorm() <= kMaxDistance_m * kMaxDistance_m) continue;
    if (wrong++ == 0) first = i;
  }
  if (static_cast<double>(wrong) <= kMaxShare * static_cast<double>(valid)) return std::nullopt;
  const Eigen::Vector3f& p = cloud.p_SP[first];
  return std::to_string(wrong) + " of " + std::to_string(valid) +
         " points lie behind the scanner or over 20 m away, first point " + std::to_string(first) +
         " at (" + Number(p.x()) + ", " + Number(p.y()) + ", " + Number(p.z()) +
         ") m: the data are damaged or not in the scanner's frame";
}

}  // namespace tubetwin

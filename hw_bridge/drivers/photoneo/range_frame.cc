#include "hw_bridge/drivers/photoneo/range_frame.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace tubetwin {

static_assert(std::endian::native == std::endian::little, "points are read as they came");

std::variant<OrganizedCloud, std::string> CloudOfRange(const RangeImage& image) {
  constexpr std::size_t kPointBytes = 12;
  const auto width = static_cast<std::size_t>(image.width < 0 ? 0 : image.width);
  const auto height = static_cast<std::size_t>(image.height < 0 ? 0 : image.height);
  // Divided, not multiplied: sizes come over the wire and may be anything.
  const bool fits = width > 0 && height > 0 && image.bytes % (width * kPointBytes) == 0 &&
                    image.bytes / (width * kPointBytes) == height;
  if (!fits) {
    return "a range image of " + std::to_string(image.width) + " x " +
           std::to_string(image.height) + " points came with " + std::to_string(image.bytes) +
           " bytes, which is not 12 for each";
  }
  OrganizedCloud cloud;
  cloud.width = image.width;
  cloud.height = image.height;
  cloud.p_SP.resize(width * height);
  const auto* bytes = static_cast<const std::byte*>(image.data);
  for (Eigen::Vector3f& p : cloud.p_SP) {
    std::array<float, 3> c;
    std::memcpy(c.data(), bytes, kPointBytes);
    bytes += kPointBytes;
    const bool empty = c[0] == 0.0f && c[1] == 0.0f && c[2] == 0.0f;
    if (empty || std::isnan(c[0]) || std::isnan(c[1]) || std::isnan(c[2])) {
      p = InvalidPoint();
      continue;
    }
    for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(c[k] * image.metres_per_unit);
  }
  return cloud;
}

}  // namespace tubetwin

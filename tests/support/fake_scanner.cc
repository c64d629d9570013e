#include "tests/support/fake_scanner.h"

#include "models/base/random.h"

namespace tubetwin {

OrganizedCloud SomeScan(std::uint64_t seed, int width, int height) {
  RandomStream stream(seed, 0, "some scan");
  OrganizedCloud cloud;
  cloud.width = width;
  cloud.height = height;
  for (int i = 0; i < width * height; ++i) {
    const bool valid = stream.Uniform() < 0.8;
    const auto z = static_cast<float>(stream.Uniform(0.35, 0.6));
    const float x = z * (static_cast<float>(i % width) - 0.5f * static_cast<float>(width)) /
                    static_cast<float>(width);
    const float y = z * (static_cast<float>(i / width) - 0.5f * static_cast<float>(height)) /
                    static_cast<float>(width);
    cloud.p_SP.push_back(valid ? Eigen::Vector3f(x, y, z) : InvalidPoint());
    cloud.label.push_back(kLabelCell);
  }
  cloud.X_NS = Translation(9, 9, 9);
  return cloud;
}

}  // namespace tubetwin

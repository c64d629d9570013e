#pragma once

#include <cstdint>
#include <vector>

#include "models/base/frames.h"
#include "models/base/parallel.h"
#include "models/base/random.h"

namespace tubetwin {

/// Unit-variance noise image whose neighbours correlate: white noise smoothed by the binomial 1 4 6
/// 4 1 in both directions (sigma 1 px: correlation exp(-d^2 / 4), half at 1.7 px, so spots are 3 to
/// 4 px wide). A white value is the sum of four random bytes, a smoothed one that of 100: Gaussian
/// but for an excess kurtosis of -0.04. Immutable after construction; depends on the stream only.
class CorrelatedNoise {
 public:
  CorrelatedNoise(const RandomStream& stream, int width, int height, Parallelism parallelism);
  /// One row, `width` values.
  void Row(int row, float* out) const;

 private:
  int width_;
  std::vector<std::int16_t> smoothed_;  ///< Along the rows only; two rows more on either side.
};

/// Smooth random field over space, zero mean: 16 plane waves of one length in random directions.
/// Its rms is exact over all space; over a scanner's field, some wavelengths wide, it scatters by
/// some 15 % from seed to seed. Evaluated by linear interpolation on a lattice (2 % of the rms).
/// Immutable after construction.
class BiasField {
 public:
  /// For points within the box from `low` to `high`, metres.
  BiasField(std::uint64_t seed, double rms, double wavelength_m, const Eigen::Vector3f& low,
            const Eigen::Vector3f& high);
  float At(const Eigen::Vector3f& p) const;

 private:
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  float per_step_ = 0;
  Eigen::Array3i nodes_ = Eigen::Array3i::Zero();
  std::vector<float> values_;  ///< x fastest.
};

}  // namespace tubetwin

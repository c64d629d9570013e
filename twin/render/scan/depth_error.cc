#include "twin/render/scan/depth_error.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr int kReach = 2;       // Of the binomial, pixels.
constexpr int kBandRows = 16;   // Work unit of a thread.
constexpr int kByteMean = 510;  // Of a sum of four bytes.
constexpr int kWaves = 16;
constexpr int kStepsPerWave = 12;

/// Four bytes of each word added up, less their mean.
void WhiteRow(const RandomStream& stream, std::uint64_t first_block,
              std::vector<std::int16_t>& out) {
  for (std::size_t i = 0; i < out.size(); i += 4) {
    const auto block = stream.Block(first_block + i / 4);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t pairs = (block[k] & 0xff00ffu) + ((block[k] >> 8) & 0xff00ffu);
      out[i + k] = static_cast<std::int16_t>(((pairs & 0xffffu) + (pairs >> 16)) - kByteMean);
    }
  }
}

}  // namespace

CorrelatedNoise::CorrelatedNoise(const RandomStream& stream, int width, int height,
                                 Parallelism parallelism)
    : width_(width) {
  const int rows = height + 2 * kReach;
  smoothed_.resize(static_cast<std::size_t>(rows) * width);
  const std::size_t padded = (static_cast<std::size_t>(width) + 2 * kReach + 3) / 4 * 4;
  ParallelFor((rows + kBandRows - 1) / kBandRows, parallelism, [&](int band, int) {
    std::vector<std::int16_t> white(padded);
    for (int row = band * kBandRows; row < std::min((band + 1) * kBandRows, rows); ++row) {
      WhiteRow(stream, static_cast<std::uint64_t>(row) * (padded / 4), white);
      const std::int16_t* w = white.data();
      std::int16_t* out = &smoothed_[static_cast<std::size_t>(row) * width];
      for (int c = 0; c < width; ++c) {  // At most 16 * 510: fits.
        out[c] =
            static_cast<std::int16_t>(w[c] + w[c + 4] + 4 * (w[c + 1] + w[c + 3]) + 6 * w[c + 2]);
      }
    }
  });
}

void CorrelatedNoise::Row(int row, float* out) const {
  // Variance of four uniform bytes, and of the binomial in both directions.
  static const float kScale = static_cast<float>(
      1.0 / (std::sqrt(4.0 * (256.0 * 256.0 - 1.0) / 12.0) * (1.0 + 16.0 + 36.0 + 16.0 + 1.0)));
  const std::int16_t* r = &smoothed_[static_cast<std::size_t>(row) * width_];
  const std::int16_t *a = r, *b = r + width_, *c = b + width_, *d = c + width_, *e = d + width_;
  for (int i = 0; i < width_; ++i) {
    out[i] = kScale * static_cast<float>(a[i] + e[i] + 4 * (b[i] + d[i]) + 6 * c[i]);
  }
}

BiasField::BiasField(std::uint64_t seed, double rms, double wavelength_m,
                     const Eigen::Vector3f& low, const Eigen::Vector3f& high)
    : low_(low) {
  const double step_m = wavelength_m / kStepsPerWave;
  per_step_ = static_cast<float>(1.0 / step_m);
  nodes_ = ((high - low).array().max(0.0f) * per_step_).ceil().cast<int>() + 2;
  RandomStream stream(seed, 0, "scanner bias");
  const double amplitude = rms * std::sqrt(2.0 / kWaves);
  values_.assign(static_cast<std::size_t>(nodes_.prod()), 0.0f);
  for (int wave = 0; wave < kWaves; ++wave) {
    Vector3 direction;
    for (double& v : direction) v = stream.Normal();
    const Vector3 k = 2.0 * kPi / wavelength_m * direction.normalized();
    const double phase = stream.Uniform(0, 2.0 * kPi);
    // Along a row of nodes the wave turns by the same angle from node to node.
    const double turn_cos = std::cos(k.x() * step_m), turn_sin = std::sin(k.x() * step_m);
    float* out = values_.data();
    for (int z = 0; z < nodes_.z(); ++z) {
      for (int y = 0; y < nodes_.y(); ++y) {
        const double start = k.dot(low.cast<double>() + step_m * Vector3(0, y, z)) + phase;
        double c = amplitude * std::cos(start), s = amplitude * std::sin(start);
        for (int x = 0; x < nodes_.x(); ++x) {
          *out++ += static_cast<float>(c);
          const double turned = c * turn_cos - s * turn_sin;
          s = c * turn_sin + s * turn_cos;
          c = turned;
        }
      }
    }
  }
}

float BiasField::At(const Eigen::Vector3f& p) const {
  const Eigen::Array3f at = (p - low_).array() * per_step_;
  const Eigen::Array3i cell = at.cast<int>().max(0).min(nodes_ - 2);
  const Eigen::Array3f u = at - cell.cast<float>();
  const std::size_t row = nodes_.x(), layer = row * nodes_.y();
  const float* v = &values_[cell.z() * layer + cell.y() * row + cell.x()];
  const auto along_x = [&](const float* w) { return w[0] + u.x() * (w[1] - w[0]); };
  const float near_0 = along_x(v), near_1 = along_x(v + row);
  const float far_0 = along_x(v + layer), far_1 = along_x(v + layer + row);
  const float near = near_0 + u.y() * (near_1 - near_0), far = far_0 + u.y() * (far_1 - far_0);
  return near + u.z() * (far - near);
}

}  // namespace tubetwin

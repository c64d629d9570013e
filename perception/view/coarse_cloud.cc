#include "perception/view/coarse_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>

namespace tubetwin {
namespace {

/// Windows that are looked at, and which of them, by residual, counts as smooth.
constexpr int kWindows = 4000;
constexpr double kSmoothShare = 0.25;
/// A window with a larger step in depth shows an edge.
constexpr double kStep_m = 0.03;
/// Noise of a block, over the radius, with which perception/fragment finds normals for hardly any
/// point: it takes those of windows that are 0.035 radii rough at most.
constexpr double kRoughOverRadius = 0.03;
/// Blocks of MakeViewRaster have about this pitch.
constexpr double kFine_m = 0.0012;
/// Coarse pixels are averaged up to this pitch first.
constexpr double kCoarse_m = 0.0025;
/// Largest noise and spacing, over the radius, that smoothing makes up for.
constexpr double kMaxNoise = 0.2, kMaxSpacing = 0.4;
/// Sigma of the weights by distance, over the radius, and the window's half width in it.
constexpr double kWeightOverRadius = 0.4;
constexpr int kMaxHalf = 4;
/// Points this far in depth, over the radius, are of another surface.
constexpr double kGateOverRadius = 0.9;
/// Least sum of weights of a fit of six numbers.
constexpr double kLeastWeight = 5.0;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Vector6 Powers(double x, double y) {
  Vector6 out;
  out << 1.0, x, y, x * x, x * y, y * y;
  return out;
}

/// Squared residual per degree of freedom of the window around a pixel; nothing at holes and edges.
std::optional<double> WindowVariance(const ViewRaster& raster, int column, int row) {
  Matrix6 A = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  double zz = 0.0, near = 1e9, far = -1e9;
  const double middle = raster.At(column, row).z();
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      const Eigen::Vector3f& p = raster.At(column + i, row + j);
      if (!(p.z() >= kNearest_m)) return std::nullopt;
      const double z = p.z() - middle;
      near = std::min(near, z);
      far = std::max(far, z);
      const Vector6 q = Powers(i, j);
      A += q * q.transpose();
      b += z * q;
      zz += z * z;
    }
  }
  if (far - near > kStep_m) return std::nullopt;
  constexpr double kFreedom = 25.0 - 6.0;
  return std::max(0.0, zz - b.dot(A.ldlt().solve(b))) / kFreedom;
}

/// Depths of coarse pixels: means of squares of the raster's pixels.
struct DepthGrid {
  int width = 0, height = 0;
  double fx = 1, fy = 1, cx = 0, cy = 0;
  std::vector<double> z;  ///< NaN without return.
  double At(int column, int row) const {
    return z[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(column)];
  }
};

DepthGrid Averaged(const ViewRaster& raster, int side, double step_m) {
  DepthGrid out;
  out.width = raster.width / side;
  out.height = raster.height / side;
  out.fx = raster.fx / side;
  out.fy = raster.fy / side;
  out.cx = (raster.cx - 0.5 * (side - 1)) / side;
  out.cy = (raster.cy - 0.5 * (side - 1)) / side;
  for (int row = 0; row < out.height; ++row) {
    for (int column = 0; column < out.width; ++column) {
      double sum = 0.0, n = 0.0, near = 1e9, far = 0.0;
      for (int k = 0; k < side * side; ++k) {
        const Eigen::Vector3f& p = raster.At(column * side + k % side, row * side + k / side);
        if (!(p.z() >= kNearest_m)) continue;
        sum += p.z();
        ++n;
        near = std::min<double>(near, p.z());
        far = std::max<double>(far, p.z());
      }
      out.z.push_back(n > 0 && far - near < step_m ? sum / n : std::nan(""));
    }
  }
  return out;
}

/// Fits surfaces around places of a grid.
class LocalSurface {
 public:
  LocalSurface(const DepthGrid& grid, const CloudGrain& grain, double radius_m, double pixel_m)
      : grid_(grid),
        sigma_px_(std::clamp(kWeightOverRadius * radius_m / pixel_m, 1.0, 0.5 * kMaxHalf)),
        half_(static_cast<int>(std::ceil(2.0 * sigma_px_))),
        gate_m_(kGateOverRadius * radius_m),
        scale_m_(std::max(2.0 * grain.noise_m, 0.1 * radius_m)) {}

  /// Depth at a place in coarse pixels; NaN where too little is seen.
  double DepthAt(double x, double y) const {
    const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
    if (column < 0 || row < 0 || column >= grid_.width || row >= grid_.height) return kNone;
    const double middle = MedianAround(column, row);
    if (!(middle == middle)) return kNone;
    Vector6 surface = Vector6::Zero();
    surface[0] = middle;
    for (int round = 0; round < 3; ++round) {
      if (!Fit(x, y, column, row, round, surface)) return kNone;
    }
    return surface[0];
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  /// Of the pixel and its four neighbours; NaN when the pixel is empty.
  double MedianAround(int column, int row) const {
    if (!(grid_.At(column, row) == grid_.At(column, row))) return kNone;
    std::array<double, 5> near{};
    std::size_t n = 0;
    constexpr int kSteps[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto& step : kSteps) {
      const int c = column + step[0], r = row + step[1];
      if (c < 0 || r < 0 || c >= grid_.width || r >= grid_.height) continue;
      const double z = grid_.At(c, r);
      if (!(z == z)) continue;
      near[n] = z;
      for (std::size_t k = n++; k > 0 && near[k] < near[k - 1]; --k) {
        std::swap(near[k], near[k - 1]);  // Few: sorted as they come.
      }
    }
    return near[n / 2];
  }

  /// One round: the first takes what is near in depth, the others what is near the surface so far.
  bool Fit(double x, double y, int column, int row, int round, Vector6& surface) const {
    Matrix6 A = 1e-6 * Matrix6::Identity();
    Vector6 b = Vector6::Zero();
    double weight = 0.0;
    for (int r = std::max(0, row - half_); r <= std::min(grid_.height - 1, row + half_); ++r) {
      for (int c = std::max(0, column - half_); c <= std::min(grid_.width - 1, column + half_);
           ++c) {
        const double z = grid_.At(c, r);
        if (!(z == z)) continue;
        const double dx = (c - x) / sigma_px_, dy = (r - y) / sigma_px_;
        const Vector6 q = Powers(dx, dy);
        const double residual = z - q.dot(surface);
        if (std::abs(residual) > gate_m_) continue;
        double w = std::exp(-0.5 * (dx * dx + dy * dy));
        if (round > 0) {
          const double share = scale_m_ * scale_m_ / (scale_m_ * scale_m_ + residual * residual);
          w *= share * share;
        }
        A += w * q * q.transpose();
        b += w * z * q;
        weight += w;
      }
    }
    if (weight < kLeastWeight) return false;
    surface = A.ldlt().solve(b);
    return true;
  }

  const DepthGrid& grid_;
  const double sigma_px_;
  const int half_;
  const double gate_m_, scale_m_;
};

}  // namespace

CloudGrain MeasureGrain(const ViewRaster& raster) {
  CloudGrain out;
  out.spacing_m = raster.pitch_m / raster.block;
  const double pixels = static_cast<double>(raster.width) * raster.height;
  const int step = std::max(1, static_cast<int>(std::sqrt(pixels / kWindows)));
  std::vector<double> variances;
  for (int row = 2 + step / 2; row + 2 < raster.height; row += step) {
    for (int column = 2 + step / 2; column + 2 < raster.width; column += step) {
      if (const auto v = WindowVariance(raster, column, row)) variances.push_back(*v);
    }
  }
  if (variances.empty()) return out;
  const auto at = variances.begin() +
                  static_cast<std::ptrdiff_t>(kSmoothShare * static_cast<double>(variances.size()));
  std::nth_element(variances.begin(), at, variances.end());
  out.noise_m = std::sqrt(*at);
  return out;
}

bool IsCoarse(const CloudGrain& grain, const ViewRaster& raster, double radius_m) {
  return grain.noise_m / raster.block > kRoughOverRadius * radius_m;
}

std::string TooCoarse(const CloudGrain& grain, double radius_m) {
  if (grain.noise_m <= kMaxNoise * radius_m && grain.spacing_m <= kMaxSpacing * radius_m) return {};
  char text[240];
  std::snprintf(text, sizeof text,
                "points %.1f mm apart with %.1f mm of noise are too coarse for tubes of %.1f mm "
                "radius: the profile best needs %.1f mm and %.1f mm; use --profile leao2020 or a "
                "finer scan",
                1e3 * grain.spacing_m, 1e3 * grain.noise_m, 1e3 * radius_m,
                1e3 * kMaxSpacing * radius_m, 1e3 * kMaxNoise * radius_m);
  return text;
}

OrganizedCloud SmoothCoarse(const ViewRaster& raster, const CloudGrain& grain, double radius_m,
                            Parallelism parallelism) {
  const int side = std::max(1, static_cast<int>(std::lround(kCoarse_m / grain.spacing_m)));
  const double pixel_m = grain.spacing_m * side;
  const DepthGrid grid = Averaged(raster, side, kGateOverRadius * radius_m);
  const int finer = std::max(1, static_cast<int>(std::lround(pixel_m / kFine_m)));
  OrganizedCloud out;
  out.X_NS = raster.X_NS;
  out.width = grid.width * finer;
  out.height = grid.height * finer;
  out.p_SP.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height),
                  InvalidPoint());
  const LocalSurface surface(grid, grain, radius_m, pixel_m);
  ParallelFor(out.height, parallelism, [&](int row, int) {
    const double y = (row + 0.5) / finer - 0.5;
    for (int column = 0; column < out.width; ++column) {
      const double x = (column + 0.5) / finer - 0.5;
      const double z = surface.DepthAt(x, y);
      if (!(z >= kNearest_m)) continue;
      out.p_SP[static_cast<std::size_t>(row) * static_cast<std::size_t>(out.width) +
               static_cast<std::size_t>(column)] =
          Vector3((x - grid.cx) / grid.fx * z, (y - grid.cy) / grid.fy * z, z).cast<float>();
    }
  });
  return out;
}

}  // namespace tubetwin

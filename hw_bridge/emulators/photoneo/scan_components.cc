#include "hw_bridge/emulators/photoneo/scan_components.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <tuple>

namespace tubetwin {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are sent as they are in memory");

constexpr ScanComponentInfo kInfos[kScanComponents] = {
    {"Intensity", 1, GvspData::kImage2d, kPixelMono10},
    {"Range", 4, GvspData::kImage3d, kPixelCoord3dAbc32f},
    {"Confidence", 6, GvspData::kConfidence, kPixelConfidence8},
    {"CoordinateMapA", 10, GvspData::kImage3d, kPixelCoord3dA32f},
    {"CoordinateMapB", 11, GvspData::kImage3d, kPixelCoord3dB32f},
    {"Normal", 0xff00, GvspData::kImage3d, kPixelCoord3dAbc32f},
};

/// Neighbours whose line to the point is steeper than this slope lie behind a jump of depth.
constexpr double kSteepest = 6.0;  // 80 degrees, where the scanner sees nothing any more.
constexpr int kLeastNeighbours = 4;
/// Neighbours in a line tell no plane: how much less they spread across it than along it, squared.
constexpr double kLine = 0.01;
constexpr float kSteepestCosine = 0.17364818f;  // 80 degrees, as the noise of the twin's scanner.

template <class Value>
void Put(std::vector<std::byte>& out, const Value& value) {
  const auto bytes = std::bit_cast<std::array<std::byte, sizeof value>>(value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// Fits planes to the points around a pixel that no jump of depth parts from it. Errors of a
/// scanner are along its rays: what is fitted is 1/z, which a plane n p = d has as (n/d) (x/z, y/z,
/// 1).
class PlaneFit {
 public:
  PlaneFit(const OrganizedCloud& cloud, const ScanOptics& optics, int radius)
      : cloud_(cloud), focal_px_(optics.focal_px), radius_(radius) {}

  PointSurface At(int row, int column) {
    const Eigen::Vector3d centre = Point(row, column).cast<double>();
    sums_ = {};
    for (int r = std::max(0, row - radius_); r <= std::min(cloud_.height - 1, row + radius_); ++r) {
      for (int c = std::max(0, column - radius_); c <= std::min(cloud_.width - 1, column + radius_);
           ++c) {
        const Eigen::Vector3d p = Point(r, c).cast<double>();
        if (!(p.z() > 0)) continue;  // Empty pixels too.
        const int pixels = std::max(std::abs(r - row), std::abs(c - column));
        const double reach = kSteepest * pixels * centre.z() / focal_px_;
        if ((p - centre).squaredNorm() <= reach * reach) Add(p, centre);
      }
    }
    return Solve(centre);
  }

 private:
  /// Of u = x/z, v = y/z and w = 1/z, each from the centre's on.
  struct Sums {
    double n = 0, u = 0, v = 0, w = 0, uu = 0, uv = 0, vv = 0, uw = 0, vw = 0;
  };

  const Eigen::Vector3f& Point(int row, int column) const {
    return cloud_.p_SP[static_cast<std::size_t>(row) * cloud_.width + column];
  }

  void Add(const Eigen::Vector3d& p, const Eigen::Vector3d& centre) {
    const double w = 1 / p.z(), u = p.x() * w - centre.x() / centre.z();
    const double v = p.y() * w - centre.y() / centre.z(), dw = w - 1 / centre.z();
    sums_.n += 1;
    sums_.u += u;
    sums_.v += v;
    sums_.w += dw;
    sums_.uu += u * u;
    sums_.uv += u * v;
    sums_.vv += v * v;
    sums_.uw += u * dw;
    sums_.vw += v * dw;
  }

  PointSurface Solve(const Eigen::Vector3d& centre) const {
    const auto& [n, u, v, w, uu, uv, vv, uw, vw] = sums_;
    if (n < kLeastNeighbours) return {};
    const double s_uu = uu - u * u / n, s_uv = uv - u * v / n, s_vv = vv - v * v / n;
    const double s_uw = uw - u * w / n, s_vw = vw - v * w / n;
    const double determinant = s_uu * s_vv - s_uv * s_uv, spread = s_uu + s_vv;
    if (!(determinant > kLine * spread * spread)) return {};
    const double du = (s_uw * s_vv - s_vw * s_uv) / determinant;
    const double dv = (s_vw * s_uu - s_uw * s_uv) / determinant;
    const double at_centre = 1 / centre.z() + (w - du * u - dv * v) / n;
    const Eigen::Vector3d plane(
        du, dv, at_centre - du * centre.x() / centre.z() - dv * centre.y() / centre.z());
    const double length = plane.norm();
    return {(-plane / length).cast<float>(),
            static_cast<float>(std::abs(plane.dot(centre) - 1) / length)};
  }

  const OrganizedCloud& cloud_;
  const double focal_px_;
  const int radius_;
  Sums sums_;
};

void PutNormal(std::vector<std::byte>& out, Eigen::Vector3f normal, std::uint32_t format) {
  if (normal.isZero()) normal = Eigen::Vector3f::UnitZ();
  if (format == kPixelCoord3dAbc32f) {
    for (int k = 0; k < 3; ++k) Put(out, normal[k]);
    return;
  }
  // Azimuth in 256ths of a turn, angle to z in 256ths of half a turn.
  const float azimuth = std::atan2(normal.y(), normal.x());
  const float polar = std::acos(std::clamp(normal.z(), -1.0f, 1.0f));
  constexpr float kPi = std::numbers::pi_v<float>;
  Put(out, static_cast<std::uint8_t>(std::lround(azimuth * 128 / kPi) & 0xff));
  Put(out, static_cast<std::uint8_t>(std::min(255L, std::lround(polar * 256 / kPi))));
}

void PutRange(std::vector<std::byte>& out, const Eigen::Vector3f& p, std::uint32_t format) {
  Eigen::Vector3f mm = Eigen::Vector3f::Zero();
  if (IsValid(p)) mm = (p.cast<double>() * 1000.0).cast<float>();
  for (int k = format == kPixelCoord3dAbc32f ? 0 : 2; k < 3; ++k) Put(out, mm[k]);
}

std::uint16_t Mono10(float brightness) {
  constexpr float kWhite = 1023;
  return static_cast<std::uint16_t>(std::lround(std::clamp(brightness, 0.0f, 1.0f) * kWhite));
}

}  // namespace

const ScanComponentInfo& InfoOf(ScanComponent component) {
  return kInfos[static_cast<std::size_t>(component)];
}

std::vector<PointSurface> SurfacesOf(const OrganizedCloud& cloud, const ScanOptics& optics,
                                     int radius) {
  std::vector<PointSurface> surfaces(cloud.size());
  PlaneFit fit(cloud, optics, radius);
  for (int row = 0; row < cloud.height; ++row) {
    for (int column = 0; column < cloud.width; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * cloud.width + column;
      if (cloud.p_SP[at].z() > 0) surfaces[at] = fit.At(row, column);
    }
  }
  return surfaces;
}

std::uint8_t ConfidenceOf(const Eigen::Vector3f& p_SP, const PointSurface& surface,
                          const ScanOptics& optics) {
  if (surface.normal.isZero()) return 1;
  const float cosine = std::max(-surface.normal.dot(p_SP.normalized()), kSteepestCosine);
  const double far = p_SP.z() / optics.sweet_spot_m;
  const double expected_m = optics.sigma_m * far * far / cosine;
  const double share = optics.sigma_m / std::max<double>(expected_m, surface.off_m);
  return static_cast<std::uint8_t>(std::clamp(std::lround(255 * share), 1L, 255L));
}

std::vector<std::byte> ComponentBytes(const OrganizedCloud& cloud, ScanComponent component,
                                      std::uint32_t pixel_format, const ScanOptics& optics,
                                      int normals_radius) {
  constexpr int kConfidenceRadius = 1;
  std::vector<PointSurface> surfaces;
  if (component == ScanComponent::kConfidence) {
    surfaces = SurfacesOf(cloud, optics, kConfidenceRadius);
  } else if (component == ScanComponent::kNormal) {
    surfaces = SurfacesOf(cloud, optics, normals_radius);  // Radius 0: too few neighbours.
  }
  std::vector<std::byte> out;
  out.reserve(cloud.size() * BytesPerPixel(pixel_format));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.p_SP[i];
    const std::size_t row = i / static_cast<std::size_t>(cloud.width);
    switch (component) {
      case ScanComponent::kIntensity:
        Put(out, Mono10(cloud.intensity.empty() ? 0.0f : cloud.intensity[i]));
        break;
      case ScanComponent::kRange:
        PutRange(out, p, pixel_format);
        break;
      case ScanComponent::kConfidence:
        Put(out, IsValid(p) ? ConfidenceOf(p, surfaces[i], optics) : std::uint8_t{0});
        break;
      case ScanComponent::kMapA:
        Put(out, static_cast<float>(i % static_cast<std::size_t>(cloud.width)));
        break;
      case ScanComponent::kMapB:
        Put(out, static_cast<float>(row));
        break;
      case ScanComponent::kNormal:
        PutNormal(out, surfaces[i].normal, pixel_format);
        break;
    }
  }
  return out;
}

}  // namespace tubetwin

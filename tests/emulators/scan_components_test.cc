#include "hw_bridge/emulators/photoneo/scan_components.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr ScanOptics kOptics = {100.0, 0.442, 0.00005};

/// The point at depth 1 of a pixel.
Eigen::Vector3d Ray(int row, int column) {
  return {(column - 0.5 * (kWidth - 1)) / kOptics.focal_px,
          (row - 0.5 * (kHeight - 1)) / kOptics.focal_px, 1.0};
}

/// What the camera sees of the plane of all points p with normal * p = distance.
OrganizedCloud PlaneScan(const Eigen::Vector3d& normal, double distance_m, double sigma_m = 0) {
  RandomStream stream(1, 0, "plane");
  OrganizedCloud cloud;
  cloud.width = kWidth;
  cloud.height = kHeight;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const Eigen::Vector3d ray = Ray(row, column);
      const double z = distance_m / normal.dot(ray) + stream.Normal(0, sigma_m);
      cloud.p_SP.push_back((ray * z).cast<float>());
      cloud.intensity.push_back(0.5f);
    }
  }
  return cloud;
}

const Eigen::Vector3d kTilted = Eigen::Vector3d(0.3, -0.4, -0.87).normalized();

template <class Value>
std::vector<Value> Pixels(const OrganizedCloud& cloud, ScanComponent component,
                          std::uint32_t format, int normals_radius = 1) {
  const std::vector<std::byte> bytes =
      ComponentBytes(cloud, component, format, kOptics, normals_radius);
  REQUIRE(bytes.size() == cloud.size() * BytesPerPixel(format));
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST_CASE("Normals stand on the surface, towards the camera", "[unit]") {
  const OrganizedCloud cloud = PlaneScan(kTilted, -0.4);
  for (const int radius : {1, 4}) {
    const auto normals = Pixels<float>(cloud, ScanComponent::kNormal, kPixelCoord3dAbc32f, radius);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f normal(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
      if ((normal.cast<double>() - kTilted).norm() > 1e-3) {
        FAIL("pixel " << i << ": " << normal.transpose());
      }
    }
  }
}

TEST_CASE("A wider neighbourhood makes normals of a noisy surface steadier", "[unit]") {
  const OrganizedCloud cloud = PlaneScan(kTilted, -0.4, 0.0005);
  const auto worst_deg = [&cloud](int radius) {
    double sum = 0;
    for (const PointSurface& each : SurfacesOf(cloud, kOptics, radius)) {
      sum += std::acos(std::min(1.0, each.normal.cast<double>().dot(kTilted)));
    }
    return sum / static_cast<double>(cloud.size()) * 180 / std::numbers::pi;
  };
  CHECK(worst_deg(1) > 1.0);
  CHECK(worst_deg(4) < 0.3 * worst_deg(1));
}

TEST_CASE("A jump of depth bends no normal, and empty or lonely points have none", "[unit]") {
  OrganizedCloud cloud = PlaneScan(kTilted, -0.4);
  const OrganizedCloud behind = PlaneScan(kTilted, -0.6);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = kWidth / 2; column < kWidth; ++column) {
      const auto at = static_cast<std::size_t>(row * kWidth + column);
      cloud.p_SP[at] = behind.p_SP[at];
    }
  }
  // One lonely point in a hole.
  const int hole_row = 10, hole_column = 10;
  for (int row = hole_row - 2; row <= hole_row + 2; ++row) {
    for (int column = hole_column - 2; column <= hole_column + 2; ++column) {
      if (row == hole_row && column == hole_column) continue;
      cloud.p_SP[static_cast<std::size_t>(row * kWidth + column)] = InvalidPoint();
    }
  }
  const auto normals = Pixels<float>(cloud, ScanComponent::kNormal, kPixelCoord3dAbc32f, 1);
  const auto confidence =
      Pixels<std::uint8_t>(cloud, ScanComponent::kConfidence, kPixelConfidence8);
  const auto normal = [&normals](int row, int column) {
    const auto at = static_cast<std::size_t>(row * kWidth + column) * 3;
    return Eigen::Vector3d(normals[at], normals[at + 1], normals[at + 2]);
  };
  for (const int column : {kWidth / 2 - 1, kWidth / 2}) {
    CHECK((normal(24, column) - kTilted).norm() < 1e-3);
  }
  CHECK(normal(hole_row, hole_column) == Eigen::Vector3d(0, 0, 1));
  CHECK(normal(hole_row, hole_column + 1) == Eigen::Vector3d(0, 0, 1));
  CHECK(confidence[hole_row * kWidth + hole_column] == 1);
  CHECK(confidence[hole_row * kWidth + hole_column + 1] == 0);
  // Not asked for: none are known.
  const auto none = Pixels<float>(cloud, ScanComponent::kNormal, kPixelCoord3dAbc32f, 0);
  CHECK(none[0] == 0);
  CHECK(none[2] == 1);
}

TEST_CASE("Two angles of 8 bits tell a normal too", "[unit]") {
  const OrganizedCloud cloud = PlaneScan(kTilted, -0.4);
  const auto angles = Pixels<std::uint8_t>(cloud, ScanComponent::kNormal, kPixelCoord3dAc8);
  // As Photoneo's example reads them.
  const double azimuth = angles[0] * std::numbers::pi / 128;
  const double polar = angles[1] * std::numbers::pi / 256;
  const Eigen::Vector3d normal(std::sin(polar) * std::cos(azimuth),
                               std::sin(polar) * std::sin(azimuth), std::cos(polar));
  CHECK(std::acos(normal.dot(kTilted)) < 0.02);  // Half a step of both.
  OrganizedCloud empty = cloud;
  for (auto& p : empty.p_SP) p = InvalidPoint();
  CHECK(Pixels<std::uint8_t>(empty, ScanComponent::kNormal, kPixelCoord3dAc8)[1] == 0);
}

TEST_CASE("Confidence falls with distance, incidence and what the neighbours contradict",
          "[unit]") {
  const Eigen::Vector3d facing(0, 0, -1);
  const auto at_centre = [](const OrganizedCloud& cloud) {
    return Pixels<std::uint8_t>(cloud, ScanComponent::kConfidence,
                                kPixelConfidence8)[kHeight / 2 * kWidth + kWidth / 2];
  };
  CHECK(at_centre(PlaneScan(facing, -0.442)) >= 254);
  // Twice as far: four times the noise.
  CHECK(std::abs(at_centre(PlaneScan(facing, -0.884)) - 64) <= 1);
  const Eigen::Vector3d steep(std::sin(1.0), 0, -std::cos(1.0));  // 57 degrees.
  const int tilted = at_centre(PlaneScan(steep, -0.442 * std::cos(1.0)));
  CHECK(std::abs(tilted - 255 * std::cos(1.0)) < 8);
  OrganizedCloud flying = PlaneScan(facing, -0.442);
  flying.p_SP[kHeight / 2 * kWidth + kWidth / 2].z() += 0.002f;
  CHECK(at_centre(flying) < 10);
  CHECK(at_centre(flying) >= 1);
}

TEST_CASE("Intensity is the cloud's, in 10 bits", "[unit]") {
  OrganizedCloud cloud = PlaneScan(kTilted, -0.4);
  cloud.intensity[0] = 0;
  cloud.intensity[1] = 1;
  cloud.intensity[2] = 0.25f;
  const auto bits = Pixels<std::uint16_t>(cloud, ScanComponent::kIntensity, kPixelMono10);
  CHECK(bits[0] == 0);
  CHECK(bits[1] == 1023);
  CHECK(bits[2] == 256);
  CHECK(bits[3] == 512);
  cloud.intensity.clear();
  CHECK(Pixels<std::uint16_t>(cloud, ScanComponent::kIntensity, kPixelMono10)[1] == 0);
}

TEST_CASE("Depth and coordinate maps give the points again", "[unit]") {
  OrganizedCloud cloud = PlaneScan(kTilted, -0.4);
  cloud.p_SP[5] = InvalidPoint();
  const auto points = Pixels<float>(cloud, ScanComponent::kRange, kPixelCoord3dAbc32f);
  const auto depth = Pixels<float>(cloud, ScanComponent::kRange, kPixelCoord3dC32f);
  const auto map_a = Pixels<float>(cloud, ScanComponent::kMapA, kPixelCoord3dA32f);
  const auto map_b = Pixels<float>(cloud, ScanComponent::kMapB, kPixelCoord3dB32f);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double x = depth[i] * (map_a[i] - 0.5 * (kWidth - 1)) / kOptics.focal_px;
    const double y = depth[i] * (map_b[i] - 0.5 * (kHeight - 1)) / kOptics.focal_px;
    const double error_mm = std::hypot(x - points[3 * i], y - points[3 * i + 1]);
    if (error_mm > 1e-4 || depth[i] != points[3 * i + 2]) FAIL("pixel " << i);
  }
  CHECK(depth[5] == 0);
  CHECK(depth[6] > 300);  // Millimetres.
}

}  // namespace
}  // namespace tubetwin

#include <algorithm>
#include <cmath>
#include <cstring>

#include "models/base/polyline.h"
#include "tests/render/scan_fixture.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/paper_scan.h"

namespace tubetwin::test {
namespace {

constexpr double kFloatError_m = 2e-6;  // Single precision at half a metre, curved surface.

TEST_CASE("Without noise every point lies exactly on the plate or the tube", "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.442));
  geometry.capsules.push_back({{-0.08, -0.06, 0.40}, {0.07, 0.05, 0.41}, 0.0125, kTube, 0.8f});
  const OrganizedCloud cloud = Cast(geometry, Exact());
  REQUIRE(cloud.size() == 1032u * 772u);
  REQUIRE(cloud.label.size() == cloud.size());
  int tube = 0, plate = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!IsValid(cloud.p_SP[i])) {
      if (cloud.label[i] != kLabelNone) FAIL("pixel " << i << " is labelled but empty");
      continue;
    }
    const Vector3 p = cloud.p_SP[i].cast<double>();
    double error = 0;
    if (cloud.label[i] == kTube) {
      error = Closest({geometry.capsules[0].a, geometry.capsules[0].b}, p).distance_m - 0.0125;
      ++tube;
    } else {
      if (cloud.label[i] != kLabelCell) FAIL("pixel " << i << " has no label");
      error = p.z() - 0.442;
      ++plate;
    }
    if (std::abs(error) > kFloatError_m) FAIL("pixel " << i << " is off by " << error);
  }
  CHECK(tube > 20000);
  CHECK(plate > 400000);
}

TEST_CASE("The pinhole puts the image's corners where the data sheet's field of view ends",
          "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.442));
  const OrganizedCloud cloud = Cast(geometry, Exact());
  // 360 mm over 1032 pixels; half a pixel in from each side. Square pixels.
  const Eigen::Vector3f middle_left = cloud.p_SP[386 * 1032];
  CHECK(middle_left.x() == Approx(-0.180 + 0.5 * 0.360 / 1032).margin(1e-4));
  CHECK(middle_left.y() == Approx(0.5 * 0.360 / 1032).margin(1e-5));
}

TEST_CASE("The projector's frustum ends the field at 520 mm as the data sheet says", "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.520));
  const OrganizedCloud cloud = Cast(geometry, Exact());
  double low = 1, high = -1;
  for (int c = 0; c < cloud.width; ++c) {
    const Eigen::Vector3f& p = cloud.p_SP[386 * 1032 + c];
    if (!IsValid(p)) continue;
    low = std::min<double>(low, p.x());
    high = std::max<double>(high, p.x());
  }
  constexpr double kAngleTolerance_m = 0.008;  // The sheet's projector angles are +-1 degree.
  CHECK(high - low == Approx(0.382).margin(kAngleTolerance_m));
}

TEST_CASE("A tube's shadow lies on the plate exactly where the projector's tangents say",
          "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.44));
  geometry.capsules.push_back(TubeAlongY(0.0, 0.40));
  const OrganizedCloud cloud = Cast(geometry, Exact());
  const Vector3 p_SP = ProjectorPose(PaperCell().scanner).translation();
  CHECK(p_SP.x() > 0.2);
  // In the plane y = 0: tangents from the projector and from the camera to the tube's circle.
  auto interval = [&](double from_x, double from_z) {
    const double dx = 0.0 - from_x, dz = 0.40 - from_z;
    const double half = std::asin(0.0125 / std::hypot(dx, dz)), middle = std::atan2(dx, dz);
    return std::pair(from_x + (0.44 - from_z) * std::tan(middle - half),
                     from_x + (0.44 - from_z) * std::tan(middle + half));
  };
  const auto [shadow_low, shadow_high] = interval(p_SP.x(), p_SP.z());
  const auto [hidden_low, hidden_high] = interval(0, 0);
  REQUIRE(shadow_low < hidden_low - 0.005);  // A band of the plate is seen but dark.
  const double pixel_m = 0.44 / 1267;
  int dark = 0, lit = 0;
  for (int c = 0; c < cloud.width; ++c) {
    const double x = (c + 0.5 - 516) / 1267 * 0.44;
    const bool valid = IsValid(cloud.p_SP[386 * 1032 + c]);
    if (x > hidden_low - pixel_m && x < hidden_high + pixel_m) continue;  // Tube, or its rim.
    const bool expected_dark = x > shadow_low && x < shadow_high;
    if (std::abs(x - shadow_low) < pixel_m || std::abs(x - shadow_high) < pixel_m) continue;
    if (std::abs(x) > 0.15) continue;
    CHECK(valid == !expected_dark);
    (expected_dark ? dark : lit)++;
  }
  CHECK(dark > 15);
  CHECK(lit > 500);
}

TEST_CASE("Range: soft by default, cut at the data sheet on request", "[render]") {
  for (const double z : {0.29, 0.31, 0.38, 0.39, 0.51, 0.53, 1.19, 1.21}) {
    ScanGeometry geometry;
    geometry.boxes.push_back(Plate(z));
    ScanSettings settings = Exact();
    CHECK((CountValid(Cast(geometry, settings)) > 0) == (z > 0.3 && z < 1.2));
    settings.effects.hard_range = true;
    CHECK((CountValid(Cast(geometry, settings)) > 0) == (z > 0.384 && z < 0.52));
  }
}

TEST_CASE("Intensity is albedo times the cosine towards the projector", "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.442));
  const OrganizedCloud cloud = Cast(geometry, Exact());
  const Vector3 p_SP = ProjectorPose(PaperCell().scanner).translation();
  for (const std::size_t i : {386u * 1032u + 516u, 300u * 1032u + 200u}) {
    const Vector3 to_projector = p_SP - cloud.p_SP[i].cast<double>();
    CHECK(cloud.intensity[i] == Approx(0.6 * -to_projector.normalized().z()).epsilon(1e-4));
  }
}

TEST_CASE("A scan is the same to the byte for one thread and two, and for labels on and off",
          "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.48));
  for (int k = 0; k < 5; ++k) geometry.capsules.push_back(TubeAlongY(0.04 * k - 0.08, 0.44));
  ScanSettings settings = PaperScan();
  settings.width = 517;  // No multiple of a packet.
  settings.height = 387;
  const OrganizedCloud a = Cast(geometry, settings, 1);
  settings.labels = true;
  const OrganizedCloud b = Cast(geometry, settings, 2);
  REQUIRE(a.size() == b.size());
  CHECK(std::memcmp(a.p_SP.data(), b.p_SP.data(), a.size() * sizeof(a.p_SP[0])) == 0);
  CHECK((a.intensity == b.intensity));
  CHECK(a.label.empty());
  const OrganizedCloud other =
      CastScan(geometry, RigidTransform::Identity(), settings, RandomStream(1, 3, "scan"), {1});
  CHECK(std::memcmp(a.p_SP.data(), other.p_SP.data(), a.size() * sizeof(a.p_SP[0])) != 0);
}

TEST_CASE("An empty world gives an empty scan, the scanner's pose is respected", "[render]") {
  CHECK(CountValid(Cast({}, Exact())) == 0);
  ScanGeometry geometry;  // A plate in B, seen from above.
  geometry.boxes.push_back({Translation(0.6, 0, 0.09), Vector3(0.5, 0.5, 0.01), kLabelCell, 0.6f});
  const RigidTransform X_BS = MakeTransform(RotX(kPi), {0.6, 0.1, 0.542});
  const OrganizedCloud cloud = CastScan(geometry, X_BS, Exact(), RandomStream(1, 1, "scan"), {1});
  REQUIRE(CountValid(cloud) > 500000);
  for (const Eigen::Vector3f& p : cloud.p_SP) {
    if (IsValid(p) && std::abs(p.z() - 0.442) > kFloatError_m) FAIL("off by " << p.z() - 0.442);
  }
}

TEST_CASE("A full-resolution scan with every effect sees most of a full bin", "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.515));
  geometry.boxes.push_back({Translation(0.3, 0, 0.47), Vector3(0.01, 0.4, 0.045), 1, 0.6f});
  geometry.boxes.push_back({Translation(0, 0.4, 0.47), Vector3(0.3, 0.01, 0.045), 1, 0.6f});
  for (int tube = 0; tube < 7; ++tube) {
    Vector3 p(-0.2 + 0.06 * tube, -0.2, 0.50 - 0.01 * tube);
    for (int k = 0; k < 12; ++k) {  // A bent tube of 12 capsules.
      const double angle = 0.3 * tube + 0.15 * k;
      const Vector3 q = p + 0.042 * Vector3(std::sin(angle), std::cos(angle), 0);
      geometry.capsules.push_back({p, q, 0.0125, kTube + tube, 0.8f, 0.5f});
      p = q;
    }
  }
  ScanSettings settings = PaperScan();
  settings.width = 2064;
  settings.height = 1544;
  settings.labels = true;
  const OrganizedCloud cloud = Cast(geometry, settings, 2);
  CHECK(CountValid(cloud) > 2000000);
  CHECK(cloud.label.size() == 2064u * 1544u);
}

}  // namespace
}  // namespace tubetwin::test

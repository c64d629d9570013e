#include <chrono>
#include <cmath>
#include <cstring>

#include "hw_bridge/base/polyline.h"
#include "tests/support/catch.h"
#include "twin/render/scan_geometry.h"

namespace tubetwin {
namespace {

constexpr double kFloatError_m = 2e-6;  // Single precision at half a metre, curved surface.
constexpr std::uint32_t kTube = kLabelFirstTube;

// All scenes are laid out in S: X_BS is the identity.
ScanGeometry::Box Plate(double z_m, std::uint32_t label = kLabelCell) {
  return {Translation(0, 0, z_m + 0.01), Vector3(1, 1, 0.01), label, 0.6f};
}
ScanGeometry::Capsule TubeAlongY(double x_m, double z_m) {
  return {{x_m, -0.5, z_m}, {x_m, 0.5, z_m}, 0.0125, kTube, 0.8f};
}
OrganizedCloud Cast(const ScanGeometry& geometry, const ScanSettings& settings, int threads = 1) {
  return CastScan(geometry, RigidTransform::Identity(), settings, RandomStream(1, 2, "scan"),
                  {threads});
}
ScanSettings Exact() {
  ScanSettings settings;
  settings.noise = false;
  settings.labels = true;
  return settings;
}
int CountValid(const OrganizedCloud& cloud) {
  int n = 0;
  for (const Eigen::Vector3f& p : cloud.p_SP) n += IsValid(p);
  return n;
}

/// Depth errors of the middle of a scan of a plate; rows of `width` values, NaN where invalid.
struct Errors {
  std::vector<double> values;
  int width = 0;
  double Sigma() const {
    double sum = 0;
    int n = 0;
    for (const double e : values) {
      if (std::isnan(e)) continue;
      sum += e * e;
      ++n;
    }
    return std::sqrt(sum / n);
  }
  double Correlation(int columns, int rows) const {
    double sum = 0, squares = 0;
    const int height = static_cast<int>(values.size()) / width;
    for (int r = 0; r + rows < height; ++r) {
      for (int c = 0; c + columns < width; ++c) {
        const double a = values[r * width + c], b = values[(r + rows) * width + c + columns];
        if (std::isnan(a) || std::isnan(b)) continue;
        sum += a * b;
        squares += 0.5 * (a * a + b * b);
      }
    }
    return sum / squares;
  }
};
Errors ErrorsOf(const OrganizedCloud& noisy, const OrganizedCloud& exact) {
  Errors out;
  for (int r = noisy.height / 3; r < 2 * noisy.height / 3; ++r) {
    for (int c = noisy.width / 3; c < 2 * noisy.width / 3; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * noisy.width + c;
      out.values.push_back(noisy.p_SP[i].z() - exact.p_SP[i].z());
    }
  }
  out.width = 2 * noisy.width / 3 - noisy.width / 3;
  return out;
}

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
  const Vector3 p_SP = ProjectorPose(ScannerSpec()).translation();
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

TEST_CASE("Depth noise has the stated sigma at every distance, angle and scale", "[render]") {
  constexpr double kSigmaTolerance = 0.10;  // The rule's own; sampling error is below 1 %.
  struct Case {
    double z_m, tilt_deg, scale;
  };
  for (const Case c :
       {Case{0.442, 0, 1}, Case{0.515, 0, 1}, Case{0.442, 0, 2}, Case{0.442, 50, 1}}) {
    ScanGeometry geometry;
    // Tilted towards the projector about y.
    geometry.boxes.push_back(
        {Translation(0, 0, c.z_m) * MakeTransform(RotY(-Radians(c.tilt_deg)), Vector3::Zero()) *
             Translation(0, 0, 0.01),
         Vector3(1, 1, 0.01), kLabelCell, 0.6f});
    ScanSettings settings;
    settings.noise_scale = c.scale;
    const OrganizedCloud noisy = Cast(geometry, settings);
    const OrganizedCloud exact = Cast(geometry, Exact());
    double expected = 0;  // Root mean square over the same pixels.
    int n = 0;
    const Vector3 normal = RotY(-Radians(c.tilt_deg)) * Vector3(0, 0, -1);
    for (int r = 772 / 3; r < 2 * 772 / 3; ++r) {
      for (int col = 1032 / 3; col < 2 * 1032 / 3; ++col) {
        const Vector3 p = exact.p_SP[static_cast<std::size_t>(r) * 1032 + col].cast<double>();
        const double cosine = -normal.dot(p.normalized());
        expected += std::pow(0.00005 * c.scale * std::pow(p.z() / 0.442, 2) / cosine, 2);
        ++n;
      }
    }
    const Errors errors = ErrorsOf(noisy, exact);
    INFO("z " << c.z_m << " tilt " << c.tilt_deg << " scale " << c.scale);
    CHECK(errors.Sigma() == Approx(std::sqrt(expected / n)).epsilon(kSigmaTolerance));
    // Correlated over 3 to 5 pixels in both directions, not more.
    for (const bool rows : {false, true}) {
      CHECK(errors.Correlation(rows ? 0 : 1, rows ? 1 : 0) > 0.7);
      CHECK(errors.Correlation(rows ? 0 : 5, rows ? 5 : 0) < 0.05);
    }
  }
}

TEST_CASE("Drop-out is one half at 900 mm, at 340 mm and at 75 degrees", "[render]") {
  auto share = [](const ScanGeometry& geometry, double half_width) {
    ScanSettings settings;
    const OrganizedCloud noisy = Cast(geometry, settings), exact = Cast(geometry, Exact());
    int seen = 0, all = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Eigen::Vector3f& p = exact.p_SP[i];
      if (!IsValid(p) || std::abs(p.x() / p.z()) > half_width) continue;
      seen += IsValid(noisy.p_SP[i]);
      ++all;
    }
    REQUIRE(all > 10000);
    return static_cast<double>(seen) / all;
  };
  constexpr double kSampling = 0.02;  // Four sigma of 10,000 pixels.
  ScanGeometry far, near, steep, middle;
  far.boxes.push_back(Plate(0.900));
  CHECK(share(far, 0.05) == Approx(0.5).margin(kSampling));
  near.boxes.push_back(Plate(0.340));
  CHECK(share(near, 0.05) == Approx(0.5).margin(kSampling));
  middle.boxes.push_back(Plate(0.442));
  CHECK(share(middle, 0.05) == 1.0);
  steep.boxes.push_back(
      {Translation(0, 0, 0.442) * MakeTransform(RotY(-Radians(75)), Vector3::Zero()) *
           Translation(0, 0, 0.01),
       Vector3(1, 1, 0.01), kLabelCell, 0.6f});
  CHECK(share(steep, 0.01) == Approx(0.5).margin(kSampling));
}

TEST_CASE("Flying points appear only at depth edges, between both depths, without label",
          "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.48));
  geometry.boxes.push_back({Translation(0, 0, 0.43), Vector3(0.05, 0.05, 0.01), kTube, 0.5f});
  ScanSettings settings;
  settings.labels = true;
  const OrganizedCloud cloud = Cast(geometry, settings);
  int flying = 0, between = 0;
  for (int r = 0; r < cloud.height; ++r) {
    for (int c = 0; c < cloud.width; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * cloud.width + c;
      if (!IsValid(cloud.p_SP[i])) continue;
      const double z = cloud.p_SP[i].z();
      const bool off = z > 0.4205 && z < 0.4795;  // Ten sigma off both surfaces.
      // Sides of the upper box are seen nowhere: the camera looks straight down on it.
      between += off;
      if (cloud.label[i] != kLabelNone) {
        if (off) FAIL("pixel " << i << " flies at " << z << " with a label");
        continue;
      }
      ++flying;
      const double x = (c + 0.5 - 516) / 1267 * 0.42, y = (r + 0.5 - 386) / 1267 * 0.42;
      constexpr double kPixels_m = 2 * 0.42 / 1267;  // The edge is at most one pixel away.
      const double edge = std::max(std::abs(x), std::abs(y)) - 0.05;
      if (std::abs(edge) > kPixels_m) FAIL("pixel " << i << " flies away from any edge");
      if (z < 0.4195 || z > 0.4805) FAIL("pixel " << i << " flies outside both depths");
    }
  }
  CHECK(flying > 50);
  CHECK(between > flying / 2);
}

TEST_CASE("Range: soft by default, cut at the data sheet on request", "[render]") {
  for (const double z : {0.29, 0.31, 0.38, 0.39, 0.51, 0.53, 1.19, 1.21}) {
    ScanGeometry geometry;
    geometry.boxes.push_back(Plate(z));
    ScanSettings settings = Exact();
    CHECK((CountValid(Cast(geometry, settings)) > 0) == (z > 0.3 && z < 1.2));
    settings.hard_range = true;
    CHECK((CountValid(Cast(geometry, settings)) > 0) == (z > 0.384 && z < 0.52));
  }
}

TEST_CASE("Intensity is albedo times the cosine towards the projector", "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.442));
  const OrganizedCloud cloud = Cast(geometry, Exact());
  const Vector3 p_SP = ProjectorPose(ScannerSpec()).translation();
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
  ScanSettings settings;
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

TEST_CASE("A full-resolution scan of seven tubes in a bin takes about a second", "[render]") {
  ScanGeometry geometry;
  geometry.boxes.push_back(Plate(0.515));
  geometry.boxes.push_back({Translation(0.3, 0, 0.47), Vector3(0.01, 0.4, 0.045), 1, 0.6f});
  geometry.boxes.push_back({Translation(0, 0.4, 0.47), Vector3(0.3, 0.01, 0.045), 1, 0.6f});
  for (int tube = 0; tube < 7; ++tube) {
    Vector3 p(-0.2 + 0.06 * tube, -0.2, 0.50 - 0.01 * tube);
    for (int k = 0; k < 12; ++k) {  // A bent tube of 12 capsules.
      const double angle = 0.3 * tube + 0.15 * k;
      const Vector3 q = p + 0.042 * Vector3(std::sin(angle), std::cos(angle), 0);
      geometry.capsules.push_back({p, q, 0.0125, kTube + tube, 0.8f});
      p = q;
    }
  }
  ScanSettings settings;
  settings.width = 2064;
  settings.height = 1544;
  settings.labels = true;
  double best_s = 1e9;
  for (int n = 0; n < 3; ++n) {
    const auto begin = std::chrono::steady_clock::now();
    const OrganizedCloud cloud = Cast(geometry, settings, 2);
    best_s = std::min(
        best_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    CHECK(CountValid(cloud) > 2000000);
  }
  WARN("2064 x 1544, two threads: " << best_s << " s (best of 3)");
  constexpr double kLoadedMachine_s = 6.0;  // Tests share their cores.
  CHECK(best_s < kLoadedMachine_s);
}

}  // namespace
}  // namespace tubetwin

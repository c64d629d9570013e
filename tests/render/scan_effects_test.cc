// Each effect of the scanner alone, the others off, against its own formula.
// Long file: one effect after another, all on the same helpers.

#include <cmath>
#include <functional>

#include "hw_bridge/base/polyline.h"
#include "tests/render/scan_fixture.h"
#include "tests/support/catch.h"
#include "twin/render/depth_error.h"

namespace tubetwin::test {
namespace {

/// Cosines of a point of a surface with that normal.
struct Incidence {
  double camera, projector, mirror;
  Incidence(const Vector3& p, const Vector3& normal) {
    const Vector3 to_camera = -p.normalized();
    const Vector3 to_projector = (ProjectorPose({}).translation() - p).normalized();
    camera = normal.dot(to_camera);
    projector = normal.dot(to_projector);
    mirror = normal.dot((to_camera + to_projector).normalized());
  }
};
Vector3 PlateNormal(double tilt_deg) { return RotY(-Radians(tilt_deg)) * Vector3(0, 0, -1); }

/// Compares how many points an effect leaves with the sum of their chances to stay.
void CheckLeft(
    const ScanGeometry& geometry, bool ScannerEffects::*effect,
    const std::function<double(const Vector3& p)>& keep,
    const std::function<bool(const Vector3& p)>& counts = [](auto&) { return true; }) {
  const OrganizedCloud exact = Cast(geometry, Exact()), worse = Cast(geometry, Only(effect));
  double expected = 0, variance = 0;
  int left = 0, all = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (!IsValid(exact.p_SP[i])) {
      if (IsValid(worse.p_SP[i])) FAIL("pixel " << i << " comes from nowhere");
      continue;
    }
    const Vector3 p = exact.p_SP[i].cast<double>();
    if (!counts(p)) continue;
    const double chance = keep(p);
    expected += chance;
    variance += chance * (1 - chance);
    ++all;
    left += IsValid(worse.p_SP[i]);
    // What stays is untouched.
    if (IsValid(worse.p_SP[i]) && worse.p_SP[i] != exact.p_SP[i]) FAIL("pixel " << i << " moved");
  }
  REQUIRE(all > 1000);
  constexpr double kSigmas = 5;  // Pixels are independent; one more for the float's rounding.
  INFO("left " << left << " of " << all << ", expected " << expected);
  CHECK(std::abs(left - expected) < kSigmas * std::sqrt(variance) + 1);
}

double Logistic(double x) { return 1.0 / (1.0 + std::exp(x)); }

TEST_CASE("Shadows alone empty what the projector does not reach", "[render]") {
  ScanSettings lit = Exact();
  lit.effects.shadows = false;
  const ScanGeometry geometry = Scene({Plate(0.44)}, {TubeAlongY(0.0, 0.40)});
  const OrganizedCloud with = Cast(geometry, Exact()), without = Cast(geometry, lit);
  // Everything is hit; so is what lies outside of the projector's frustum.
  CHECK(CountValid(without) == static_cast<int>(without.size()));
  const Vector3 p_SP = ProjectorPose({}).translation();
  for (std::size_t i = 0; i < with.size(); i += 7) {
    if (IsValid(with.p_SP[i])) {
      CHECK(with.p_SP[i] == without.p_SP[i]);
      continue;
    }
    // An empty pixel is shaded by the tube, turned away, or outside of 47.5 x 36 degrees.
    const Vector3 p = without.p_SP[i].cast<double>();
    const Vector3 p_P = ProjectorPose({}).inverse() * p;
    const bool outside = std::abs(p_P.x()) > std::tan(Radians(23.75)) * p_P.z() - 1e-5 ||
                         std::abs(p_P.y()) > std::tan(Radians(18.0)) * p_P.z() - 1e-5;
    bool crosses = false;
    for (int k = 0; k <= 400 && !outside; ++k) {
      const Vector3 q = p + k / 400.0 * (p_SP - p);
      crosses |= std::hypot(q.x(), q.z() - 0.40) < kRadius_m + 1e-5;
    }
    if (!outside && !crosses) FAIL("pixel " << i << " is dark without a reason");
  }
}

TEST_CASE("Soft range alone loses points as the logistic of the design says", "[render]") {
  for (const double z : {0.85, 0.90, 1.00}) {
    CheckLeft(Scene({Plate(z)}), &ScannerEffects::soft_range,
              [&](auto&) { return 1 - Logistic((0.900 - z) / 0.060); });
  }
  for (const double z : {0.32, 0.34, 0.36}) {
    CheckLeft(Scene({Plate(z)}), &ScannerEffects::soft_range,
              [&](auto&) { return 1 - Logistic((z - 0.340) / 0.015); });
  }
  CheckLeft(Scene({Plate(0.45)}), &ScannerEffects::soft_range, [](auto&) { return 1.0; });
}

TEST_CASE("Incidence alone loses half of the points at 75 degrees", "[render]") {
  for (const double tilt_deg : {0.0, 60.0, 70.0, 75.0, 78.0, -30.0, -45.0}) {
    const Vector3 normal = PlateNormal(tilt_deg);
    CheckLeft(
        Scene({Plate(0.442, tilt_deg)}), &ScannerEffects::incidence,
        [&](const Vector3& p) {
          const Incidence at(p, normal);
          const double steepest_deg = Degrees(std::acos(std::min(at.camera, at.projector)));
          return 1 - Logistic((75 - steepest_deg) / 3);
        },
        [](const Vector3& p) { return std::abs(p.y()) < 0.1; });
  }
}

TEST_CASE("A weak signal alone loses dark rubber, the more the steeper and farther", "[render]") {
  constexpr float kRubber = 0.12f;
  std::vector<double> kept;
  for (const auto& [z, tilt_deg] :
       {std::pair{0.442, 0.0}, {0.52, 0.0}, {0.52, -30.0}, {0.70, 0.0}}) {
    const Vector3 normal = PlateNormal(tilt_deg);
    const ScanGeometry geometry = Scene({Plate(z, tilt_deg, kRubber)});
    CheckLeft(geometry, &ScannerEffects::weak_signal, [&](const Vector3& p) {
      const double signal = kRubber * Incidence(p, normal).projector * std::pow(0.442 / p.z(), 2);
      return 1 - 1 / (1 + std::pow(signal / 0.03, 4));
    });
    const int all = CountValid(Cast(geometry, Exact()));
    kept.push_back(1.0 * CountValid(Cast(geometry, Only(&ScannerEffects::weak_signal))) / all);
  }
  CHECK(kept[0] > 0.98);
  CHECK(kept[1] < kept[0]);
  CHECK(kept[2] < kept[1]);
  CHECK(kept[3] < kept[1]);
  // Bright PVC stands above it.
  const ScanGeometry pvc = Scene({Plate(0.52, 0.0, 0.84f)});
  CHECK(CountValid(Cast(pvc, Only(&ScannerEffects::weak_signal))) ==
        CountValid(Cast(pvc, Exact())));
}

TEST_CASE("A highlight alone loses and brightens glossy points around the mirror direction",
          "[render]") {
  // Between camera and projector the mirror direction leans 15 degrees.
  constexpr float kGloss = 0.5f;
  constexpr double kTilt_deg = 15.0;
  const Vector3 normal = PlateNormal(kTilt_deg);
  const ScanGeometry glossy = Scene({Plate(0.442, kTilt_deg, 0.6f, kGloss)});
  const auto off_deg = [&](const Vector3& p) {
    return Degrees(std::acos(std::min(1.0, Incidence(p, normal).mirror)));
  };
  const auto gleam = [&](const Vector3& p) {
    return kGloss * std::exp(-std::pow(off_deg(p) / 4, 2) / 2);
  };
  for (const auto& [from_deg, to_deg] :
       {std::pair{0.0, 2.0}, {2.0, 5.0}, {5.0, 9.0}, {17.0, 90.0}}) {
    INFO("from " << from_deg << " to " << to_deg << " degrees");
    CheckLeft(
        glossy, &ScannerEffects::highlights, [&](const Vector3& p) { return 1 - gleam(p); },
        [&](const Vector3& p) { return off_deg(p) >= from_deg && off_deg(p) < to_deg; });
  }
  const OrganizedCloud bright = Cast(glossy, Only(&ScannerEffects::highlights));
  for (std::size_t i = 0; i < bright.size(); i += 97) {
    if (!IsValid(bright.p_SP[i])) continue;
    const Vector3 p = bright.p_SP[i].cast<double>();
    const double expected = std::min(1.0, 0.6 * Incidence(p, normal).projector + gleam(p));
    CHECK(bright.intensity[i] == Approx(expected).margin(2e-3));
  }
  const ScanGeometry matt = Scene({Plate(0.442, kTilt_deg)});
  CHECK(CountValid(Cast(matt, Only(&ScannerEffects::highlights))) ==
        CountValid(Cast(matt, Exact())));
}

TEST_CASE("Flying pixels alone: 30 % of an edge's pixels empty, 20 % between both depths",
          "[render]") {
  ScanGeometry geometry = Scene({Plate(0.48)});
  for (int k = 0; k < 6; ++k) {  // Many edges.
    geometry.boxes.push_back(
        {Translation(0.05 * k - 0.125, 0, 0.43), Vector3(0.012, 0.1, 0.01), kTube, 0.5f});
  }
  ScanSettings settings = Only(&ScannerEffects::flying_pixels), lit = Exact();
  settings.effects.shadows = lit.effects.shadows = false;
  const OrganizedCloud cloud = Cast(geometry, settings), exact = Cast(geometry, lit);
  int edge = 0, empty = 0, mixed = 0;
  double share = 0;
  for (int r = 0; r < cloud.height; ++r) {
    for (int c = 0; c < cloud.width; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * cloud.width + c;
      const double own = exact.p_SP[i].z();
      double other = own;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          if (r + dr < 0 || r + dr >= cloud.height || c + dc < 0 || c + dc >= cloud.width) continue;
          const double z = exact.p_SP[i + dr * cloud.width + dc].z();
          if (std::abs(z - own) > std::abs(other - own)) other = z;
        }
      }
      if (std::abs(other - own) <= 0.003) {
        if (cloud.p_SP[i] != exact.p_SP[i] || cloud.label[i] != exact.label[i]) {
          FAIL("pixel " << i << " changed away from any edge");
        }
        continue;
      }
      ++edge;
      if (!IsValid(cloud.p_SP[i])) {
        ++empty;
      } else if (cloud.label[i] == kLabelNone) {
        ++mixed;
        const double at = (cloud.p_SP[i].z() - own) / (other - own);
        if (at < 0 || at > 1) FAIL("pixel " << i << " flies outside of both depths");
        share += at;
      } else if (cloud.p_SP[i] != exact.p_SP[i]) {
        FAIL("pixel " << i << " moved with its label");
      }
    }
  }
  REQUIRE(edge > 5000);
  constexpr double kSampling = 0.025;  // Four sigma of 5,000 pixels.
  CHECK(1.0 * empty / edge == Approx(0.30).margin(kSampling));
  CHECK(1.0 * mixed / edge == Approx(0.20).margin(kSampling));
  CHECK(share / mixed == Approx(0.5).margin(0.04));
}

TEST_CASE("Interreflections alone move 2 % of a valley's points by 1 mm", "[render]") {
  // Tubes lie on the plate, two side by side.
  const double z = 0.48 - kRadius_m;
  const ScanGeometry geometry =
      Scene({Plate(0.48)}, {TubeAlongY(-0.10, z), TubeAlongY(0.0, z), TubeAlongY(2 * kRadius_m, z),
                            TubeAlongY(0.12, z)});
  ScanSettings settings = Only(&ScannerEffects::interreflections), lit = Exact();
  settings.width = lit.width = 2064;
  settings.height = lit.height = 1544;
  settings.effects.shadows = lit.effects.shadows = false;
  const OrganizedCloud cloud = Cast(geometry, settings, 2), exact = Cast(geometry, lit, 2);
  // Distance of a point to the nearest other surface.
  const auto other_m = [&](const Vector3& p, bool plate) {
    std::vector<double> d;
    for (const auto& tube : geometry.capsules) {
      d.push_back(std::hypot(p.x() - tube.a.x(), p.z() - tube.a.z()) - kRadius_m);
    }
    std::sort(d.begin(), d.end());
    return plate ? d[0] : std::min(d[1], 0.48 - p.z());
  };
  int valley = 0, moved_in_valley = 0, moved = 0;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    REQUIRE(IsValid(cloud.p_SP[i]));
    const Vector3 p = exact.p_SP[i].cast<double>();
    const double error = cloud.p_SP[i].z() - p.z();
    const double apart_m = other_m(p, exact.label[i] == kLabelCell);
    // Well within reach, both faces seen by the camera.
    const bool inside = apart_m < 0.0015;
    valley += inside;
    if (error == 0) continue;
    ++moved;
    moved_in_valley += inside;
    sum += error;
    squares += error * error;
    constexpr double kReach_m = 0.004;
    if (apart_m > kReach_m + 1e-5) FAIL("pixel " << i << " is off " << apart_m << " m from all");
  }
  REQUIRE(valley > 10000);
  const double share = 1.0 * moved_in_valley / valley;
  CHECK(share == Approx(0.02).margin(4 * std::sqrt(0.02 / valley)));
  const double sigma = std::sqrt(squares / moved);
  CHECK(sigma == Approx(0.001).epsilon(4 / std::sqrt(2.0 * moved)));
  CHECK(std::abs(sum / moved) < 4 * 0.001 / std::sqrt(moved));
  // One bent tube is no valley, nor is a floor of two pieces.
  const ScanGeometry convex =
      Scene({{Translation(-0.2, 0, 0.49), Vector3(0.2, 0.3, 0.01), kLabelCell, 0.6f},
             {Translation(0.2, 0, 0.49), Vector3(0.2, 0.3, 0.01), kLabelCell, 0.6f}},
            {{{-0.1, 0, 0.40}, {0, 0.01, 0.40}, kRadius_m, kTube, 0.8f},
             {{0, 0.01, 0.40}, {0.1, 0, 0.40}, kRadius_m, kTube, 0.8f}});
  const OrganizedCloud a = Cast(convex, Only(&ScannerEffects::interreflections));
  const OrganizedCloud b = Cast(convex, Exact());
  int differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differ += IsValid(b.p_SP[i]) && a.p_SP[i] != b.p_SP[i];
  CHECK(differ == 0);
}

/// Depth errors of the middle of a scan of a plate, in rows of `width`.
struct Errors {
  std::vector<double> values;
  int width = 0;
  double Moment(int power) const {
    double sum = 0;
    for (const double e : values) sum += std::pow(e, power);
    return sum / static_cast<double>(values.size());
  }
  double Sigma() const { return std::sqrt(Moment(2)); }
  double Correlation(int columns, int rows) const {
    double sum = 0, squares = 0;
    const int height = static_cast<int>(values.size()) / width;
    for (int r = 0; r + rows < height; ++r) {
      for (int c = 0; c + columns < width; ++c) {
        const double a = values[r * width + c], b = values[(r + rows) * width + c + columns];
        sum += a * b;
        squares += 0.5 * (a * a + b * b);
      }
    }
    return sum / squares;
  }
};
Errors ErrorsOf(const OrganizedCloud& noisy, const OrganizedCloud& exact) {
  Errors out;
  for (int r = noisy.height / 4; r < 3 * noisy.height / 4; ++r) {
    for (int c = noisy.width / 4; c < 3 * noisy.width / 4; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * noisy.width + c;
      REQUIRE(IsValid(noisy.p_SP[i]));
      out.values.push_back(static_cast<double>(noisy.p_SP[i].z()) - exact.p_SP[i].z());
    }
  }
  out.width = 3 * noisy.width / 4 - noisy.width / 4;
  return out;
}

TEST_CASE(
    "Noise alone has the stated sigma at every distance, angle and scale, is Gaussian and "
    "correlates over 3 to 5 pixels",
    "[render]") {
  struct Case {
    double z_m, tilt_deg, scale;
  };
  for (const Case c : {Case{0.442, 0, 1}, Case{0.515, 0, 1}, Case{1.0, 0, 1}, Case{0.442, 0, 2},
                       Case{0.442, 40, 1}}) {
    const ScanGeometry geometry = Scene({Plate(c.z_m, c.tilt_deg)});
    ScanSettings settings = Only(&ScannerEffects::noise), plain = Exact();
    settings.noise_scale = c.scale;
    settings.effects.shadows = plain.effects.shadows = false;  // Far away the frustum is elsewhere.
    const OrganizedCloud exact = Cast(geometry, plain);
    Errors errors = ErrorsOf(Cast(geometry, settings), exact);
    // In units of the sigma that the rule gives there.
    const Vector3 normal = PlateNormal(c.tilt_deg);
    for (std::size_t i = 0; i < errors.values.size(); ++i) {
      const std::size_t row = exact.height / 4 + i / errors.width;
      const std::size_t column = exact.width / 4 + i % errors.width;
      const Vector3 p = exact.p_SP[row * exact.width + column].cast<double>();
      errors.values[i] /=
          0.00005 * c.scale * std::pow(p.z() / 0.442, 2) / Incidence(p, normal).camera;
    }
    INFO("z " << c.z_m << " tilt " << c.tilt_deg << " scale " << c.scale);
    constexpr double kSampling = 0.015;  // 200,000 pixels, about 12 of which are one sample.
    CHECK(errors.Sigma() == Approx(1.0).epsilon(kSampling));
    CHECK(errors.Moment(4) / std::pow(errors.Moment(2), 2) == Approx(3.0).margin(0.15));
    // exp(-d^2 / 4) in both directions.
    for (const bool rows : {false, true}) {
      for (const int d : {1, 2, 3, 5}) {
        CHECK(errors.Correlation(rows ? 0 : d, rows ? d : 0) ==
              Approx(std::exp(-0.25 * d * d)).margin(0.05));
      }
    }
  }
}

TEST_CASE("Bias alone is a smooth field of 0.05 mm rms and 100 mm wavelength, the scanner's own",
          "[render]") {
  const ScanGeometry geometry = Scene({Plate(0.442)});
  ScanSettings settings = Only(&ScannerEffects::bias), plain = Exact();
  settings.width = plain.width = 258;
  settings.height = plain.height = 193;
  const OrganizedCloud exact = Cast(geometry, plain);
  const double pixel_m = 0.442 / settings.spec.focal_px * 2064 / 258;
  double square = 0, at_25 = 0, at_50 = 0;
  constexpr int kScanners = 60;
  for (int seed = 1; seed <= kScanners; ++seed) {
    settings.bias_seed = static_cast<std::uint64_t>(seed);
    const Errors errors = ErrorsOf(Cast(geometry, settings), exact);
    square += errors.Moment(2) / kScanners;
    at_25 += errors.Correlation(static_cast<int>(std::lround(0.025 / pixel_m)), 0) / kScanners;
    at_50 += errors.Correlation(static_cast<int>(std::lround(0.050 / pixel_m)), 0) / kScanners;
    double step = 0;
    for (std::size_t i = 1; i < errors.values.size(); ++i) {
      if (i % errors.width != 0) {
        step = std::max(step, std::abs(errors.values[i] - errors.values[i - 1]));
      }
    }
    // 16 waves in step, of slope 2 pi / 100 mm.
    if (step > 16 * std::sqrt(2.0 / 16) * 0.00005 * 2 * kPi / 0.1 * pixel_m + 1e-7) FAIL("a jump");
  }
  constexpr double kOfMeans = 0.10;  // Each scanner's rms scatters by 15 to 20 %.
  CHECK(std::sqrt(square) == Approx(0.00005).epsilon(kOfMeans));
  // Plane waves of one length in all directions: sin(k d) / (k d).
  CHECK(at_25 == Approx(2 / kPi).margin(0.1));
  CHECK(at_50 == Approx(0.0).margin(0.1));
  // The scanner decides, not the shot.
  const OrganizedCloud one = Cast(geometry, settings, 1, 5), two = Cast(geometry, settings, 2, 6);
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (IsValid(one.p_SP[i]) && one.p_SP[i] != two.p_SP[i]) FAIL("pixel " << i << " differs");
  }
}

TEST_CASE("The bias field is what its waves are, between the lattice's nodes as well", "[render]") {
  const Eigen::Vector3f low(-0.2f, -0.15f, 0.35f), high(0.2f, 0.15f, 0.55f);
  const BiasField field(3, 1.0, 0.1, low, high);
  // The same waves on a lattice that starts elsewhere: other nodes, same field.
  const Eigen::Vector3f shift(0.0031f, 0.0047f, 0.0023f);
  const BiasField shifted(3, 1.0, 0.1, low - shift, high);
  RandomStream stream(1, 0, "points");
  double worst = 0, square = 0;
  constexpr int kPoints = 2000;
  for (int i = 0; i < kPoints; ++i) {
    Eigen::Vector3f p;
    for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(stream.Uniform(low[k], high[k]));
    worst = std::max<double>(worst, std::abs(field.At(p) - shifted.At(p)));
    square += std::pow(field.At(p), 2) / kPoints;
  }
  CHECK(worst < 0.2);  // Three axes, each up to (pi / 12)^2 / 2 of the amplitude.
  CHECK(std::sqrt(square) == Approx(1.0).epsilon(0.3));
}

}  // namespace
}  // namespace tubetwin::test

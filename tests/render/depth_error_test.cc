// Noise and calibration bias, each alone, against their own formulas.

#include <cmath>

#include "tests/render/scan_fixture.h"
#include "tests/support/catch.h"
#include "twin/render/scan/depth_error.h"

namespace tubetwin::test {
namespace {

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

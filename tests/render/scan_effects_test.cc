// Each effect of the scanner alone, the others off, against its own formula.

#include <cmath>
#include <functional>

#include "models/base/polyline.h"
#include "tests/render/scan_fixture.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

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
  const Vector3 p_SP = ProjectorPose(PaperCell().scanner).translation();
  for (std::size_t i = 0; i < with.size(); i += 7) {
    if (IsValid(with.p_SP[i])) {
      CHECK(with.p_SP[i] == without.p_SP[i]);
      continue;
    }
    // An empty pixel is shaded by the tube, turned away, or outside of 47.5 x 36 degrees.
    const Vector3 p = without.p_SP[i].cast<double>();
    const Vector3 p_P = ProjectorPose(PaperCell().scanner).inverse() * p;
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

}  // namespace
}  // namespace tubetwin::test

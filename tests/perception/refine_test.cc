#include "perception/fragment/refine.h"

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

/// Points on the upper half of the tube around an arc in the plane z = 0, `noise_m` along their
/// normals.
std::vector<SurfacePoint> UpperHalf(double bend_m, double arc, double r, double noise_m,
                                    RandomStream& stream) {
  std::vector<SurfacePoint> out;
  for (int i = 0; i < 4000; ++i) {
    const double angle = arc * stream.Uniform(), around = kPi * (0.1 + 0.8 * stream.Uniform());
    const Vector3 radial(std::cos(angle), std::sin(angle), 0);
    const Vector3 n = std::cos(around) * radial + std::sin(around) * Vector3::UnitZ();
    const Vector3 p = bend_m * radial + (r + noise_m * stream.Normal()) * n;
    out.push_back({p.cast<float>(), n.cast<float>(), (p - r * n).cast<float>(), 1.0f});
  }
  return out;
}

Polyline Arc(double bend_m, double arc, int nodes) {
  Polyline line;
  for (int k = 0; k < nodes; ++k) {
    const double angle = arc * k / (nodes - 1);
    line.emplace_back(bend_m * std::cos(angle), bend_m * std::sin(angle), 0.0);
  }
  return line;
}

TEST_CASE("A curve that starts a millimetre off is pulled onto the tube's axis", "[unit]") {
  RandomStream stream(1, 0, "refine");
  const double bend_m = 0.15, arc = 1.2, r = 0.0125;
  for (const double noise_m : {0.0, 0.0001, 0.0003}) {
    const auto points = UpperHalf(bend_m, arc, r, noise_m, stream);
    Polyline line = Arc(bend_m + 0.001, arc, 37);
    for (Vector3& p : line) p.z() -= 0.001;
    const TubeFit fit = RefineCurve(line, points, r);
    INFO("noise " << noise_m);
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
      const double off = std::hypot(line[k].head<2>().norm() - bend_m, line[k].z());
      // Nodes 5 mm apart cut the arc by 0.02 mm; a hundred points per node average the noise.
      CHECK(off < 0.00004 + 0.4 * noise_m);
    }
    CHECK(fit.share > 0.99);
    CHECK(fit.rms_m == Approx(noise_m).margin(0.00003));
    CHECK(fit.node_weight.size() == line.size());
  }
}

TEST_CASE("Points of another surface do not pull the curve", "[unit]") {
  RandomStream stream(2, 0, "refine");
  const double r = 0.010;
  auto points = UpperHalf(0.2, 1.0, r, 0.0001, stream);
  const std::size_t own = points.size();
  for (std::size_t i = 0; i < own / 4; ++i) {
    SurfacePoint p = points[i * 4];
    p.p_N += 0.004f * p.n_N;
    points.push_back(p);
  }
  Polyline line = Arc(0.2, 1.0, 41);
  RefineCurve(line, points, r);
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    CHECK(std::hypot(line[k].head<2>().norm() - 0.2, line[k].z()) < 0.0001);
  }
}

}  // namespace
}  // namespace tubetwin

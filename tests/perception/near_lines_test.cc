#include "perception/scene/near_lines.h"

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

/// Both ways compute the same foot; only the order of roundings differs.
constexpr double kRounding_m = 1e-12;

Polyline RandomWalk(RandomStream& stream, int nodes) {
  Polyline line{Vector3(stream.Normal(), stream.Normal(), stream.Normal())};
  for (int k = 1; k < nodes; ++k) {
    line.push_back(line.back() + 0.1 * Vector3(stream.Normal(), stream.Normal(), stream.Normal()));
  }
  return line;
}

TEST_CASE("The distance to the nearest of many lines is that of looking at each", "[unit]") {
  RandomStream stream(1, 0, "near lines");
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Polyline> lines;
    NearLines near;
    for (int i = 0; i < 6; ++i) {
      lines.push_back(RandomWalk(stream, 1 + static_cast<int>(stream.Index(40))));
      near.Add(lines.back());
    }
    for (int k = 0; k < 50; ++k) {
      const Vector3 p(stream.Normal(), stream.Normal(), stream.Normal());
      const double limit_m = 0.7;
      double expected = limit_m, without = limit_m;
      for (int i = 0; i < 6; ++i) {
        if (lines[i].size() < 2) {
          expected = std::min(expected, (lines[i][0] - p).norm());
          if (i != 1 && i != 4) without = std::min(without, (lines[i][0] - p).norm());
          continue;
        }
        const double d = Closest(lines[i], p).distance_m;
        expected = std::min(expected, d);
        if (i != 1 && i != 4) without = std::min(without, d);
      }
      CHECK(near.Distance(p, limit_m) == Approx(expected).margin(kRounding_m));
      CHECK(near.Distance(p, limit_m, 1, 4) == Approx(without).margin(kRounding_m));
    }
  }
}

TEST_CASE("No line and an empty line are near to nothing", "[unit]") {
  NearLines near;
  CHECK(near.Distance(Vector3::Zero(), 0.5) == 0.5);
  near.Add({});
  near.Add({{0.1, 0, 0}, {0.2, 0, 0}});
  CHECK(near.Distance(Vector3::Zero(), 0.5, 1) == 0.5);
  CHECK(near.Distance(Vector3::Zero(), 0.5, 0) == Approx(0.1));
}

}  // namespace
}  // namespace tubetwin

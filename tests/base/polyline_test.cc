#include "models/base/polyline.h"

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

TEST_CASE("Resampling keeps ends and spaces points equally along the curve", "[unit]") {
  const Polyline line = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const Polyline out = ResampleCount(line, 5);
  REQUIRE(out.size() == 5);
  CHECK(out[0].isApprox(line[0]));
  CHECK(out[1].isApprox(Vector3(0.5, 0, 0)));
  CHECK(out[2].isApprox(line[1]));
  CHECK(out[3].isApprox(Vector3(1, 0.5, 0)));
  CHECK(out[4].isApprox(line[2]));
}

TEST_CASE("The distance of two segments equals the best of a fine grid", "[unit]") {
  RandomStream stream(1, 0, "segments");
  for (int trial = 0; trial < 300; ++trial) {
    Vector3 p[4];
    for (Vector3& v : p) v = {stream.Uniform(-1, 1), stream.Uniform(-1, 1), stream.Uniform(-1, 1)};
    double best = 1e9;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60; ++j) {
        best = std::min(best,
                        (p[0] + i / 60.0 * (p[1] - p[0]) - p[2] - j / 60.0 * (p[3] - p[2])).norm());
      }
    }
    const SegmentPair pair = ClosestOfSegments(p[0], p[1], p[2], p[3]);
    CHECK(pair.distance_m <= best + 1e-12);
    CHECK(pair.distance_m > best - 0.06);  // Half a grid cell of segments up to 3.5 long.
  }
}

}  // namespace
}  // namespace tubetwin

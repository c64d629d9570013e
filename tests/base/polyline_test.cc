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

TEST_CASE("The pieces of a tube within its round ends reach from tip to tip", "[unit]") {
  const double kRounding_m = 1e-9, radius_m = 0.01;
  const Polyline line = {{0, 0, 0}, {0.004, 0, 0}, {0.2, 0, 0}, {0.2, 0.3, 0}, {0.2, 0.306, 0}};
  const std::vector<AxisPiece> pieces = PiecesWithin(line, radius_m);
  REQUIRE(pieces.size() == 2);  // The first and the last piece are shorter than the radius.
  CHECK(pieces[0].piece == 1);
  CHECK((pieces[0].from - Vector3(radius_m, 0, 0)).norm() < kRounding_m);
  CHECK((pieces[1].to - Vector3(0.2, 0.306 - radius_m, 0)).norm() < kRounding_m);
  // No longer than thick: a ball in the middle, also where a node is there.
  for (const double nodes : {2, 3}) {
    const Polyline ball = ResampleCount({{0, 0, 0}, {0.015, 0, 0}}, static_cast<int>(nodes));
    const std::vector<AxisPiece> middle = PiecesWithin(ball, radius_m);
    REQUIRE(!middle.empty());
    CHECK((middle.front().from - Vector3(0.0075, 0, 0)).norm() < 1e-4);
    CHECK((middle.back().to - middle.front().from).norm() > 5e-5);
  }
}

}  // namespace
}  // namespace tubetwin

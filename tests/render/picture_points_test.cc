#include "twin/render/picture_points.h"

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

/// A view from N's origin: S and N are one frame.
OrganizedCloud CloudOf(const std::vector<Eigen::Vector3f>& points) {
  OrganizedCloud view;
  view.p_SP = points;
  view.width = static_cast<int>(view.p_SP.size());
  view.height = 1;
  return view;
}

}  // namespace

TEST_CASE("Of each cell in the bin the first point stays, the rest and the outside go") {
  const OrganizedCloud view = CloudOf({{0.001f, 0.001f, 0.021f},
                                       {0.004f, 0.004f, 0.023f},  // In the same 6 mm.
                                       {0.007f, 0.001f, 0.021f},
                                       InvalidPoint(),
                                       {0.6f, 0.0f, 0.02f},     // Beside the bin.
                                       {0.0f, 0.0f, 0.5f},      // The arm.
                                       {0.001f, 0.001f, 0.0f},  // Floor, in cells of 24 mm.
                                       {0.02f, 0.02f, 0.001f}});
  const std::vector<Vector3> points_N = DownsampleForPicture({view, view}, Bin());
  REQUIRE(points_N.size() == 3);
  CHECK(points_N[0].cast<float>() == view.p_SP[0]);
  CHECK(points_N[1].cast<float>() == view.p_SP[2]);
  CHECK(points_N[2].cast<float>() == view.p_SP[6]);
}

TEST_CASE("There are never more points than asked for, spread over all that was seen") {
  std::vector<Eigen::Vector3f> grid;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 80; ++k) grid.push_back({-0.35f + 0.007f * i, -0.28f + 0.007f * k, 0.05f});
  }
  const std::vector<Vector3> points_N = DownsampleForPicture({CloudOf(grid)}, Bin(), 1000);
  CHECK(points_N.size() <= 1000);
  CHECK(points_N.size() > 400);  // Cells are doubled in area at each try.
  double low = 1.0, high = -1.0;
  for (const Vector3& p : points_N) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  CHECK(low < -0.33);
  CHECK(high > 0.32);
}

}  // namespace tubetwin

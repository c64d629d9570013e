#include "twin/render/perceived_picture.h"

#include <opencv2/imgcodecs.hpp>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/render/picture.h"

namespace tubetwin {
namespace {

TEST_CASE(
    "A perceived tube has its class's colour, hidden parts, unexplained places and unseen "
    "floor are marked",
    "[render]") {
  const TemporaryFolder folder;
  PerceivedPicture seen;
  const double r = 0.0125;
  const Polyline free_line = {{-0.3, 0.1, r}, {-0.1, 0.1, r}, {0.1, 0.1, r}};
  const Polyline strong_line = {{-0.2, -0.1, r}, {0.0, -0.1, r}, {0.3, -0.1, r}};
  seen.tubes = {{4, free_line, {1, 1, 1}, r, 0}, {9, strong_line, {1, 0, 0}, r, 2}};
  seen.unexplained_N = {{0.25, 0.2, 0.02}};
  seen.unseen_floor_N = {{{-0.3, -0.25, 0}, {0.3, -0.25, 0}}};
  seen.caption = "2 tubes";
  RenderPerceivedPicture(seen, folder / "seen.png");
  const cv::Mat picture = cv::imread(folder / "seen.png");
  REQUIRE(picture.cols == 1280);
  REQUIRE(picture.rows == 720);
  const auto pixel = [&](const Vector3& p_N) {
    const auto at = Project(PileView(seen.bin), 1280, 720, seen.bin.X_BN * p_N);
    REQUIRE(at);
    return picture.at<cv::Vec3b>(static_cast<int>(at->y()), static_cast<int>(at->x()));
  };
  const cv::Vec3b green = pixel({-0.15, 0.1, 2 * r}), red = pixel({-0.12, -0.1, 2 * r});
  CHECK(green[1] > green[2] + 50);
  CHECK(red[2] > red[1] + 50);
  const cv::Vec3b hidden = pixel({0.15, -0.1, 2 * r});
  CHECK(hidden[2] < 80);
  const cv::Vec3b unexplained = pixel({0.25, 0.2, 0.02});
  CHECK(unexplained[2] > unexplained[1] + 80);
  CHECK(unexplained[0] > unexplained[1] + 80);
  const cv::Vec3b unseen = pixel({0.1, -0.25, 0.0005}), floor = pixel({0.1, -0.23, 0});
  CHECK(unseen[2] > unseen[1] + 30);
  CHECK(std::abs(floor[2] - floor[1]) < 20);
}

}  // namespace
}  // namespace tubetwin

// What a bin holds by perception, under the twin's own scanner; tests/benchmark/bin_content.cc runs
// thousands of these cases.

#include "tests/support/bin_cases.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr int kWidth = 344;  // A sixth of the scanner's columns: 1.2 mm a pixel on the floor.

void CheckCases(BinCase::Kind kind, std::uint64_t count) {
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const BinCase c = DrawBinCase(kind, seed);
    const TubeScene scene =
        Perceive(ScanBinCase(c, kWidth, {2}), c.part, c.bin, PerceptionConfig{}, {2});
    INFO("seed " << seed << ", " << c.what);
    CHECK(JudgeBinCase(c, scene) == "");
  }
}

TEST_CASE("An empty bin is called empty", "[unit]") { CheckCases(BinCase::Kind::kEmpty, 40); }

TEST_CASE("An empty bin is called empty however thin its tubes are", "[unit]") {
  for (const double radius_m : {0.004, 0.006, 0.008}) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      BinCase c = DrawBinCase(BinCase::Kind::kEmpty, seed);
      if (seed == 0) c.bin = Bin();
      c.part.radius_m = radius_m;
      const TubeScene scene =
          Perceive(ScanBinCase(c, kWidth, {2}), c.part, c.bin, PerceptionConfig{}, {2});
      INFO("seed " << seed << ", radius " << radius_m);
      CHECK(JudgeBinCase(c, scene) == "");
    }
  }
}

TEST_CASE("A bin with one tube, wherever it lies or leans, is not called empty", "[unit]") {
  CheckCases(BinCase::Kind::kTube, 60);
}

TEST_CASE("A box, ball, sheet, cable or thick pipe is unexplained and never a tube", "[unit]") {
  CheckCases(BinCase::Kind::kForeign, 60);
}

TEST_CASE("Where a view is missing a tube may hide, so the bin is not called empty", "[unit]") {
  BinCase c = DrawBinCase(BinCase::Kind::kEmpty, 1);
  c.bin = Bin();
  std::vector<OrganizedCloud> views = ScanBinCase(c, kWidth, {2});
  REQUIRE(views.size() == 8);
  const TubeScene whole = Perceive(views, c.part, c.bin, PerceptionConfig{}, {2});
  CHECK(whole.bin_content == BinContent::kEmpty);
  // The four views of one long half are gone.
  std::erase_if(views, [](const OrganizedCloud& v) { return v.X_NS.translation().y() > 0; });
  REQUIRE(views.size() == 4);
  const TubeScene half = Perceive(views, c.part, c.bin, PerceptionConfig{}, {2});
  CHECK(half.tubes.empty());
  CHECK(half.bin_content == BinContent::kUnseen);
  CHECK(half.bin_content_reason.find("no tube is seen, but one may lie") == 0);
  CHECK(half.unseen_floor_m2 > whole.unseen_floor_m2 + 0.1);
  // The unseen cells lie in that half, and their area is the figure.
  const UnseenFloor& floor = half.unseen_floor;
  int near = 0, far = 0;
  for (int j = 0; j < floor.rows; ++j) {
    for (int i = 0; i < floor.columns; ++i) {
      const int unseen = floor.unseen[static_cast<std::size_t>(j) * floor.columns + i];
      (j >= floor.rows / 2 ? far : near) += unseen;
    }
  }
  CHECK(far > 5 * near);
  CHECK((far + near) * floor.cell_x_m * floor.cell_y_m == Approx(half.unseen_floor_m2));
}

}  // namespace
}  // namespace tubetwin

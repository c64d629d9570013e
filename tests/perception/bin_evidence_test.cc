#include "perception/view/bin_evidence.h"

#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"

namespace tubetwin {
namespace {

OrganizedCloud WholeBin(double sigma_m) {
  ToyScene scene;
  ToyCamera camera;
  camera.width = 160;
  camera.height = 120;
  camera.focal_px = 125.0;
  camera.sigma_m = sigma_m;
  return ToyScan(scene, camera, LookDown({0.05, 0.02, 1.2}), RandomStream(1, 0, "bin evidence"));
}

TEST_CASE("A bin where its pose puts it hides nothing that is seen", "[unit]") {
  const Bin bin;
  for (const double sigma_m : {0.0001, 0.002}) {
    const OrganizedCloud cloud = WholeBin(sigma_m);
    const BinEvidence seen = CompareWithBin(cloud.p_SP, cloud.X_NS, bin);
    INFO(sigma_m);
    CHECK(seen.valid == cloud.size());
    CHECK(seen.inside > seen.valid / 4);
    CHECK(seen.through_floor + seen.through_walls < seen.valid / 500);
    CHECK(BinWarning(seen).empty());
  }
}

TEST_CASE("What floor and walls would hide is counted and told", "[unit]") {
  const OrganizedCloud cloud = WholeBin(0.0001);
  const auto compare = [&](const RigidTransform& X_NTrue, std::array<double, 3> size_m) {
    Bin bin;
    bin.size_m = size_m;
    return CompareWithBin(cloud.p_SP, X_NTrue * cloud.X_NS, bin);
  };
  const std::array<double, 3> right = {0.77, 0.58, 0.09};
  const BinEvidence lower = compare(Translation(0, 0, -0.02), right);
  CHECK(lower.through_floor > lower.valid / 5);
  CHECK(BinWarning(lower).find("below its floor") != std::string::npos);
  const BinEvidence aside = compare(Translation(0.1, 0, 0), right);
  CHECK(aside.through_walls > 100);
  const BinEvidence smaller = compare(Translation(0, 0, 0), {0.5, 0.4, 0.6});
  CHECK(smaller.through_walls > smaller.valid / 20);
  CHECK_FALSE(BinWarning(smaller).empty());
  CHECK(compare(Translation(0, 0, -1.0), right).inside == 0);
  CHECK(compare(Translation(2.0, 0, 0), right).inside == 0);
}

TEST_CASE("A line of sight ends at walls from both sides, and passes over the rim", "[unit]") {
  const Bin bin;  // 0.77 x 0.58 x 0.09 m.
  const Vector3 eye(0, 0, 0.5);
  CHECK_FALSE(IsBelowFloor({0.1, 0.1, 0.0}, bin));
  CHECK(IsBelowFloor({0.1, 0.1, -0.02}, bin));
  CHECK_FALSE(IsBelowFloor({0.5, 0.1, -0.02}, bin));  // Beside the bin.
  const auto crossed = [&](const Vector3& from, const Vector3& p) {
    const auto crossing = CrossedWall(from, p, bin);
    return crossing ? crossing->side : -1;
  };
  CHECK(crossed(eye, {0.1, 0.1, 0.0}) == -1);
  CHECK(crossed(eye, {0.44, 0, 0}) == 1);
  CHECK(crossed(eye, {0, -0.33, 0}) == 2);
  CHECK(CrossedWall(eye, {0.44, 0.22, 0}, bin)->along_m == Approx(0.22 * 0.385 / 0.44));
  CHECK(crossed(eye, {0.395, 0, 0.09}) == -1);  // On the rim.
  CHECK(crossed(eye, {0.9, 0, 0.0}) == -1);     // Over it, to the table.
  const Vector3 beside(1.0, 0, 0.2);
  CHECK(crossed(beside, {0.405, 0, 0.05}) == -1);  // The wall's outer face.
  CHECK(crossed(beside, {0.2, 0, 0.0}) == 1);
}

}  // namespace
}  // namespace tubetwin

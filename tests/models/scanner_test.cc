#include "models/scanner_spec.h"

#include "models/arm/arm.h"
#include "models/cell_model.h"
#include "models/clearance.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

constexpr double kRounding = 1e-12;

Shape Housing() {
  for (const auto& shape : MovingShapes(PaperCell())) {
    if (shape.name == "scanner") return shape;
  }
  FAIL("the arm carries no scanner");
  throw 0;
}

TEST_CASE("Camera and projector look out of the front of the housing that is drawn and checked",
          "[unit]") {
  const ScannerSpec& spec = PaperCell().scanner;
  const auto housing = Housing();
  CHECK(2 * housing.size_m.x() == Approx(spec.housing_x_m));
  for (const RigidTransform& X_SAperture : {RigidTransform::Identity(), ProjectorPose(spec)}) {
    const RigidTransform X_FAperture = PaperCell().layout.X_FS * X_SAperture;
    const RigidTransform X_HousingAperture = housing.X_LinkShape.inverse() * X_FAperture;
    const Vector3 p = X_HousingAperture.translation();
    CHECK(std::abs(p.z() - housing.size_m.z()) < kRounding);
    constexpr double kRim_m = 0.02;  // A lens has a width.
    CHECK(std::abs(p.x()) < housing.size_m.x() - kRim_m);
    CHECK(std::abs(p.y()) < housing.size_m.y() - kRim_m);
    CHECK(X_HousingAperture.linear()(2, 2) == Approx(std::cos(Radians(15.45))));
  }
}

TEST_CASE("The optical axes cross at the sweet spot, the baseline is the data sheet's", "[unit]") {
  const ScannerSpec& spec = PaperCell().scanner;
  const RigidTransform X_SP = ProjectorPose(spec);
  CHECK(X_SP.translation().norm() == Approx(0.235));
  // The projector's axis meets the camera's, x = y = 0 of S.
  const Vector3 axis = X_SP.linear().col(2);
  const double s = -X_SP.translation().x() / axis.x();
  const Vector3 crossing = X_SP.translation() + s * axis;
  CHECK(std::abs(crossing.y()) < kRounding);
  constexpr double kBaselineRounding_m = 0.0006;  // The vendor's 2 * 117.4 mm against 235.
  CHECK(crossing.z() == Approx(0.4406).margin(kBaselineRounding_m));
  CHECK(std::abs(crossing.z() - spec.sweet_spot_m) < 0.002);
  CHECK(s == Approx(crossing.z()));  // As far from the projector as from the camera.
  CHECK(HousingPose(spec).linear().col(0).dot(X_SP.translation()) == Approx(0.235));
}

TEST_CASE("With the pads at the floor the housing passes over the walls of the paper's bin",
          "[unit]") {
  const auto housing = Housing();
  const CellLayout layout = PaperCell().layout;
  double lowest_m = 0;  // Beyond the flange.
  for (int k = 0; k < 8; ++k) {
    const Vector3 corner =
        housing.size_m.cwiseProduct(Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
    lowest_m = std::max(lowest_m, (housing.X_LinkShape * corner).z());
  }
  constexpr double kLowestE_m = 0.021;  // On a tube of radius 12.5 mm that lies on the floor.
  CHECK(layout.X_FE.translation().z() + kLowestE_m - lowest_m > Bin().wall_m() + 0.005);
}

}  // namespace
}  // namespace tubetwin

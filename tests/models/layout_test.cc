#include "models/cell_model.h"

#include <cmath>

#include "models/arm/arm.h"
#include "models/gripper_spec.h"
#include "models/scanner_spec.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

/// Whether the camera at X_BS has the point in its image.
bool Sees(const RigidTransform& X_BS, const Vector3& p_B) {
  const ScannerSpec& spec = PaperCell().scanner;
  const Vector3 p_S = X_BS.inverse() * p_B;
  return p_S.z() > spec.soft_min_m &&
         std::abs(p_S.x()) * spec.focal_px <= 0.5 * spec.full_width * p_S.z() &&
         std::abs(p_S.y()) * spec.focal_px <= 0.5 * spec.full_height * p_S.z();
}

void CheckCoverage(const Bin& bin) {
  const auto views = ScanPosesOf(PaperCell(), bin);
  constexpr int kSteps = 40;
  int unseen = 0;
  for (const double z : {0.0, 0.07, 0.13}) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        const Vector3 p_N(bin.half_x_m() * (2.0 * i / kSteps - 1),
                          bin.half_y_m() * (2.0 * j / kSteps - 1), z);
        const Vector3 p_B = bin.X_BN * p_N;
        unseen += std::none_of(views.begin(), views.end(),
                               [&](const RigidTransform& X_BS) { return Sees(X_BS, p_B); });
      }
    }
  }
  CHECK(unseen == 0);
}

TEST_CASE("The scan poses of the paper's bin are the eight of the design", "[unit]") {
  const auto views = ScanPosesOf(PaperCell(), Bin());
  REQUIRE(views.size() == 8);
  for (const double x : {0.455, 0.745}) {
    for (const double y : {-0.29, -0.10, 0.10, 0.29}) {
      CHECK(std::any_of(views.begin(), views.end(), [&](const RigidTransform& X_BS) {
        return (X_BS.translation() - Vector3(x, y, 0.615)).norm() < 1e-12;
      }));
    }
  }
  for (const auto& X_BS : views) {
    CHECK((X_BS.linear().col(2) + Vector3::UnitZ()).norm() < 1e-12);  // straight down
    CHECK((X_BS.linear().col(0) - Vector3::UnitX()).norm() < 1e-12);
  }
}

TEST_CASE("The scans cover the floor and everything up to 0.13 m over it", "[unit]") {
  CheckCoverage(Bin());
  CheckCoverage(Bin{{0.80, 0.60, 0.09}, DefaultBinPose()});
  CheckCoverage(Bin{{0.80, 0.60, 0.20}, DefaultBinPose()});
  CheckCoverage(Bin{{0.40, 0.30, 0.09}, DefaultBinPose()});
  CheckCoverage(Bin{{0.70, 0.62, 0.09}, Translation(0.62, 0.05, 0.10)});
  CheckCoverage(Bin{{0.77, 0.58, 0.09}, MakeTransform(RotZ(1.2), Vector3(0.6, 0.0, 0.12))});
}

/// Whether no wall stands between the projector at X_BS and a place in the bin.
bool Lit(const RigidTransform& X_BS, const Bin& bin, const Vector3& p_N) {
  const ScannerSpec& spec = PaperCell().scanner;
  const double toe_in = Radians(spec.toe_in_deg);
  const Vector3 p_NP = bin.X_BN.inverse() * X_BS *
                       (spec.baseline_m * Vector3(std::cos(toe_in), 0, std::sin(toe_in)));
  const double share = (bin.wall_m() - p_N.z()) / (p_NP.z() - p_N.z());
  const Vector3 at_rim_N = p_N + share * (p_NP - p_N);
  return std::abs(at_rim_N.x()) <= bin.half_x_m() && std::abs(at_rim_N.y()) <= bin.half_y_m();
}

TEST_CASE("A tube's flank is seen and lit wherever it lies, also beside a high wall", "[unit]") {
  for (const Bin& bin :
       {Bin(), Bin{{0.80, 0.60, 0.20}, DefaultBinPose()}, Bin{{0.80, 0.60, 0.13}, DefaultBinPose()},
        Bin{{0.60, 0.40, 0.20}, DefaultBinPose()}}) {
    for (const double radius_m : {0.010, 0.008, 0.006, 0.004}) {
      const auto views = ScanPosesOf(PaperCell(), bin, radius_m);
      int dark = 0;
      constexpr int kSteps = 40;
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          const Vector3 p_N((bin.half_x_m() - 2 * radius_m) * (2.0 * i / kSteps - 1),
                            (bin.half_y_m() - 2 * radius_m) * (2.0 * j / kSteps - 1),
                            0.5 * radius_m);
          dark += std::none_of(views.begin(), views.end(), [&](const RigidTransform& X_BS) {
            return Sees(X_BS, bin.X_BN * p_N) && Lit(X_BS, bin, p_N);
          });
        }
      }
      INFO(bin.size_m[0] << " x " << bin.size_m[1] << " x " << bin.size_m[2] << ", " << radius_m);
      CHECK(dark == 0);
    }
  }
}

TEST_CASE("Every scan pose is reached in the working family well inside the limits", "[unit]") {
  constexpr double kMargin_rad = 0.5;
  const CellLayout layout = PaperCell().layout;
  for (const Bin& bin : {Bin(), Bin{{0.80, 0.60, 0.20}, DefaultBinPose()}}) {
    for (const auto& X_BS : ScanPosesOf(PaperCell(), bin)) {
      const RigidTransform X_BF = X_BS * layout.X_FS.inverse();
      const auto result = InverseWorking(PaperCell().arm, X_BF);
      REQUIRE(result.status == InverseNearResult::Status::kFound);
      for (int i = 0; i < kNumJoints; ++i) {
        CHECK(result.q[i] > PaperCell().arm.joints[i].lower_rad + kMargin_rad);
        CHECK(result.q[i] < PaperCell().arm.joints[i].upper_rad - kMargin_rad);
      }
      CHECK(Manipulability(PaperCell().arm, result.q, layout.X_FE) > 0.15);
      // The closed fingers pass over the bin's walls.
      const double tips_z =
          (X_BF * layout.X_FE.translation()).z() - 0.5 * PaperCell().gripper.pad_height_m;
      CHECK(tips_z > bin.X_BN.translation().z() + bin.wall_m() + 0.05);
    }
  }
}

TEST_CASE("Scan poses move with the bin", "[unit]") {
  Bin moved;
  moved.X_BN = Translation(0.02, -0.03, 0.04) * moved.X_BN;
  const auto a = ScanPosesOf(PaperCell(), Bin());
  const auto b = ScanPosesOf(PaperCell(), moved);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK((b[i].translation() - a[i].translation() - Vector3(0.02, -0.03, 0.04)).norm() < 1e-12);
  }
}

TEST_CASE("The fingertips advance while closing as the linkage's table says", "[unit]") {
  constexpr double kTable_m = 0.00015;  // the table's top row is at 85.4 mm
  CHECK(TipAdvance(PaperCell().gripper, 0.085) == 0.0);
  CHECK(std::abs(TipAdvance(PaperCell().gripper, 0.0666) - 0.0066) < kTable_m);
  CHECK(std::abs(TipAdvance(PaperCell().gripper, 0.0456) - 0.0112) < kTable_m);
  CHECK(std::abs(TipAdvance(PaperCell().gripper, 0.0231) - 0.0136) < kTable_m);
  CHECK(std::abs(TipAdvance(PaperCell().gripper, 0.0) - 0.0138) < kTable_m);
  // Cranks of 57.5 mm at 49.2 degrees when open: the table comes from them.
  constexpr double kInterpolation_m = 0.0005;
  for (double crank = 0.0; crank < 0.7; crank += 0.02) {
    const double start = Radians(49.2);
    const double opening = 0.0854 - 2 * 0.0575 * (std::cos(start) - std::cos(start + crank));
    const double advance = 0.0575 * (std::sin(start + crank) - std::sin(start));
    CHECK(std::abs(TipAdvance(PaperCell().gripper, opening) - advance) < kInterpolation_m);
  }
  for (int i = 0; i < 850; ++i)
    CHECK(TipAdvance(PaperCell().gripper, i * 1e-4) >=
          TipAdvance(PaperCell().gripper, (i + 1) * 1e-4));
  CHECK(PadRetreat(PaperCell().gripper, 0.0) == 0.0);
}

TEST_CASE("A grasp keeps the pads 2 mm over the floor", "[unit]") {
  const GripperSpec& spec = PaperCell().gripper;
  CHECK(GraspHeightOverAxis(0.0125, PaperCell().gripper) == 0.009);
  CHECK(GraspHeightOverAxis(0.08, PaperCell().gripper) == 0.009);
  CHECK(std::abs(0.010 + GraspHeightOverAxis(0.010, PaperCell().gripper) - 0.5 * spec.pad_height_m -
                 0.002) < 1e-12);
}

}  // namespace
}  // namespace tubetwin

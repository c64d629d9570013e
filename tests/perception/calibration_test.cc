#include "perception/calibration/calibration.h"

#include <cmath>
#include <string>

#include "models/base/error.h"
#include "tests/support/calibration_cell.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using test::CalibrationCell;

constexpr Parallelism kThreads{2};
/// What is promised, and what a cell of the twin draws as hand-eye error.
constexpr double kShift_mm = 0.3, kTurn_deg = 0.05;

double Shift_mm(const RigidTransform& a, const RigidTransform& b) {
  return 1e3 * (a.translation() - b.translation()).norm();
}
double Turn_deg(const RigidTransform& a, const RigidTransform& b) {
  return Degrees(Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle());
}

/// Views with a scanner that hangs 5 mm and 1 degree, and a bin that stands 15 mm, off their start
/// values.
CalibrationInput Misplaced(const CalibrationCell& cell, int views) {
  CalibrationInput input = cell.Views(views, 20.0);
  input.X_FS = cell.Disturbed(cell.X_FS, 0.005, Radians(1.0));
  input.bin.X_BN.translation() += Vector3(0.012, -0.008, 0.006);
  return input;
}

TEST_CASE("The scanner on the flange is found from views of floor and walls", "[render]") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CalibrationCell cell(seed);
    const Calibration found = CalibrateHandEye(Misplaced(cell, 8), kThreads);
    INFO("seed " << seed);
    CHECK(Shift_mm(found.X_FS, cell.X_FS) < kShift_mm);
    CHECK(Turn_deg(found.X_FS, cell.X_FS) < kTurn_deg);
    CHECK(Shift_mm(found.X_BN, cell.bin.X_BN) < 2 * kShift_mm);
    CHECK(found.moved_m == Approx(0.005).margin(1e-3 * kShift_mm));
    CHECK(Degrees(found.turned_rad) == Approx(1.0).margin(kTurn_deg));
  }
}

TEST_CASE("Calibration does not depend on the thread count", "[render]") {
  const CalibrationCell cell(7);
  const CalibrationInput input = Misplaced(cell, 6);
  const Calibration one = CalibrateHandEye(input, Parallelism{1});
  CHECK(one.X_FS.matrix() == CalibrateHandEye(input, Parallelism{3}).X_FS.matrix());
}

TEST_CASE("Poses that are too much alike are refused with the pose to add", "[render]") {
  const CalibrationCell cell(1);
  const auto refused = [&](int views, double tilt_deg, double turn_deg, const std::string& why) {
    CHECK_THROWS_WITH(CalibrateHandEye(cell.Views(views, tilt_deg, turn_deg), kThreads),
                      Contains(why));
  };
  refused(2, 20.0, 180.0, "there are 2 views, at least 3");
  refused(4, 0.0, 0.0, "turned alike in all 4 views");
  refused(4, 1.0, 2.0, "turned alike in all 4 views");
  refused(4, 0.0, 180.0, "about its axis z alone");
  refused(4, 0.5, 180.0, "add views tilted by 10 to 20 degrees");
  // A shift along what the flange never leaves is what they cannot tell.
  CHECK_NOTHROW(CalibrateBin(cell.Views(4, 0.0, 0.0), kThreads));
}

TEST_CASE("A wall that is not where the bin's size says is refused", "[render]") {
  CalibrationCell cell(2);
  cell.wall_off_m = 0.004;
  CHECK_THROWS_WITH(CalibrateHandEye(Misplaced(cell, 8), kThreads),
                    Contains("bin.size_m: is 0.7700 m along x,") && Contains("it is 0.76"));
  CHECK_THROWS_WITH(CalibrateBin(cell.Views(4, 20.0), kThreads),
                    Contains("bin.size_m: is 0.7700 m along x,") && Contains("it is 0.766"));
  // Where all views are tilted alike, a shift of the scanner away from the bin takes up most of it.
  CHECK_THROWS_AS(CalibrateHandEye(cell.Views(4, 20.0), kThreads), Error);
  CalibrationInput smaller = CalibrationCell(3).Views(4, 20.0);
  smaller.bin.size_m = {0.80, 0.60, 0.09};
  CHECK_THROWS_AS(CalibrateBin(smaller, kThreads), Error);
}

TEST_CASE("A bin that is not empty is refused", "[render]") {
  CalibrationCell cell(3);
  cell.part_radius_m = 0.0125;
  CHECK_THROWS_WITH(CalibrateBin(cell.Views(4, 20.0), kThreads),
                    Contains("inside the bin") && Contains("take out what is in it"));
}

TEST_CASE("The bin is found wherever it was thought to be", "[render]") {
  const CalibrationCell cell(4);
  CalibrationInput input = cell.Views(4, 20.0);
  for (const double yaw_deg : {0.0, 3.0, -40.0, 70.0}) {
    input.bin.X_BN = Translation(0.15, -0.08, 0.02) * cell.bin.X_BN;
    input.bin.X_BN.linear() = cell.bin.X_BN.linear() * RotZ(Radians(yaw_deg));
    const Calibration found = CalibrateBin(input, kThreads);
    INFO("yaw off by " << yaw_deg);
    CHECK(Shift_mm(found.X_BN, cell.bin.X_BN) < kShift_mm);
    CHECK(Turn_deg(found.X_BN, cell.bin.X_BN) < kTurn_deg);
    CHECK((found.turned_rad > kDoubtfulTurn_rad) == (std::abs(yaw_deg) > 45.0));
  }
  // From the other side it is the bin turned by half a turn.
  input.bin.X_BN.linear() = cell.bin.X_BN.linear() * RotZ(kPi - 0.2);
  const Calibration other = CalibrateBin(input, kThreads);
  CHECK(Turn_deg(other.X_BN, cell.bin.X_BN) == Approx(180.0).margin(kTurn_deg));
  CHECK(Degrees(other.turned_rad) == Approx(Degrees(0.2)).margin(kTurn_deg));
}

TEST_CASE("A floor that leans is refused by its angle: a cell file knows a yaw alone", "[render]") {
  CalibrationCell cell(5);
  cell.bin.X_BN = cell.bin.X_BN * MakeTransform(RotX(Radians(1.2)), Vector3::Zero());
  CHECK_THROWS_WITH(CalibrateBin(cell.Views(4, 20.0), kThreads),
                    Contains("leans by 1.20 degrees") && Contains("level the bin"));
  const Calibration scanner = CalibrateHandEye(cell.Views(8, 20.0), kThreads);
  CHECK(Degrees(scanner.lean_rad) == Approx(1.2).margin(kTurn_deg));
  CHECK(Shift_mm(scanner.X_FS, cell.X_FS) < kShift_mm);
}

TEST_CASE("Views without two walls that meet tell no bin", "[render]") {
  const CalibrationCell cell(6);
  CalibrationInput input = cell.Views(0, 0.0);
  CHECK_THROWS_WITH(CalibrateBin(input, kThreads), Contains("neither a view nor a touch"));
  const RigidTransform over = MakeTransform(RotX(kPi), Vector3(0, 0, 0.45));
  input.views.push_back(cell.View(cell.bin.X_BN * over, 0));
  CHECK_THROWS_WITH(CalibrateBin(input, kThreads),
                    Contains("only floor") && Contains("two walls that meet"));
}

/// Touches of a bin that truly stands at X_BN.
CalibrationInput Touched(const Bin& truth) {
  CalibrationInput input;
  input.bin = truth;
  const double x = truth.half_x_m(), y = truth.half_y_m();
  const auto touch = [&](bool floor, const Vector3& p_N) {
    input.touches.push_back(
        {"touch " + std::to_string(input.touches.size() + 1), floor, truth.X_BN * p_N});
  };
  for (const double side : {-1.0, 1.0}) touch(true, {0.8 * side * x, 0.7 * y, 0.0});
  touch(true, {0.1, -0.8 * y, 0.0});
  for (const double side : {-1.0, 1.0}) touch(false, {0.7 * side * x, -y, 0.05});
  touch(false, {x, 0.7 * y, 0.05});
  touch(false, {-x, -0.7 * y, 0.05});
  return input;
}

TEST_CASE("The bin is found by touches alone", "[unit]") {
  Bin truth;
  truth.X_BN = MakeTransform(RotZ(Radians(92.5)), Vector3(0.61, 0.02, 0.095));
  CalibrationInput input = Touched(truth);
  input.bin.X_BN = DefaultBinPose();
  const Calibration found = CalibrateBin(input, kThreads);
  constexpr double kExact_mm = 1e-4;
  CHECK(Shift_mm(found.X_BN, truth.X_BN) < kExact_mm);
  CHECK(Turn_deg(found.X_BN, truth.X_BN) < 1e-4);
  CHECK(found.residuals.size() == 7);
  CHECK(found.residuals[5].plane == "wall +x");

  CalibrationInput wrong = input;
  wrong.touches[4].p_B += truth.X_BN.linear() * Vector3(0, 0.004, 0);
  CHECK_THROWS_WITH(CalibrateBin(wrong, kThreads),
                    Contains("check the poses of views and touches"));
  // A floor touched 0.9 mm too high is let pass, but tells less.
  CalibrationInput rough = input;
  rough.touches[2].p_B.z() += 0.0009;
  CHECK(CalibrateBin(rough, kThreads).uncertainty_m > 1.5 * found.uncertainty_m);
  // Of a floor nothing else may be wrong.
  wrong = input;
  wrong.touches[2].p_B.z() += 0.006;
  CHECK_THROWS_WITH(CalibrateBin(wrong, kThreads),
                    Contains("touch 3: floor: its points are") && Contains("allowed are 1.0 mm"));
  CalibrationInput few = input;
  few.touches.pop_back();
  CHECK_THROWS_WITH(CalibrateBin(few, kThreads),
                    Contains("3 of walls; needed are") || Contains("and 3 of walls"));
  CalibrationInput corner = input;
  corner.touches[6].p_B = truth.X_BN * Vector3(-truth.half_x_m(), -truth.half_y_m() + 0.01, 0.05);
  CHECK_THROWS_WITH(CalibrateBin(corner, kThreads), Contains("touch 7: is") && Contains("corner"));
  CalibrationInput one_side = input;
  for (std::size_t i = 5; i < 7; ++i) {
    one_side.touches[i].p_B = truth.X_BN * Vector3(0.1, -truth.half_y_m(), 0.02);
  }
  CHECK_THROWS_WITH(CalibrateBin(one_side, kThreads), Contains("only floor, wall -y"));
  // The floor's touches were of something 0.3 m higher: the walls' are under it then.
  CalibrationInput high = input;
  for (CalibrationTouch& touch : high.touches) {
    if (touch.on_floor) touch.p_B.z() += 0.3;
  }
  CHECK_THROWS_WITH(CalibrateBin(high, kThreads),
                    Contains("touch 4: lies 250 mm under the floor or over the rim"));
}

TEST_CASE("A scanner on a stand is found with touches, and refused without", "[render]") {
  const CalibrationCell cell(8);
  const RigidTransform X_BS =
      cell.bin.X_BN * CalibrationCell::IntoCorner(1, Radians(22.0), Radians(-34.0));
  CalibrationInput input = Touched(cell.bin);
  input.on_stand = true;
  input.views.push_back(cell.View(X_BS, 0));
  input.views[0].X_BF = RigidTransform::Identity();
  input.X_FS = cell.Disturbed(X_BS, 0.01, Radians(1.5));
  const Calibration found = CalibrateHandEye(input, kThreads);
  CHECK(Shift_mm(found.X_FS, X_BS) < kShift_mm);
  CHECK(Turn_deg(found.X_FS, X_BS) < kTurn_deg);
  CalibrationInput one_wall = input;
  one_wall.views[0] =
      cell.View(cell.bin.X_BN * CalibrationCell::IntoCorner(1, Radians(20.0), Radians(70.0)), 0);
  one_wall.views[0].X_BF = RigidTransform::Identity();
  CHECK_THROWS_WITH(CalibrateHandEye(one_wall, kThreads),
                    Contains("not at all in one direction") && Contains("two walls that meet"));
  input.touches.clear();
  CHECK_THROWS_WITH(CalibrateHandEye(input, kThreads), Contains("on a stand sees the bin alike"));
}

}  // namespace
}  // namespace tubetwin

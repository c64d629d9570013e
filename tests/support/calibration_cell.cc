#include "tests/support/calibration_cell.h"

#include <array>

namespace tubetwin::test {
namespace {

Vector3 SomeDirection(RandomStream& stream) {
  for (;;) {
    const Vector3 v(stream.Uniform(-1, 1), stream.Uniform(-1, 1), stream.Uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
  }
}

}  // namespace

CalibrationCell::CalibrationCell(std::uint64_t seed) : X_FS(PaperCell().layout.X_FS), seed_(seed) {
  bin.size_m = PaperCell().layout.bin_size_m;
  bin.X_BN = PaperCell().layout.X_BN;
}

CalibrationView CalibrationCell::View(const RigidTransform& X_BS, int number) const {
  ScanGeometry geometry;
  const double x = bin.half_x_m(), y = bin.half_y_m(), h = 0.5 * bin.wall_m();
  const double t = 0.5 * Bin::kWallThickness_m;
  const auto box = [&](const Vector3& centre_N, const Vector3& half_m) {
    geometry.boxes.push_back({bin.X_BN * Translation(centre_N), half_m, kLabelCell, kCellAlbedo});
  };
  box({0, 0, -t}, {x + 2 * t, y + 2 * t, t});
  box({x + t - wall_off_m, 0, h}, {t, y + 2 * t, h});
  box({-x - t, 0, h}, {t, y + 2 * t, h});
  for (const double side : {-1.0, 1.0}) box({0, side * (y + t), h}, {x + 2 * t, t, h});
  if (part_radius_m > 0.0) {
    geometry.capsules.push_back({bin.X_BN * Vector3(-0.25, -0.1, part_radius_m),
                                 bin.X_BN * Vector3(0.25, 0.1, part_radius_m), part_radius_m,
                                 kLabelFirstTube, 0.5F});
  }
  CalibrationView out;
  out.name = "view_" + std::to_string(number) + ".pcd";
  out.cloud = CastScan(geometry, X_BS, PaperScan(),
                       RandomStream(seed_, 0, "calibration").Fork("scan", number), Parallelism{2});
  out.X_BF = X_BS * X_FS.inverse();
  return out;
}

RigidTransform CalibrationCell::IntoCorner(int corner, double tilt_rad, double turn_rad) {
  const Vector3 look_N(corner % 2 == 0 ? 0.28 : -0.28, (corner / 2) % 2 == 0 ? 0.19 : -0.19, 0.0);
  // From over the middle outwards, so that the walls face the camera.
  const Vector3 axis = Vector3(-look_N.y(), look_N.x(), 0.0).normalized();
  const Matrix3 tilt = Eigen::AngleAxisd(-tilt_rad, axis).toRotationMatrix();
  const Matrix3 R_NS = tilt * RotZ(turn_rad) * RotX(kPi);
  return MakeTransform(R_NS, look_N - 0.48 * R_NS.col(2));
}

CalibrationInput CalibrationCell::Views(int count, double tilt_deg, double turn_deg) const {
  CalibrationInput out;
  out.X_FS = X_FS;
  out.bin = bin;
  RandomStream stream(seed_, 0, "calibration poses");
  for (int i = 0; i < count; ++i) {
    // Four tilted, four nearly not: a size that is wrong looks like a shift in neither.
    const double tilt =
        Radians(tilt_deg * ((i / 4) % 2 == 0 ? 1.0 : 0.25) * stream.Uniform(0.8, 1.2));
    out.views.push_back(
        View(bin.X_BN * IntoCorner(i, tilt, Radians(stream.Uniform(-turn_deg, turn_deg))), i));
  }
  return out;
}

RigidTransform CalibrationCell::Disturbed(const RigidTransform& X, double shift_m,
                                          double turn_rad) const {
  RandomStream stream(seed_, 0, "calibration start");
  const Matrix3 turn = Eigen::AngleAxisd(turn_rad, SomeDirection(stream)).toRotationMatrix();
  return X * MakeTransform(turn, shift_m * SomeDirection(stream));
}

}  // namespace tubetwin::test

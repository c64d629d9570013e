#include "perception/view/bin_evidence.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "perception/view/view_raster.h"

namespace tubetwin {
namespace {

/// What lies in a bin reaches at most this high over the floor, or over the walls.
constexpr double kCeiling_m = 0.25, kOverWalls_m = 0.1;
/// Noise, calibration and the rim's edge move a point by less.
constexpr double kFloorSlack_m = 0.004, kThrough_m = 0.012;
/// Scanners see no further to the side than this, over the depth.
constexpr float kWidest = 2.0f;
/// Share of the points that mirror images and flying pixels may be.
constexpr double kStrays = 0.05;

}  // namespace

BinEvidence& BinEvidence::operator+=(const BinEvidence& other) {
  valid += other.valid;
  inside += other.inside;
  through_floor += other.through_floor;
  through_walls += other.through_walls;
  return *this;
}

bool SeenFromOrigin(const std::vector<Eigen::Vector3f>& points_S) {
  std::size_t valid = 0, before = 0;
  for (const auto& p : points_S) {
    if (!IsValid(p)) continue;
    ++valid;
    before += p.z() >= kNearest_m && std::max(std::abs(p.x()), std::abs(p.y())) < kWidest * p.z();
  }
  return valid > 0 && (valid - before) * 100 <= valid;
}

std::optional<WallCrossing> CrossedWall(const Vector3& eye_N, const Vector3& p_N, const Bin& bin) {
  const double half[2] = {bin.half_x_m(), bin.half_y_m()};
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? -1.0 : 1.0;
    const double eye_out = sign * eye_N[axis] - half[axis], out = sign * p_N[axis] - half[axis];
    if (std::abs(out) < kThrough_m || (eye_out > 0) == (out > 0)) continue;
    const Vector3 at = eye_N + eye_out / (eye_out - out) * (p_N - eye_N);
    const bool beside = std::abs(at[1 - axis]) > half[1 - axis] - kThrough_m;
    if (!beside && at.z() > kThrough_m && at.z() < bin.wall_m() - kThrough_m) {
      return WallCrossing{side, at[1 - axis]};
    }
  }
  return std::nullopt;
}

bool IsBelowFloor(const Vector3& p_N, const Bin& bin) {
  return p_N.z() < -kThrough_m && std::abs(p_N.x()) < bin.half_x_m() - kThrough_m &&
         std::abs(p_N.y()) < bin.half_y_m() - kThrough_m;
}

BinEvidence CompareWithBin(const std::vector<Eigen::Vector3f>& points_S, const RigidTransform& X_NS,
                           const Bin& bin) {
  const double t = Bin::kWallThickness_m;
  const double high = std::max(kCeiling_m, bin.wall_m() + kOverWalls_m);
  const bool seen_from_S = SeenFromOrigin(points_S);
  const Vector3 eye_N = X_NS.translation();
  BinEvidence out;
  for (const auto& p_S : points_S) {
    if (!IsValid(p_S)) continue;
    ++out.valid;
    const Vector3 p_N = X_NS * p_S.cast<double>();
    const double out_m =
        std::max(std::abs(p_N.x()) - bin.half_x_m(), std::abs(p_N.y()) - bin.half_y_m());
    out.inside += out_m < t && p_N.z() > -kFloorSlack_m && p_N.z() < high;
    if (!seen_from_S) continue;
    if (IsBelowFloor(p_N, bin)) {
      ++out.through_floor;
    } else {
      out.through_walls += CrossedWall(eye_N, p_N, bin).has_value();
    }
  }
  return out;
}

std::string BinWarning(const BinEvidence& evidence) {
  const std::size_t through = evidence.through_floor + evidence.through_walls;
  if (static_cast<double>(through) <= kStrays * static_cast<double>(evidence.valid)) return {};
  char text[220];
  std::snprintf(text, sizeof text,
                "%zu of %zu points are seen where the bin would hide them, %zu below its floor and "
                "%zu through its walls: check the pose and the bin's size",
                through, evidence.valid, evidence.through_floor, evidence.through_walls);
  return text;
}

}  // namespace tubetwin

#include "perception/view/wall_lines.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "perception/view/voxel_grid.h"

namespace tubetwin {
namespace {

/// Patches are cubes of this edge with their neighbours two cubes away.
constexpr double kCube_m = 0.005;
constexpr int kReach = 2;
constexpr double kFewest = 10.0;
/// Thickness (rms) of a patch, from stereo noise, and its least width (rms); a tube of 12 mm radius
/// is thicker over this width.
constexpr double kThick_m = 0.002, kWide_m = 0.0035;
/// Sine of the steepest lean of a wall.
constexpr double kLean = 0.17;
/// Patches this far from a direction belong to no wall of it.
const double kCosineFacing = std::cos(Radians(12.0));
constexpr double kYawStep_deg = 0.5;
constexpr double kOffsetBin_m = 0.002;
constexpr double kShortest_m = 0.05;
constexpr int kFewestPatches = 25;
/// Least share of the strongest line's patches, and how far apart two lines are.
constexpr double kWeakest = 0.04, kApart_m = 0.010;
constexpr int kLinesPerDirection = 4;

struct Moments {
  double n = 0;
  Vector3 sum = Vector3::Zero(), eye = Vector3::Zero();
  Matrix3 squares = Matrix3::Zero();
  Moments& operator+=(const Moments& other) {
    n += other.n;
    sum += other.sum;
    eye += other.eye;
    squares += other.squares;
    return *this;
  }
};

/// Patches of a direction by their offset along it.
struct Offsets {
  double low_m = 0.0;
  std::vector<double> counts;  ///< With a margin of two bins.
  double Window(std::size_t i) const { return counts[i - 1] + counts[i] + counts[i + 1]; }
};

Offsets OffsetsAlong(const std::vector<WallPatch>& patches, const Eigen::Vector2d& direction) {
  Offsets out;
  double high = -1e9;
  out.low_m = 1e9;
  for (const WallPatch& patch : patches) {
    if (patch.facing.dot(direction) < kCosineFacing) continue;
    const double at = patch.p_P.head<2>().dot(direction);
    out.low_m = std::min(out.low_m, at);
    high = std::max(high, at);
  }
  if (high < out.low_m) return out;
  out.low_m -= 2 * kOffsetBin_m;
  out.counts.assign(static_cast<std::size_t>((high - out.low_m) / kOffsetBin_m) + 4, 0.0);
  for (const WallPatch& patch : patches) {
    if (patch.facing.dot(direction) < kCosineFacing) continue;
    const double at = patch.p_P.head<2>().dot(direction);
    out.counts[static_cast<std::size_t>((at - out.low_m) / kOffsetBin_m)] += 1.0;
  }
  return out;
}

/// How much the patches pile up on few lines.
double Sharpness(const std::vector<WallPatch>& patches, double yaw_rad) {
  double sum = 0.0;
  for (int d = 0; d < 4; ++d) {
    const Offsets offsets = OffsetsAlong(patches, DirectionOf(yaw_rad, d));
    for (std::size_t i = 1; i + 1 < offsets.counts.size(); ++i) {
      sum += offsets.Window(i) * offsets.Window(i);
    }
  }
  return sum;
}

WallLine LineAt(const std::vector<WallPatch>& patches, double yaw_rad, int direction,
                double offset_m) {
  const Eigen::Vector2d across = DirectionOf(yaw_rad, direction);
  const Eigen::Vector2d along = DirectionOf(yaw_rad, direction + 1);
  WallLine out;
  out.direction = direction;
  std::vector<double> places, heights;
  double sum = 0.0;
  for (const WallPatch& patch : patches) {
    if (patch.facing.dot(across) < kCosineFacing) continue;
    const double at = patch.p_P.head<2>().dot(across);
    if (std::abs(at - offset_m) > 2.5 * kOffsetBin_m) continue;
    places.push_back(patch.p_P.head<2>().dot(along));
    heights.push_back(patch.p_P.z());
    sum += at;
  }
  out.patches = static_cast<int>(places.size());
  if (out.patches == 0) return out;
  // Strays do not make a wall longer or higher.
  std::sort(places.begin(), places.end());
  std::sort(heights.begin(), heights.end());
  const std::size_t strays = places.size() / 50;
  out.low_m = places[strays];
  out.high_m = places[places.size() - 1 - strays];
  out.top_m = heights[heights.size() - 1 - strays];
  out.offset_m = sum / out.patches;
  return out;
}

}  // namespace

Eigen::Vector2d DirectionOf(double yaw_rad, int direction) {
  const double angle = yaw_rad + 0.5 * kPi * direction;
  return {std::cos(angle), std::sin(angle)};
}

std::vector<WallPatch> FindWallPatches(const std::vector<Vector3>& points_P,
                                       const std::vector<Vector3>& eyes_P) {
  const auto at = [](const Vector3& p) -> Eigen::Vector3f { return p.cast<float>(); };
  const VoxelGrid grid(points_P, kCube_m, at);
  std::vector<Moments> own(static_cast<std::size_t>(grid.size()));
  std::vector<VoxelGrid::Cell> cells(own.size());
  for (std::size_t i = 0; i < points_P.size(); ++i) {
    const VoxelGrid::Cell cell = grid.CellOf(at(points_P[i]));
    const auto k = static_cast<std::size_t>(grid.NumberOf(cell));
    cells[k] = cell;
    own[k] += {1.0, points_P[i], eyes_P[i], points_P[i] * points_P[i].transpose()};
  }
  std::vector<WallPatch> out;
  for (std::size_t k = 0; k < own.size(); ++k) {
    Moments all;
    grid.ForNeighbours(cells[k], kReach, [&](int i) { all += own[static_cast<std::size_t>(i)]; });
    if (all.n < kFewest) continue;
    const Vector3 mean = all.sum / all.n;
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(all.squares / all.n -
                                                        mean * mean.transpose());
    const Vector3 n = solver.eigenvectors().col(0);
    if (solver.eigenvalues()(0) > kThick_m * kThick_m ||
        solver.eigenvalues()(1) < kWide_m * kWide_m || std::abs(n.z()) > kLean) {
      continue;
    }
    const Vector3 p = own[k].sum / own[k].n;
    // The patch's own points lie in its plane too, or they are only beside it.
    if (std::abs(n.dot(p - mean)) > 2 * kThick_m) continue;
    Eigen::Vector2d facing = n.head<2>().normalized();
    if (n.dot(own[k].eye / own[k].n - p) < 0) facing = -facing;
    out.push_back({p, facing});
  }
  return out;
}

WallLines FindWallLines(const std::vector<WallPatch>& patches, double lowest_top_m) {
  WallLines out;
  double sharpest = 0.0;
  for (double yaw_deg = 0.0; yaw_deg < 90.0; yaw_deg += kYawStep_deg) {
    const double sharpness = Sharpness(patches, Radians(yaw_deg));
    if (sharpness <= sharpest) continue;
    sharpest = sharpness;
    out.yaw_rad = Radians(yaw_deg);
  }
  int most = 0;
  for (int d = 0; d < 4; ++d) {
    Offsets offsets = OffsetsAlong(patches, DirectionOf(out.yaw_rad, d));
    for (int k = 0; k < kLinesPerDirection && !offsets.counts.empty(); ++k) {
      std::size_t best = 1;
      for (std::size_t i = 1; i + 1 < offsets.counts.size(); ++i) {
        if (offsets.Window(i) > offsets.Window(best)) best = i;
      }
      if (offsets.Window(best) < 0.5 * kFewestPatches) break;
      const double at_m = offsets.low_m + (static_cast<double>(best) + 0.5) * kOffsetBin_m;
      const WallLine line = LineAt(patches, out.yaw_rad, d, at_m);
      if (line.patches >= kFewestPatches && line.high_m - line.low_m > kShortest_m &&
          line.top_m > lowest_top_m) {
        out.lines.push_back(line);
        most = std::max(most, line.patches);
      }
      const auto apart = static_cast<std::size_t>(kApart_m / kOffsetBin_m);
      for (std::size_t i = best > apart ? best - apart : 0;
           i < std::min(offsets.counts.size(), best + apart + 1); ++i) {
        offsets.counts[i] = 0.0;
      }
    }
  }
  std::erase_if(out.lines, [most](const WallLine& line) { return line.patches < kWeakest * most; });
  return out;
}

}  // namespace tubetwin

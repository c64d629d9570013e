// 1. Planes with most points, by random triples of a thinned cloud; up is where more points are.
// 2. On each plane the upright surfaces between floor and rim, seen from above, are lines: for
// every
//    yaw a histogram of their offsets, and the pair of offsets that is the bin's size apart.
// 3. The best of all planes is refined by least squares on the points near the four sides.
#include "perception/view/floor_pose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "models/base/error.h"
#include "models/base/random.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr std::size_t kMaxFitPoints = 60000;
constexpr int kTriples = 400;
constexpr int kPlanes = 3;  ///< Floor, a table around the bin, one more.
constexpr double kPlane_m = 0.003;
/// What counts as wall: from this share of its height, over most tubes, to here under the rim.
constexpr double kLowest = 0.4, kBelowRim_m = 0.004;
constexpr double kBin_m = 0.002;  ///< Of the histogram of offsets.
constexpr double kYawStep_deg = 0.5;
/// A side is seen when it has this share of the points that all sides have, over this length and up
/// to this share of the wall's height.
constexpr double kSeenSide = 0.05, kSeenLength_m = 0.08, kSeenHeight = 0.7;
/// Least share of what counts as wall that stands on the four sides; the rest are tubes.
constexpr double kOnSides = 0.15;
/// Floor is seen in squares of this side, in at least this share of the bin.
constexpr double kSquare_m = 0.02, kSeenFloor = 0.05;
constexpr int kFewestWallPoints = 100;
/// Sides are this straight; the rest are tubes and edges.
constexpr double kSide_m = 0.004;

std::vector<Vector3> Thinned(const OrganizedCloud& cloud) {
  std::vector<Vector3> out;
  for (const auto& p : cloud.p_SP) {
    if (IsValid(p)) out.push_back(p.cast<double>());
  }
  if (out.size() <= kMaxFitPoints) return out;
  // By golden-ratio steps, so that no raster's columns are preferred.
  std::vector<Vector3> thin(kMaxFitPoints);
  for (std::size_t i = 0; i < kMaxFitPoints; ++i) {
    const double share = std::fmod(0.6180339887498949 * static_cast<double>(i), 1.0);
    thin[i] = out[static_cast<std::size_t>(share * static_cast<double>(out.size()))];
  }
  return thin;
}

struct Plane {
  Vector3 normal = Vector3::UnitZ();
  double offset = 0.0;  ///< normal . p = offset on the plane.
  double Height(const Vector3& p) const { return normal.dot(p) - offset; }
};

/// Least squares through the points near `plane`.
Plane Polished(const Plane& plane, const std::vector<Vector3>& points) {
  Vector3 mean = Vector3::Zero();
  Matrix3 squares = Matrix3::Zero();
  double n = 0;
  for (const Vector3& p : points) {
    if (std::abs(plane.Height(p)) > kPlane_m) continue;
    mean += p;
    squares += p * p.transpose();
    ++n;
  }
  if (n < 3) return plane;
  mean /= n;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(squares / n - mean * mean.transpose());
  Plane out;
  out.normal = solver.eigenvectors().col(0);
  if (out.normal.dot(plane.normal) < 0) out.normal = -out.normal;
  out.offset = out.normal.dot(mean);
  return out;
}

std::optional<Plane> BestPlane(const std::vector<Vector3>& points, RandomStream& stream) {
  const auto n = static_cast<std::uint32_t>(points.size());
  std::optional<Plane> best;
  std::size_t max_count = 0;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 4000);
  for (int k = 0; k < kTriples && n >= 3; ++k) {
    const Vector3 &a = points[stream.Index(n)], &b = points[stream.Index(n)],
                  &c = points[stream.Index(n)];
    const Vector3 normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-6) continue;
    const Plane plane{normal.normalized(), normal.normalized().dot(a)};
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      count += std::abs(plane.Height(points[i])) < kPlane_m;
    }
    if (count > max_count) {
      max_count = count;
      best = plane;
    }
  }
  if (!best) return best;
  return Polished(Polished(*best, points), points);
}

/// Position of the rectangle on its plane: yaw of the long side and centre, in plane coordinates.
struct Rectangle {
  double yaw = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double points = -1.0;  ///< On the sides.
};

/// Histogram of offsets with the window of three bins summed.
class Offsets {
 public:
  Offsets(const std::vector<Vector3>& points, const Eigen::Vector2d& direction) {
    low_ = 1e9;
    double high = -1e9;
    for (const auto& p : points) {
      low_ = std::min(low_, p.head<2>().dot(direction));
      high = std::max(high, p.head<2>().dot(direction));
    }
    counts_.assign(static_cast<std::size_t>((high - low_) / kBin_m) + 3, 0.0);
    for (const auto& p : points) {
      const auto i = static_cast<std::size_t>((p.head<2>().dot(direction) - low_) / kBin_m) + 1;
      counts_[i] += 1.0;
    }
  }

  /// The middle of two offsets `size_m` apart with most points on them; at least one is inside.
  std::pair<double, double> BestPair(double size_m) const {
    const auto apart = static_cast<int>(std::lround(size_m / kBin_m));
    const int n = static_cast<int>(counts_.size());
    double max_sum = -1.0;
    int at = 0;
    for (int i = -apart; i < n; ++i) {
      const double sum = Near(i) + Near(i + apart);
      if (sum > max_sum) {
        max_sum = sum;
        at = i;
      }
    }
    return {low_ + (at - 0.5) * kBin_m + 0.5 * size_m, max_sum};
  }

 private:
  double Near(int i) const {
    double sum = 0.0;
    for (int k = std::max(0, i - 1); k <= std::min(static_cast<int>(counts_.size()) - 1, i + 1);
         ++k) {
      sum += counts_[static_cast<std::size_t>(k)];
    }
    return sum;
  }
  double low_ = 0.0;
  std::vector<double> counts_;
};

Rectangle FindRectangle(const std::vector<Vector3>& walls, const Bin& bin) {
  Rectangle best;
  for (double yaw_deg = 0.0; yaw_deg < 180.0; yaw_deg += kYawStep_deg) {
    const double yaw = Radians(yaw_deg);
    const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw)), across(-along.y(), along.x());
    const auto [x, x_points] = Offsets(walls, along).BestPair(bin.size_m[0]);
    const auto [y, y_points] = Offsets(walls, across).BestPair(bin.size_m[1]);
    // Both pairs must be there: the product prefers two pairs to one strong line.
    const double points = std::sqrt(x_points * y_points);
    if (points > best.points) best = {yaw, x * along + y * across, points};
  }
  return best;
}

/// How far a point is outside the nearest side, and which side that is (0: -x, 1: +x, 2: -y, 3: +y
/// of the rectangle).
struct SideOffset {
  int side = 0;
  double out_m = 0.0;
};
SideOffset NearestSide(const Eigen::Vector2d& q, const Bin& bin) {
  const double out[4] = {-q.x() - bin.half_x_m(), q.x() - bin.half_x_m(), -q.y() - bin.half_y_m(),
                         q.y() - bin.half_y_m()};
  SideOffset best{0, 1e9};
  for (int k = 0; k < 4; ++k) {
    if (std::abs(out[k]) < std::abs(best.out_m)) best = {k, out[k]};
  }
  return best;
}

/// What is seen of the four sides.
struct SeenSides {
  int points[4] = {};
  double low_m[4], high_m[4];  ///< Along the side.
  double top_m[4] = {};        ///< Over the floor.
  SeenSides() {
    std::fill(std::begin(low_m), std::end(low_m), 1e9);
    std::fill(std::begin(high_m), std::end(high_m), -1e9);
  }
  void Add(int side, double along_m, double height_m) {
    top_m[side] = std::max(top_m[side], height_m);
    ++points[side];
    low_m[side] = std::min(low_m[side], along_m);
    high_m[side] = std::max(high_m[side], along_m);
  }
  int All() const { return points[0] + points[1] + points[2] + points[3]; }
  bool Has(int side, const Bin& bin) const {
    return points[side] > std::max(kSeenSide * All(), 20.0) &&
           high_m[side] - low_m[side] > kSeenLength_m && top_m[side] > kSeenHeight * bin.wall_m();
  }
};

/// Gauss-Newton on yaw and centre.
Rectangle Refined(Rectangle r, const std::vector<Vector3>& walls, const Bin& bin,
                  SeenSides& sides) {
  for (int round = 0; round < 12; ++round) {
    // The first rounds catch what half a yaw step is off at the far corners.
    const double reach = round < 4 ? 2.5 * kSide_m : kSide_m;
    Matrix3 A = 1e-9 * Matrix3::Identity();
    Vector3 b = Vector3::Zero();
    sides = SeenSides();
    const double c = std::cos(r.yaw), s = std::sin(r.yaw);
    for (const Vector3& p : walls) {
      const Eigen::Vector2d d = p.head<2>() - r.centre;
      const Eigen::Vector2d q(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
      const SideOffset near = NearestSide(q, bin);
      if (std::abs(near.out_m) > reach) continue;
      sides.Add(near.side, near.side < 2 ? q.y() : q.x(), p.z());
      const double sign = near.side % 2 == 0 ? -1.0 : 1.0;
      // Derivative of the offset by centre and yaw.
      const Vector3 j = near.side < 2 ? Vector3(-sign * c, -sign * s, sign * q.y())
                                      : Vector3(sign * s, -sign * c, -sign * q.x());
      A += j * j.transpose();
      b -= j * near.out_m;
    }
    const Vector3 step = A.ldlt().solve(b);
    r.centre += step.head<2>();
    r.yaw += step.z();
  }
  return r;
}

/// Squares of the floor inside the walls that are seen, less those outside when `both`.
double SeenFloor(const Rectangle& r, const std::vector<Eigen::Vector2d>& floor, const Bin& bin,
                 bool both) {
  const double c = std::cos(r.yaw), s = std::sin(r.yaw);
  std::vector<std::pair<int, int>> inside, outside;
  for (const Eigen::Vector2d& p : floor) {
    const Eigen::Vector2d d = p - r.centre;
    const Eigen::Vector2d q(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
    const double out_m =
        std::max(std::abs(q.x()) - bin.half_x_m(), std::abs(q.y()) - bin.half_y_m());
    if (std::abs(out_m) < 2 * kSide_m) continue;  // The rim's edge is neither.
    (out_m < 0 ? inside : outside)
        .emplace_back(static_cast<int>(std::floor(q.x() / kSquare_m)),
                      static_cast<int>(std::floor(q.y() / kSquare_m)));
  }
  const auto count = [](std::vector<std::pair<int, int>>& squares) {
    std::sort(squares.begin(), squares.end());
    return static_cast<double>(std::unique(squares.begin(), squares.end()) - squares.begin());
  };
  return count(inside) - (both ? count(outside) : 0.0);
}

/// A wall that is seen without its opposite may be either of the two: the floor says which.
Rectangle OnTheFloorsSide(const Rectangle& r, const SeenSides& sides,
                          const std::vector<Eigen::Vector2d>& floor, const Bin& bin) {
  const Eigen::Vector2d along(std::cos(r.yaw), std::sin(r.yaw)), across(-along.y(), along.x());
  // The rectangle moves towards the side that is not seen's opposite.
  const auto move = [&](int low) {
    const bool first = sides.Has(low, bin), second = sides.Has(low + 1, bin);
    return first == second ? 0 : (first ? -1 : 1);
  };
  Rectangle best = r;
  double max_seen = SeenFloor(r, floor, bin, true);
  for (const int i : {0, move(0)}) {
    for (const int j : {0, move(2)}) {
      Rectangle moved = r;
      moved.centre += i * bin.size_m[0] * along + j * bin.size_m[1] * across;
      const double seen = SeenFloor(moved, floor, bin, true);
      if (seen > max_seen) {
        max_seen = seen;
        best = moved;
      }
    }
  }
  return best;
}

struct Candidate {
  RigidTransform X_NS = RigidTransform::Identity();
  double seen_floor = 0.0;  ///< Squares.
};

/// Axes of a plane with z along its normal and x as far along S's x as it can be.
RigidTransform PlaneFrame(const Plane& plane) {
  Vector3 x = Vector3::UnitX() - plane.normal.x() * plane.normal;
  if (x.norm() < 0.1) x = Vector3::UnitY() - plane.normal.y() * plane.normal;
  Matrix3 R_SP;
  R_SP.col(0) = x.normalized();
  R_SP.col(1) = plane.normal.cross(R_SP.col(0));
  R_SP.col(2) = plane.normal;
  return MakeTransform(R_SP, plane.offset * plane.normal);
}

/// The bin on `plane`, when upright surfaces of it are seen on two neighbouring sides.
Candidate BinOnPlane(const Plane& plane, const std::vector<Vector3>& points, const Bin& bin) {
  const RigidTransform X_PS = PlaneFrame(plane).inverse();
  std::vector<Vector3> walls;
  std::vector<Eigen::Vector2d> floor;
  for (const Vector3& p : points) {
    const Vector3 q = X_PS * p;
    if (std::abs(q.z()) < kPlane_m) floor.push_back(q.head<2>());
    if (q.z() > kLowest * bin.wall_m() && q.z() < bin.wall_m() - kBelowRim_m) {
      walls.push_back(q);
    }
  }
  if (static_cast<int>(walls.size()) < kFewestWallPoints) return {};
  SeenSides sides;
  const Rectangle first = Refined(FindRectangle(walls, bin), walls, bin, sides);
  const Rectangle r = Refined(OnTheFloorsSide(first, sides, floor, bin), walls, bin, sides);
  const auto has = [&](int side) { return sides.Has(side, bin); };
  if (!(has(0) || has(1)) || !(has(2) || has(3))) return {};
  if (sides.All() < kOnSides * static_cast<double>(walls.size())) return {};
  const RigidTransform X_PN = MakeTransform(RotZ(r.yaw), Vector3(r.centre.x(), r.centre.y(), 0));
  Candidate out;
  out.X_NS = X_PN.inverse() * X_PS;
  const Vector3 x_N = out.X_NS.linear().col(0);
  const double towards = std::abs(x_N.x()) > 1e-3 ? x_N.x() : x_N.y();
  if (towards < 0) out.X_NS = MakeTransform(RotZ(kPi), Vector3::Zero()) * out.X_NS;
  out.seen_floor = SeenFloor(r, floor, bin, false);
  return out;
}

}  // namespace

RigidTransform FitFloorPose(const OrganizedCloud& cloud, const Bin& bin) {
  const std::vector<Vector3> points = Thinned(cloud);
  std::vector<Vector3> left = points;
  RandomStream stream(1, 0, "floor pose");
  Candidate best;
  for (int k = 0; k < kPlanes; ++k) {
    const std::optional<Plane> plane = BestPlane(left, stream);
    if (!plane) break;
    // Which side is up the walls say.
    for (const Plane& side : {*plane, Plane{-plane->normal, -plane->offset}}) {
      const Candidate candidate = BinOnPlane(side, points, bin);
      if (candidate.seen_floor > best.seen_floor) best = candidate;
    }
    std::erase_if(left,
                  [&](const Vector3& p) { return std::abs(plane->Height(p)) < 2 * kPlane_m; });
    if (left.size() < points.size() / 50) break;
  }
  const double squares = bin.size_m[0] * bin.size_m[1] / (kSquare_m * kSquare_m);
  if (best.seen_floor < kSeenFloor * squares) {
    throw Error(ErrorKind::kBadData, "no floor with two neighbouring walls of a bin of " +
                                         Number(bin.size_m[0]) + " x " + Number(bin.size_m[1]) +
                                         " x " + Number(bin.size_m[2]) +
                                         " m is seen, so its pose cannot be fitted");
  }
  return best.X_NS;
}

}  // namespace tubetwin

#include "perception/view/bin_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "perception/view/bin_evidence.h"

namespace tubetwin {
namespace {

/// Lower points are floor, higher ones and such far away are no bin's.
constexpr double kLow_m = 0.012, kHigh_m = 1.2, kFar_m = 3.0;
/// A wall's patches reach at least this high, or half of the bin's height.
constexpr double kLowestTop_m = 0.03;
/// Patches this close to a side, first and then, are the side's.
constexpr double kCatch_m = 0.010, kOfSide_m = 0.005;
/// A side is seen with this share of the patches of all, over this length and share of the height.
constexpr double kSeenShare = 0.05, kSeenLength_m = 0.06, kSeenHeight = 0.4, kSeenHeight_m = 0.04;
constexpr int kSeenPatches = 15;
/// A side's patches lie this close to it on average, and reach this little higher.
constexpr double kMeanOff_m = 0.0025, kHigher_m = 0.008, kHigherShare = 0.2;
/// A side that is seen up to here before its corners is seen whole.
constexpr double kCorner_m = 0.02;
/// A corner's rim: how wide a piece of it, where beside the corner, at which height, and how many
/// points of those there.
constexpr double kRim_m = 0.012, kBesideLow_m = 0.015, kBesideHigh_m = 0.08, kRimHeight_m = 0.008;
constexpr int kFewestRim = 8;
constexpr double kRimShare = 0.6;
/// A wall that goes on beyond its corner by this much is no side's.
constexpr double kLonger_m = 0.012;
/// Another wall this long does not stand inside the bin, this far from its side.
constexpr double kInsideWall_m = 0.12, kWallInside_m = 0.004;
/// Floor is seen in squares of this side, in at least this share of the bin.
constexpr double kFloorSquare_m = 0.02, kSeenFloorShare = 0.05;
/// Share of the points below the floor that mirror images are, and length of the walls that stray
/// points are seen through: so many in pieces of this length.
constexpr double kBelowFloor = 0.01, kSeenThrough_m = 0.06, kPiece_m = 0.02;
constexpr int kFewestThrough = 4;
constexpr std::size_t kAsked = 60000;  ///< Points that are asked.

/// The rectangle on its plane: yaw of the long side and centre.
struct Rectangle {
  double yaw = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  RigidTransform X_NP() const {
    return MakeTransform(RotZ(yaw), Vector3(centre.x(), centre.y(), 0)).inverse();
  }
};

/// How far a place in N is outside of side 0 (-x), 1 (+x), 2 (-y), 3 (+y).
double Out(const Vector3& p_N, std::size_t side, const Bin& bin) {
  const int axis = side < 2 ? 0 : 1;
  const double sign = side % 2 == 0 ? -1.0 : 1.0;
  return sign * p_N[axis] - (axis == 0 ? bin.half_x_m() : bin.half_y_m());
}

/// What is seen of one side.
struct SeenSide {
  std::vector<double> along_m;
  double top_m = 0.0, sum_out_m = 0.0;
  int higher = 0;
  void Add(double along, double height, double out, const Bin& bin) {
    along_m.push_back(along);
    top_m = std::max(top_m, height);
    sum_out_m += out;
    higher += height > bin.wall_m() + kHigher_m;
  }
  int patches() const { return static_cast<int>(along_m.size()); }
  double mean_out_m() const { return along_m.empty() ? 0.0 : sum_out_m / patches(); }
  bool Has(int all, const Bin& bin) const {
    if (patches() < std::max(kSeenShare * all, 1.0 * kSeenPatches)) return false;
    const auto [low, high] = std::minmax_element(along_m.begin(), along_m.end());
    return *high - *low > kSeenLength_m &&
           top_m > std::min(kSeenHeight * bin.wall_m(), kSeenHeight_m);
  }
};
using SeenSides = std::array<SeenSide, 4>;

int AllPatches(const SeenSides& sides) {
  int all = 0;
  for (const SeenSide& side : sides) all += side.patches();
  return all;
}

/// Gauss-Newton on yaw and centre.
Rectangle RefinedRectangle(Rectangle r, const std::vector<WallPatch>& patches, const Bin& bin,
                           SeenSides& sides) {
  for (int round = 0; round < 10; ++round) {
    const double reach_m = round < 4 ? kCatch_m : kOfSide_m;
    Matrix3 A = 1e-9 * Matrix3::Identity();
    Vector3 b = Vector3::Zero();
    sides = SeenSides();
    const RigidTransform X_NP = r.X_NP();
    const double c = std::cos(r.yaw), s = std::sin(r.yaw);
    for (const WallPatch& patch : patches) {
      const Vector3 q = X_NP * patch.p_P;
      const std::size_t side = SideFacing(X_NP.linear().topLeftCorner<2, 2>() * patch.facing);
      if (side > 3) continue;
      const double out = Out(q, side, bin), along = side < 2 ? q.y() : q.x();
      const double half = side < 2 ? bin.half_y_m() : bin.half_x_m();
      if (std::abs(out) > reach_m || std::abs(along) > half + reach_m) continue;
      sides[side].Add(along, q.z(), out, bin);
      const double sign = side % 2 == 0 ? -1.0 : 1.0;
      // Derivative of the offset by centre and yaw.
      const Vector3 j = side < 2 ? Vector3(-sign * c, -sign * s, sign * q.y())
                                 : Vector3(sign * s, -sign * c, -sign * q.x());
      A += j * j.transpose();
      b -= j * out;
    }
    const Vector3 step = A.ldlt().solve(b);
    r.centre += step.head<2>();
    r.yaw += step.z();
  }
  return r;
}

/// The floor's plane again, from what lies between the walls only.
RigidTransform LevelledOnFloor(const RigidTransform& X_NP, const BinView& view, const Bin& bin) {
  std::vector<Vector3> inside_N;
  for (const Vector3& p_P : view.p_P) {
    const Vector3 q = X_NP * p_P;
    if (std::abs(q.z()) > 2 * kOnPlane_m) continue;
    if (std::abs(q.x()) < bin.half_x_m() - kOfSide_m &&
        std::abs(q.y()) < bin.half_y_m() - kOfSide_m) {
      inside_N.push_back(q);
    }
  }
  if (inside_N.size() < 50) return X_NP;
  const FloorPlane floor = Polished(Polished({}, inside_N), inside_N);
  const Matrix3 R =
      Eigen::Quaterniond::FromTwoVectors(floor.normal, Vector3::UnitZ()).toRotationMatrix();
  return MakeTransform(R, Vector3(0, 0, -floor.offset_m)) * X_NP;
}

double SeenFloorOf(const RigidTransform& X_NP, const BinView& view, const Bin& bin) {
  std::vector<std::pair<int, int>> squares;
  for (const Vector3& p_P : view.p_P) {
    const Vector3 q = X_NP * p_P;
    if (std::abs(q.z()) > kOnPlane_m || std::abs(q.x()) > bin.half_x_m() - 2 * kOfSide_m ||
        std::abs(q.y()) > bin.half_y_m() - 2 * kOfSide_m) {
      continue;
    }
    squares.emplace_back(static_cast<int>(std::floor(q.x() / kFloorSquare_m)),
                         static_cast<int>(std::floor(q.y() / kFloorSquare_m)));
  }
  std::sort(squares.begin(), squares.end());
  return kFloorSquare_m * kFloorSquare_m *
         static_cast<double>(std::unique(squares.begin(), squares.end()) - squares.begin());
}

void JudgeSights(const BinView& view, const Bin& bin, BinFit& fit) {
  std::map<std::pair<int, int>, int> crossed;  // Side, piece of it; points.
  double below = 0.0, asked = 0.0;
  const std::size_t stride = 1 + view.p_P.size() / kAsked;
  for (std::size_t i = 0; i < view.p_P.size(); i += stride) {
    ++asked;
    if (view.eye_known[i] == 0) continue;
    const Vector3 p_N = fit.X_NP * view.p_P[i];
    below += IsBelowFloor(p_N, bin);
    const auto crossing = CrossedWall(fit.X_NP * view.eye_P[i], p_N, bin);
    if (!crossing) continue;
    ++crossed[{crossing->side, static_cast<int>(std::floor(crossing->along_m / kPiece_m))}];
  }
  fit.below_floor = below / asked;
  for (const auto& [piece, points] : crossed) {
    if (points >= kFewestThrough) fit.seen_through_m += kPiece_m;
  }
}

/// A wall between the sides of the bin, or on one of them and longer; empty: there is none.
std::string OddLines(const RigidTransform& X_NP, const BinView& view, const Bin& bin) {
  char text[120] = "";
  const double yaw = view.walls.lines.yaw_rad;
  for (const WallLine& line : view.walls.lines.lines) {
    const Eigen::Vector2d across = DirectionOf(yaw, line.direction);
    const Eigen::Vector2d along = DirectionOf(yaw, line.direction + 1);
    const std::size_t side = SideFacing(X_NP.linear().topLeftCorner<2, 2>() * across);
    if (side > 3) continue;
    const auto place = [&](double at_m) -> Vector3 {
      const Eigen::Vector2d p = line.offset_m * across + at_m * along;
      return X_NP * Vector3(p.x(), p.y(), 0.5 * line.top_m);
    };
    const Vector3 low = place(line.low_m), high = place(line.high_m), middle = 0.5 * (low + high);
    const double out_m = Out(middle, side, bin);
    const std::size_t first = side < 2 ? 2 : 0;  // The sides that it runs to.
    const double longer_m = std::max({Out(low, first, bin), Out(high, first, bin),
                                      Out(low, first + 1, bin), Out(high, first + 1, bin)});
    if (std::abs(out_m) < kOfSide_m && longer_m > kLonger_m) {
      std::snprintf(text, sizeof text, "a wall is seen over %.3f m, longer than its side",
                    line.high_m - line.low_m);
      break;
    }
    double max_out_m = out_m;
    for (std::size_t k = 0; k < 4; ++k) max_out_m = std::max(max_out_m, Out(middle, k, bin));
    if (max_out_m > -kWallInside_m || line.high_m - line.low_m < kInsideWall_m ||
        line.top_m < 0.5 * bin.wall_m()) {
      continue;
    }
    std::snprintf(text, sizeof text,
                  "a wall is seen inside the bin, %.3f m from where its side would be", -out_m);
    break;
  }
  return text;
}

std::string OddSides(const SeenSides& sides, const Bin& bin) {
  for (const SeenSide& side : sides) {
    if (!side.Has(AllPatches(sides), bin)) continue;
    char text[120];
    if (std::abs(side.mean_out_m()) > kMeanOff_m) {
      std::snprintf(text, sizeof text, "walls are seen %.1f mm from the sides of such a bin",
                    1e3 * std::abs(side.mean_out_m()));
      return text;
    }
    if (side.higher > kHigherShare * side.patches()) {
      std::snprintf(text, sizeof text, "a wall is seen %.2f m high", side.top_m);
      return text;
    }
  }
  return {};
}

/// Whether the corner at the low (0) or high (1) end of a side is seen: by the next wall's face, or
/// by its rim beside the corner.
bool SeesCorner(const BinFit& fit, std::size_t side, std::size_t end, const BinView& view,
                const Bin& bin) {
  const std::size_t next = (side < 2 ? 2 : 0) + end;
  if (fit.seen_walls[next]) return true;
  int rim = 0, all = 0;
  for (const Vector3& p_P : view.p_P) {
    const Vector3 q = fit.X_NP * p_P;
    const double beyond = Out(q, next, bin), inward = -Out(q, side, bin);
    if (beyond < 0.0 || beyond > kRim_m || inward < kBesideLow_m || inward > kBesideHigh_m)
      continue;
    ++all;
    rim += std::abs(q.z() - bin.wall_m()) < kRimHeight_m;
  }
  return rim >= kFewestRim && rim > kRimShare * all;
}

/// Whether a side is seen from corner to corner, or two that face each other.
bool ShowsSize(const SeenSides& sides, const BinFit& fit, const BinView& view, const Bin& bin) {
  const auto& seen = fit.seen_walls;
  if ((seen[0] && seen[1]) || (seen[2] && seen[3])) return true;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!seen[k]) continue;
    const auto [low, high] = std::minmax_element(sides[k].along_m.begin(), sides[k].along_m.end());
    const double half_m = k < 2 ? bin.half_y_m() : bin.half_x_m();
    if (*low<kCorner_m - half_m&& * high> half_m - kCorner_m && SeesCorner(fit, k, 0, view, bin) &&
        SeesCorner(fit, k, 1, view, bin)) {
      return true;
    }
  }
  return false;
}

BinFit FitOf(const Rectangle& first, const BinView& view, const Bin& bin) {
  SeenSides sides;
  const Rectangle r = RefinedRectangle(first, view.walls.patches, bin, sides);
  BinFit out;
  out.X_NP = LevelledOnFloor(r.X_NP(), view, bin);
  for (std::size_t k = 0; k < 4; ++k) {
    out.seen_walls[k] = sides[k].Has(AllPatches(sides), bin);
  }
  out.shows_size = ShowsSize(sides, out, view, bin);
  out.seen_floor = SeenFloorOf(out.X_NP, view, bin);
  JudgeSights(view, bin, out);
  out.odd = OddSides(sides, bin);
  if (out.odd.empty()) out.odd = OddLines(out.X_NP, view, bin);
  return out;
}

/// Centres along yaw (axis 0) or square to it (1) that lay a side of a rectangle on a line.
std::vector<double> Centres(const WallLines& walls, int axis, double size_m) {
  std::vector<double> out;
  for (const WallLine& line : walls.lines) {
    if (line.direction % 2 != axis) continue;
    const double centre = (line.direction < 2 ? 1.0 : -1.0) * (line.offset_m + 0.5 * size_m);
    const bool known = std::any_of(out.begin(), out.end(), [centre](double other) {
      return std::abs(centre - other) < 0.5 * kOfSide_m;
    });
    if (!known) out.push_back(centre);
  }
  return out;
}

}  // namespace

std::size_t SideFacing(const Eigen::Vector2d& facing_N) {
  constexpr double kCosineInward = 0.95;
  if (facing_N.x() > kCosineInward) return 0;
  if (facing_N.x() < -kCosineInward) return 1;
  if (facing_N.y() > kCosineInward) return 2;
  return facing_N.y() < -kCosineInward ? 3 : 4;
}

BinView::Walls WallsOf(const BinView& view, const Bin& bin) {
  std::vector<Vector3> points, eyes;
  const Vector3 middle = view.p_P.empty() ? Vector3(0, 0, 0) : view.p_P[view.p_P.size() / 2];
  for (std::size_t i = 0; i < view.p_P.size(); ++i) {
    const Vector3& p = view.p_P[i];
    if (p.z() < kLow_m || p.z() > kHigh_m || (p - middle).head<2>().norm() > kFar_m) continue;
    points.push_back(p);
    eyes.push_back(view.eye_P[i]);
  }
  BinView::Walls out;
  out.patches = FindWallPatches(points, eyes);
  out.lines = FindWallLines(out.patches, std::min(kLowestTop_m, 0.5 * bin.wall_m()));
  return out;
}

std::string FewWalls(const BinView::Walls& walls) {
  int lines[2] = {};
  for (const WallLine& line : walls.lines.lines) ++lines[line.direction % 2];
  if (lines[0] > 0 && lines[1] > 0) return {};
  if (lines[0] + lines[1] == 0) return kNoWall;
  return std::string(lines[0] + lines[1] == 1 ? "only one wall is seen"
                                              : "only walls parallel to each other are seen") +
         ", so where the bin lies along it stays open: a view of neighbouring walls is needed";
}

std::vector<BinFit> FitBin(const BinView& view, const Bin& bin) {
  std::vector<BinFit> out;
  const WallLines& walls = view.walls.lines;
  const Eigen::Vector2d u = DirectionOf(walls.yaw_rad, 0), v = DirectionOf(walls.yaw_rad, 1);
  for (int turned = 0; turned < 2; ++turned) {
    const double size_u = bin.size_m[turned == 0 ? 0 : 1], size_v = bin.size_m[turned == 0 ? 1 : 0];
    for (const double at_u : Centres(walls, 0, size_u)) {
      for (const double at_v : Centres(walls, 1, size_v)) {
        out.push_back(FitOf({walls.yaw_rad + 0.5 * kPi * turned, at_u * u + at_v * v}, view, bin));
      }
    }
  }
  return out;
}

double LeastSeenFloor(const Bin& bin) { return kSeenFloorShare * bin.size_m[0] * bin.size_m[1]; }

bool IsSound(const BinFit& fit, const Bin& bin) {
  const auto& w = fit.seen_walls;
  return (w[0] || w[1]) && (w[2] || w[3]) && fit.odd.empty() &&
         fit.seen_floor >= LeastSeenFloor(bin) && fit.below_floor <= kBelowFloor &&
         fit.seen_through_m <= kSeenThrough_m;
}

std::array<bool, 4> TurnedWalls(const std::array<bool, 4>& walls, const RigidTransform& turn) {
  std::array<bool, 4> out{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d inward(k < 2 ? (k == 0 ? 1.0 : -1.0) : 0.0,
                                 k < 2 ? 0.0 : (k == 2 ? 1.0 : -1.0));
    const std::size_t side = SideFacing(turn.linear().topLeftCorner<2, 2>() * inward);
    if (side < 4) out[side] = walls[k];
  }
  return out;
}

}  // namespace tubetwin

#include "perception/part_import/wall_sections.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "perception/part_import/tube_end.h"

namespace tubetwin {
namespace {

constexpr double kAway = 0.7;   ///< Cosine between a wall's normal and the way out to it.
constexpr double kAlong = 0.5;  ///< Largest cosine of a wall's normal with the axis.
constexpr double kStep = 0.25, kMaxAxisNodes = 400.0;  ///< Between sections: radii, and how many.
constexpr double kReach = 1.6;                         ///< Wall lies within so many radii.
constexpr double kFlangeReach = 3.0;                   ///< At the ends.
/// A section with less wall than this does not place a node; one with less than half ends the tube.
constexpr double kSeen = 0.6, kEnd = 0.5;
/// Larger moves than this, in radii, are another thing's wall.
constexpr double kMove = 0.6, kDrift = 0.3;
constexpr double kThinnest = 0.5;  ///< Spigots go down to this share of the radius.
/// Ends of the rough axis may be bent: so much of them is found anew.
constexpr double kCutBack = 1.0, kLongestSearch = 0.5;
/// Walls of less slope are the tube's, not a dome's.
constexpr double kUpright = 0.12;

/// Circle through weighted points of a plane, by the linear equations of x^2 + y^2 + a x + b y + c.
class CircleSums {
 public:
  void Add(double x, double y, double weight) {
    const Vector3 row(x, y, 1.0);
    squares_ += weight * row * row.transpose();
    right_ -= weight * (x * x + y * y) * row;
  }
  /// Centre and radius; radius 0 when the points leave it open.
  Vector3 Solve() const {
    const Eigen::LDLT<Matrix3> solver(squares_);
    const Vector3 abc = solver.solve(right_);
    const double squared = 0.25 * (abc[0] * abc[0] + abc[1] * abc[1]) - abc[2];
    if (!abc.allFinite() || !(squared > 0.0)) return Vector3::Zero();
    return {-0.5 * abc[0], -0.5 * abc[1], std::sqrt(squared)};
  }

 private:
  Matrix3 squares_ = Matrix3::Zero();
  Vector3 right_ = Vector3::Zero();
};

/// Where the plane at `p` across `t` cuts a face; false when it does not.
bool CutFace(const Vector3 corner[3], const Vector3& p, const Vector3& t, Vector3 cut[2]) {
  double height[3];
  for (int k = 0; k < 3; ++k) height[k] = (corner[k] - p).dot(t);
  int found = 0;
  for (int k = 0; k < 3 && found < 2; ++k) {
    const int n = (k + 1) % 3;
    if ((height[k] < 0.0) == (height[n] < 0.0)) continue;
    cut[found++] = corner[k] + height[k] / (height[k] - height[n]) * (corner[n] - corner[k]);
  }
  return found == 2;
}

/// One round: nodes every step go into their sections' centres; those without are left out where
/// others carry the line on.
Polyline Centred(const WallCutter& cutter, const Polyline& rough, double radius_m,
                 Parallelism parallelism, std::vector<WallSection>* sections) {
  const double step_m = std::max(kStep * radius_m, Length(rough) / kMaxAxisNodes);
  const Polyline nodes = Resample(rough, step_m);
  const std::vector<double> at = ArcLengths(nodes);
  std::vector<std::optional<WallSection>> found(nodes.size());
  ParallelFor(static_cast<int>(nodes.size()), parallelism, [&](int i, int) {
    const auto k = static_cast<std::size_t>(i);
    const Vector3 t = TangentAt(nodes, at[k], radius_m);
    const auto section = cutter.Cut(nodes[k], t, kReach * radius_m);
    if (!section || section->seen < kSeen) return;
    if ((section->centre - nodes[k]).norm() < kMove * radius_m) found[k] = section;
  });
  Polyline out;
  if (sections != nullptr) sections->clear();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!found[k]) continue;
    // A line that folds back goes forward again.
    const Vector3 t = TangentAt(nodes, at[k], radius_m);
    if (!out.empty() && (found[k]->centre - out.back()).dot(t) < 0.2 * step_m) continue;
    out.push_back(found[k]->centre);
    if (sections != nullptr) sections->push_back(*found[k]);
  }
  return out;
}

/// The section at `next` beyond an end, of a wall that may be a flange's.
std::optional<WallSection> SectionBeyond(const WallCutter& cutter, const Vector3& next,
                                         const Vector3& t, double radius_m) {
  for (const double reach : {kReach, kFlangeReach}) {
    auto section = cutter.Cut(next, t, reach * radius_m);
    if (!section || section->seen < kEnd || section->radius_m < kThinnest * radius_m) continue;
    // Where an askew end leaves wall on one side only, the circle is less certain than the line.
    const double drift = (section->centre - next).norm();
    if (section->seen < kSeen || drift <= kDrift * radius_m) return section;
  }
  return std::nullopt;
}

/// Goes on beyond an end, section by section, as long as there is wall; over the steep flanks of
/// beads and shoulders, where none is cut, to the wall behind them.
void Prolong(const WallCutter& cutter, double radius_m, bool first, Polyline& line) {
  constexpr int kSteep = 4;  // Steps of a flank at most.
  const double step_m = kStep * radius_m;
  const int steps = static_cast<int>(kLongestSearch * Length(line) / step_m) + 8;
  if (first) std::reverse(line.begin(), line.end());
  int without = 0;
  for (int i = 0; i < steps && without < kSteep; ++i) {
    const Vector3 t = OutwardAt(line, false, radius_m);
    const Vector3 next = line.back() + (without + 1) * step_m * t;
    const auto section = SectionBeyond(cutter, next, t, radius_m);
    without = section ? 0 : without + 1;
    if (section) line.push_back(section->seen >= kSeen ? section->centre : next);
  }
  if (first) std::reverse(line.begin(), line.end());
}

/// Whether an end is rounded: surface goes on around the axis where the wall has ended.
bool IsRounded(const std::vector<MeshPoint>& points, const Vector3& end, const Vector3& t,
               double radius_m) {
  return std::any_of(points.begin(), points.end(), [&](const MeshPoint& point) {
    const Vector3 d = point.p - end;
    const double s = d.dot(t);
    return s > 0.25 * radius_m && s < 1.2 * radius_m && (d - s * t).norm() < 0.2 * radius_m;
  });
}

/// Moves an end to where half of the way around is wall.
void MoveToCut(const WallCutter& cutter, double radius_m, bool first, Polyline& line) {
  const Vector3 t = OutwardAt(line, first, radius_m);
  Vector3& end = first ? line.front() : line.back();
  double low = 0.0, high = kStep * radius_m;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (SectionBeyond(cutter, end + middle * t, t, radius_m) ? low : high) = middle;
  }
  end += 0.5 * (low + high) * t;
}

/// Radius of the wall next to an end, short of what rounds the end.
double RadiusNear(const WallCutter& cutter, const Polyline& line, bool first, double radius_m) {
  const double length = Length(line);
  for (double back_m = 0.1 * radius_m; back_m < std::min(2.0 * radius_m, 0.5 * length);
       back_m += 0.1 * radius_m) {
    const double s = first ? back_m : length - back_m;
    const auto section =
        cutter.Cut(PointAt(line, s), TangentAt(line, s, radius_m), kReach * radius_m);
    if (section && section->seen >= kSeen && section->slope < kUpright) return section->radius_m;
  }
  return radius_m;
}

/// The points as points of an axis, so far inside.
std::vector<AxisPoint> AxisPointsOf(const std::vector<MeshPoint>& points, double wall_m) {
  std::vector<AxisPoint> out;
  out.reserve(points.size());
  for (const MeshPoint& point : points) out.push_back({point.p - wall_m * point.n, point.n});
  return out;
}

}  // namespace

WallCutter::WallCutter(const Mesh& mesh) {
  faces_.reserve(mesh.faces.size());
  for (const auto& indices : mesh.faces) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      face.corner[k] = mesh.vertices[static_cast<std::size_t>(indices[k])];
    }
    const Vector3 across = (face.corner[1] - face.corner[0]).cross(face.corner[2] - face.corner[0]);
    if (!(across.norm() > 0.0)) continue;
    face.normal = across.normalized();
    face.middle = (face.corner[0] + face.corner[1] + face.corner[2]) / 3.0;
    face.reach_m = 0.0;
    for (const Vector3& corner : face.corner) {
      face.reach_m = std::max(face.reach_m, (corner - face.middle).norm());
    }
    faces_.push_back(face);
  }
}

std::optional<WallSection> WallCutter::Cut(const Vector3& p, const Vector3& t,
                                           double reach_m) const {
  const Vector3 u = t.unitOrthogonal(), v = t.cross(u);
  CircleSums circle;
  double total = 0.0, angle = 0.0, slope = 0.0;
  for (const Face& face : faces_) {
    const Vector3 to = face.middle - p;
    if (std::abs(to.dot(t)) > face.reach_m) continue;
    if (to.squaredNorm() > (reach_m + face.reach_m) * (reach_m + face.reach_m)) continue;
    const double along = std::abs(face.normal.dot(t));
    if (along > kAlong) continue;
    Vector3 cut[2];
    if (!CutFace(face.corner, p, t, cut)) continue;
    const Vector3 a = cut[0] - p, b = cut[1] - p, m = 0.5 * (a + b);
    const double weight = (b - a).norm();
    if (m.norm() > reach_m || face.normal.dot(m) < kAway * m.norm()) continue;
    // Simpson's rule along the piece.
    circle.Add(a.dot(u), a.dot(v), weight / 6.0);
    circle.Add(m.dot(u), m.dot(v), weight * 4.0 / 6.0);
    circle.Add(b.dot(u), b.dot(v), weight / 6.0);
    total += weight;
    slope += weight * along;
    angle += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  if (!(total > 0.0)) return std::nullopt;
  const Vector3 fit = circle.Solve();
  if (!(fit[2] > 0.0)) return std::nullopt;
  return WallSection{p + fit[0] * u + fit[1] * v, fit[2], std::min(1.0, angle / (2.0 * kPi)),
                     slope / total};
}

SectionedAxis CentreInSections(const WallCutter& cutter, const std::vector<MeshPoint>& points,
                               const Polyline& rough, double radius_m, Parallelism parallelism) {
  constexpr int kTimes = 4;
  const double length = Length(rough), back_m = std::min(kCutBack * radius_m, 0.25 * length);
  SectionedAxis out;
  out.line = SubLine(rough, back_m, length - back_m);
  for (int i = 0; i < kTimes; ++i) {
    out.line = Centred(cutter, out.line, radius_m, parallelism, nullptr);
    if (out.line.size() < 3) return {};
    for (const bool first : {true, false}) Prolong(cutter, radius_m, first, out.line);
  }
  const Polyline middle = Centred(cutter, out.line, radius_m, parallelism, &out.sections);
  if (middle.size() < 3) return {};
  out.line = middle;
  for (const bool first : {true, false}) {
    Prolong(cutter, radius_m, first, out.line);
    MoveToCut(cutter, radius_m, first, out.line);
    const Vector3 t = OutwardAt(out.line, first, radius_m);
    if (!IsRounded(points, first ? out.line.front() : out.line.back(), t, radius_m)) continue;
    const double wall_m = RadiusNear(cutter, out.line, first, radius_m);
    // A second time with the direction that the first left.
    const std::vector<AxisPoint> axis_points = AxisPointsOf(points, wall_m);
    for (int i = 0; i < 2; ++i) {
      MoveEnd(out.line, first, OutwardAt(out.line, first, radius_m), axis_points, radius_m,
              0.2 * wall_m, kStep * radius_m);
    }
  }
  return out;
}

}  // namespace tubetwin

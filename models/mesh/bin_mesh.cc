#include "models/mesh/bin_mesh.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <optional>

namespace tubetwin {
namespace {

constexpr int kSamples = 40'000;
constexpr double kLevel = 0.99, kUpright = 0.15;  ///< |n.z| of a floor, of a wall (8.6 degrees).
constexpr double kFlat_m = 0.006;                 ///< Ribs and steps below this are no matter.
constexpr double kMaxLean = 0.0875;               ///< Tangent of 5 degrees.
constexpr double kMinFloor = 0.9, kMinWall = 0.8;
constexpr double kMaxContent = 0.02;  ///< Surface between the walls, as a share of the floor.

std::string Mm(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f mm", 1e3 * m);
  return text;
}

std::string Percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

double AreaOf(const std::vector<MeshPoint>& points) {
  double area = 0.0;
  for (const MeshPoint& point : points) area += point.area;
  return area;
}

/// Values that lie close together, and the area of their points.
struct Window {
  double low = 0.0, middle = 0.0, area = 0.0;
};

/// The windows of `width` that end at each value of (value, area).
std::vector<Window> Windows(std::vector<std::pair<double, double>> values, double width) {
  std::sort(values.begin(), values.end());
  std::vector<Window> windows;
  double area = 0.0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    area += values[i].second;
    while (values[i].first - values[first].first > width) area -= values[first++].second;
    windows.push_back({values[first].first, values[(first + i) / 2].first, area});
  }
  return windows;
}

Window Largest(const std::vector<Window>& windows) {
  return *std::max_element(windows.begin(), windows.end(),
                           [](const Window& a, const Window& b) { return a.area < b.area; });
}

/// Turn about z by which most of the upright surface stands along x and y: the mean of four times
/// the normals' directions.
double YawOf(const std::vector<MeshPoint>& points) {
  std::complex<double> sum = 0.0;
  for (const MeshPoint& point : points) {
    if (std::abs(point.n.z()) > kUpright) continue;
    sum += point.area * std::polar(1.0, 4.0 * std::atan2(point.n.y(), point.n.x()));
  }
  return std::abs(sum) > 0.0 ? 0.25 * std::arg(sum) : 0.0;
}

std::vector<MeshPoint> Mapped(const RigidTransform& X, std::vector<MeshPoint> points) {
  for (MeshPoint& point : points) {
    point.p = X * point.p;
    point.n = X.linear() * point.n;
  }
  return points;
}

/// Height of the lowest of the large level surfaces: of those that look upwards, unless the bin is
/// a sheet without thickness that looks downwards.
std::optional<double> FloorHeight(const std::vector<MeshPoint>& points) {
  std::vector<std::pair<double, double>> up, all;  // Height and area.
  double up_area = 0.0, all_area = 0.0;
  for (const MeshPoint& point : points) {
    if (std::abs(point.n.z()) < kLevel) continue;
    all.emplace_back(point.p.z(), point.area);
    all_area += point.area;
    if (point.n.z() < 0.0) continue;
    up.emplace_back(point.p.z(), point.area);
    up_area += point.area;
  }
  const std::vector<Window> windows = Windows(up_area > 0.2 * all_area ? up : all, 0.5 * kFlat_m);
  if (windows.empty()) return std::nullopt;
  const double max_area = Largest(windows).area;
  const auto large = [&](const Window& window) { return window.area > 0.6 * max_area; };
  const auto first = std::find_if(windows.begin(), windows.end(), large);
  // The best of the windows over one another there.
  Window best = *first;
  for (auto next = first; next != windows.end() && next->low - first->low < 0.5 * kFlat_m; ++next) {
    if (next->area > best.area) best = *next;
  }
  return best.middle;
}

/// One inner wall: its distance from the middle at half height and what is wrong with it.
struct Wall {
  double distance_m = 0.0, spread_m = 0.0, lean = 0.0;
  double area_m2 = 0.0;
  double low_m = 0.0, high_m = 0.0;  ///< Of the heights that were looked at, over the floor.
};

/// Surface that stands towards `direction` from the middle of the floor; of it what looks back,
/// unless the bin is a sheet without thickness, and of that the innermost.
Wall FindWall(const std::vector<MeshPoint>& points, const Vector3& direction, double height_m) {
  Wall wall;
  wall.low_m = 0.15 * height_m;
  wall.high_m = 0.85 * height_m;
  std::vector<MeshPoint> inner, all;
  for (const MeshPoint& point : points) {
    const double facing = point.n.dot(direction);
    if (point.p.z() < wall.low_m || point.p.z() > wall.high_m) continue;
    if (std::abs(facing) < 0.9 || point.p.dot(direction) < 0.0) continue;
    all.push_back(point);
    if (facing < 0.0) inner.push_back(point);
  }
  if (AreaOf(inner) > 0.1 * AreaOf(all)) all.swap(inner);
  if (all.empty()) return wall;
  // What stands between the walls is judged later: the wall is where most of this surface is.
  std::vector<std::pair<double, double>> where;
  for (const MeshPoint& point : all) where.emplace_back(point.p.dot(direction), point.area);
  const double width = kFlat_m + 3.0 * kMaxLean * height_m;
  const double low = Largest(Windows(std::move(where), width)).low;
  std::vector<MeshPoint> chosen;
  for (const MeshPoint& point : all) {
    const double distance = point.p.dot(direction);
    if (distance >= low && distance <= low + width) chosen.push_back(point);
  }
  std::vector<double> distances;
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const MeshPoint& point : chosen) {
    const Eigen::Vector2d row(1.0, point.p.z() - 0.5 * height_m);
    squares += row * row.transpose();
    right += point.p.dot(direction) * row;
  }
  // The wall's line over the height: how far at half height, how much further per metre up.
  const Eigen::Vector2d line = squares.ldlt().solve(right);
  for (const MeshPoint& point : chosen) {
    distances.push_back(point.p.dot(direction) - line[0] -
                        line[1] * (point.p.z() - 0.5 * height_m));
  }
  std::sort(distances.begin(), distances.end());
  wall.distance_m = line[0];
  wall.lean = std::abs(line[1]);
  wall.spread_m = distances[distances.size() * 49 / 50] - distances[distances.size() / 50];
  wall.area_m2 = AreaOf(chosen);
  return wall;
}

/// Share of the floor's area that surface within `low` and `high` (frame N) has.
double ShareWithin(const std::vector<MeshPoint>& points_N, const Vector3& low, const Vector3& high,
                   double floor_m2, bool level_only) {
  double area = 0.0;
  for (const MeshPoint& point : points_N) {
    if ((point.p.array() < low.array()).any() || (point.p.array() > high.array()).any()) continue;
    if (!level_only || std::abs(point.n.z()) > kLevel) area += point.area;
  }
  return area / floor_m2;
}

constexpr const char* kSides[4] = {"x+", "x-", "y+", "y-"};

/// What is wrong with the walls, if anything.
void JudgeWalls(const std::array<Wall, 4>& walls, MeshBin& bin) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Wall& wall = walls[i];
    const double side_m = bin.size_m[i < 2 ? 1 : 0];
    const double share = wall.area_m2 / (side_m * (wall.high_m - wall.low_m));
    if (!(share >= kMinWall)) {
      bin.verdict = BinVerdict::kNoWall;
      bin.reason = std::string("its wall at ") + kSides[i] + " covers " + Percent(share) +
                   " of that side; at least 80 % are needed";
    } else if (wall.lean > kMaxLean || wall.spread_m > kFlat_m) {
      bin.verdict = BinVerdict::kNoBox;
      bin.reason = std::string("its wall at ") + kSides[i] + " leans by " +
                   Mm(wall.lean * bin.size_m[2]) + " and is uneven by " + Mm(wall.spread_m) +
                   "; allowed are 5 degrees and " + Mm(kFlat_m);
    } else {
      continue;
    }
    return;
  }
}

void JudgeInside(const std::vector<MeshPoint>& points_N, double lean_m, MeshBin& bin) {
  const double x = 0.5 * bin.size_m[0], y = 0.5 * bin.size_m[1], z = bin.size_m[2];
  const double floor_m2 = 4.0 * x * y, gap = kFlat_m + lean_m;
  const double floor =
      ShareWithin(points_N, {-x, -y, -0.5 * kFlat_m}, {x, y, 0.5 * kFlat_m}, floor_m2, true);
  const double content = ShareWithin(points_N, {gap - x, gap - y, 2.0 * kFlat_m},
                                     {x - gap, y - gap, z + kFlat_m}, floor_m2, false);
  if (floor < kMinFloor) {
    bin.verdict = BinVerdict::kNoFloor;
    bin.reason = "its floor covers " + Percent(floor) + " of the " + Mm(2 * x) + " x " + Mm(2 * y) +
                 " between the walls; at least 90 % are needed";
  } else if (content > kMaxContent) {
    bin.verdict = BinVerdict::kNotEmpty;
    bin.reason = "something stands between its walls or closes it: surface of " + Percent(content) +
                 " of its floor; an open, empty bin is needed";
  } else if (2 * x < 0.1 || 2 * x > 3.0 || 2 * y < 0.1 || 2 * y > 3.0 || z < 0.01 || z > 1.0) {
    bin.verdict = BinVerdict::kWrongSize;
    bin.reason = "its inside is " + Mm(2 * x) + " x " + Mm(2 * y) + " x " + Mm(z) +
                 "; allowed are 100 mm to 3 m, and walls of 10 mm to 1 m";
  }
}

}  // namespace

MeshBin FindBinOfMesh(const Mesh& mesh) {
  MeshBin bin;
  std::vector<MeshPoint> points_M;
  double area = 0.0;
  const std::vector<Mesh> pieces = ConnectedPieces(mesh);
  for (const Mesh& piece : pieces) {
    for (const MeshPoint& corner : FaceCorners(piece)) area += corner.area;
  }
  for (const Mesh& piece : pieces) {
    double own = 0.0;
    for (const MeshPoint& corner : FaceCorners(piece)) own += corner.area;
    const auto samples = SampleSurface(piece, 1 + static_cast<int>(kSamples * own / area));
    points_M.insert(points_M.end(), samples.begin(), samples.end());
  }
  // Frame A: the mesh's origin, axes along the walls.
  const RigidTransform X_AM = MakeTransform(RotZ(-YawOf(points_M)), Vector3::Zero());
  const std::vector<MeshPoint> points_A = Mapped(X_AM, points_M);
  const std::optional<double> floor = FloorHeight(points_A);
  double top = -1e300;
  for (const Vector3& v : mesh.vertices) top = std::max(top, v.z());
  if (!floor || top - *floor < 0.005) {
    bin.verdict = BinVerdict::kNoFloor;
    bin.reason =
        "no level floor with walls above it was found; the bin must be open and z point up";
    return bin;
  }
  Vector3 low = Vector3::Constant(1e300), high = -low;
  for (const MeshPoint& point : points_A) {
    if (std::abs(point.n.z()) < kLevel || std::abs(point.p.z() - *floor) > kFlat_m) continue;
    low = low.cwiseMin(point.p);
    high = high.cwiseMax(point.p);
  }
  Vector3 middle = 0.5 * (low + high);
  middle.z() = *floor;
  const double height_m = top - *floor;
  std::vector<MeshPoint> points = Mapped(Translation(-middle), points_A);
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  std::array<Wall, 4> walls = {FindWall(points, x, height_m), FindWall(points, -x, height_m),
                               FindWall(points, y, height_m), FindWall(points, -y, height_m)};
  const Vector3 shift(0.5 * (walls[0].distance_m - walls[1].distance_m),
                      0.5 * (walls[2].distance_m - walls[3].distance_m), 0.0);
  double long_m = walls[0].distance_m + walls[1].distance_m;
  double short_m = walls[2].distance_m + walls[3].distance_m;
  RigidTransform X_AN = Translation(middle + shift);
  bin.size_m = {long_m, short_m, height_m};
  double lean_m = 0.0;
  for (const Wall& wall : walls) lean_m = std::max(lean_m, 0.5 * wall.lean * height_m);
  JudgeWalls(walls, bin);
  if (bin.verdict == BinVerdict::kBin) {
    JudgeInside(Mapped(Translation(-shift), points), lean_m, bin);
  }
  if (short_m > long_m) {
    std::swap(bin.size_m[0], bin.size_m[1]);
    X_AN.linear() = RotZ(0.5 * kPi);
  }
  bin.X_MN = X_AM.inverse() * X_AN;
  return bin;
}

}  // namespace tubetwin

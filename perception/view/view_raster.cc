#include "perception/view/view_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include "models/base/error.h"
#include "perception/view/voxel_grid.h"

namespace tubetwin {
namespace {

/// A cloud is a pinhole image when the fitted camera explains the raster this well.
constexpr double kPinholeResidual_px = 1.0;

/// Line u = slope q + offset through many samples.
struct LineFit {
  double n = 0, q = 0, u = 0, qq = 0, qu = 0, uu = 0;
  void Add(double q_i, double u_i) {
    n += 1;
    q += q_i;
    u += u_i;
    qq += q_i * q_i;
    qu += q_i * u_i;
    uu += u_i * u_i;
  }
  double slope() const { return (n * qu - q * u) / (n * qq - q * q); }
  double offset() const { return (u - slope() * q) / n; }
  double rms() const {
    const double s = slope(), o = offset();
    const double sum = uu - 2 * s * qu - 2 * o * u + s * s * qq + 2 * s * o * q + o * o * n;
    return std::sqrt(std::max(0.0, sum / n));
  }
};

struct Pinhole {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double depth_m = 0;  ///< Median.
  bool fits = false;
};

/// The camera behind an organised cloud, from a thinned set of its points.
Pinhole FitPinhole(const OrganizedCloud& cloud) {
  Pinhole out;
  if (!cloud.organized()) return out;
  const int stride = std::max(1, static_cast<int>(std::sqrt(cloud.size() / 20000.0)));
  LineFit columns, rows;
  std::vector<float> depths;
  std::size_t behind = 0;
  for (int row = 0; row < cloud.height; row += stride) {
    for (int column = 0; column < cloud.width; column += stride) {
      const auto& p = cloud.p_SP[static_cast<std::size_t>(row) * cloud.width + column];
      if (!IsValid(p)) continue;
      if (p.z() < kNearest_m) {
        ++behind;
        continue;
      }
      columns.Add(p.x() / p.z(), column);
      rows.Add(p.y() / p.z(), row);
      depths.push_back(p.z());
    }
  }
  if (depths.size() < 50 || behind * 100 > depths.size()) return out;
  std::nth_element(depths.begin(), depths.begin() + depths.size() / 2, depths.end());
  out = {columns.slope(),           rows.slope(), columns.offset(), rows.offset(),
         depths[depths.size() / 2], false};
  out.fits = out.fx > 0 && out.fy > 0 && columns.rms() < kPinholeResidual_px &&
             rows.rms() < kPinholeResidual_px;
  return out;
}

/// Whether a point in S can be a scanner's: within 143 degrees and 10 m. Strays would blow up the
/// image.
bool MayBeSeen(const Eigen::Vector3f& p_S) {
  constexpr float kWidest = 3.0f, kFarthest_m = 10.0f;
  return p_S.z() >= kNearest_m && p_S.z() <= kFarthest_m &&
         std::abs(p_S.x()) <= kWidest * p_S.z() && std::abs(p_S.y()) <= kWidest * p_S.z();
}

/// Side of the squares that hold one point each on average, from the occupied 5 mm cells.
double PointPitch(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kCell_m = 0.005;
  const VoxelGrid cells(points, kCell_m, [](const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return {p.x(), p.y(), 0.0f};
  });
  return kCell_m * std::sqrt(cells.size() / static_cast<double>(points.size()));
}

/// The pinhole, without pixels, that sees all `points_S` about `pitch_m` apart.
ViewRaster FrameAround(const std::vector<Eigen::Vector3f>& points_S, double pitch_m) {
  ViewRaster raster;
  constexpr double kMaxPixels = 16e6;  // Coarser beyond, so that memory stays bounded.
  Eigen::AlignedBox2f box;
  std::vector<float> depths;
  for (const auto& p : points_S) {
    box.extend(Eigen::Vector2f(p.head<2>() / p.z()));
    depths.push_back(p.z());
  }
  std::nth_element(depths.begin(), depths.begin() + depths.size() / 2, depths.end());
  const double depth_m = depths[depths.size() / 2];
  const double area_m2 = depth_m * depth_m * box.sizes().cast<double>().prod();
  // A little coarser than the points, so that few pixels between them stay empty.
  raster.pitch_m = std::max({pitch_m, 1.3 * PointPitch(points_S), std::sqrt(area_m2 / kMaxPixels)});
  raster.fx = raster.fy = depth_m / raster.pitch_m;
  raster.cx = 1.0 - box.min().x() * raster.fx;
  raster.cy = 1.0 - box.min().y() * raster.fy;
  raster.width = static_cast<int>(box.sizes().x() * raster.fx + 3);
  raster.height = static_cast<int>(box.sizes().y() * raster.fy + 3);
  return raster;
}

/// An image of points in any order as a pinhole at S sees them: the nearest surface per pixel.
ViewRaster SeeAnew(const std::vector<Eigen::Vector3f>& points_S, double pitch_m) {
  ViewRaster raster = FrameAround(points_S, pitch_m);
  struct Pixel {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float near = std::numeric_limits<float>::infinity();
    int count = 0;
  };
  const auto width = static_cast<std::size_t>(raster.width);
  std::vector<Pixel> pixels(width * static_cast<std::size_t>(raster.height));
  auto pixel_of = [&](const Eigen::Vector3f& p) -> Pixel* {
    const double x = raster.fx * p.x() / p.z() + raster.cx + 0.5;
    const double y = raster.fy * p.y() / p.z() + raster.cy + 0.5;
    if (!(x >= 0 && y >= 0 && x < raster.width && y < raster.height)) return nullptr;
    const int c = static_cast<int>(x), r = static_cast<int>(y);
    return &pixels[static_cast<std::size_t>(r) * width + static_cast<std::size_t>(c)];
  };
  for (const auto& p : points_S) {
    if (Pixel* pixel = pixel_of(p)) pixel->near = std::min(pixel->near, p.z());
  }
  for (const auto& p : points_S) {
    Pixel* pixel = pixel_of(p);
    if (pixel == nullptr || p.z() > pixel->near + kEdgeDepth_m) continue;
    pixel->sum += p;
    ++pixel->count;
  }
  raster.projected_S.reserve(pixels.size());
  for (const Pixel& p : pixels) {
    raster.projected_S.push_back(p.count > 0 ? Eigen::Vector3f(p.sum / static_cast<float>(p.count))
                                             : InvalidPoint());
  }
  return raster;
}

ViewRaster KeepRaster(const OrganizedCloud& cloud, const Pinhole& camera, double pitch_m) {
  ViewRaster raster;
  raster.width = cloud.width;
  raster.height = cloud.height;
  raster.cloud = &cloud;
  raster.fx = camera.fx;
  raster.fy = camera.fy;
  raster.cx = camera.cx;
  raster.cy = camera.cy;
  const double pixel_m = camera.depth_m / camera.fx;
  raster.block = std::clamp(static_cast<int>(std::lround(pitch_m / pixel_m)), 1, 16);
  raster.pitch_m = pixel_m * raster.block;
  return raster;
}

/// Point of the first pixel with a return that is `near` to twice as many steps away; NaN without.
Eigen::Vector3f Neighbour(const ViewRaster& view, int column, int row, int step_x, int step_y,
                          int near) {
  for (int i = near; i <= 2 * near; ++i) {
    const int c = column + i * step_x, r = row + i * step_y;
    if (c < 0 || r < 0 || c >= view.width || r >= view.height) break;
    const Eigen::Vector3f& p = view.At(c, r);
    if (p.z() >= kNearest_m) return p;
  }
  return InvalidPoint();
}

}  // namespace

ViewRaster MakeViewRaster(const OrganizedCloud& cloud, double pitch_m) {
  if (!cloud.X_NS.matrix().allFinite()) {
    throw Error(ErrorKind::kBadData, "cloud: the scanner's pose is not finite");
  }
  if (cloud.size() != static_cast<std::size_t>(cloud.width) * cloud.height) {
    throw Error(ErrorKind::kBadData, "cloud: " + std::to_string(cloud.size()) + " points, " +
                                         std::to_string(cloud.width) + " x " +
                                         std::to_string(cloud.height) + " were announced");
  }
  ViewRaster raster;
  RigidTransform X_NV = cloud.X_NS;
  const Pinhole camera = FitPinhole(cloud);
  if (camera.fits) {
    raster = KeepRaster(cloud, camera, pitch_m);
  } else {
    std::vector<Eigen::Vector3f> points;
    std::size_t behind = 0;
    for (const auto& p : cloud.p_SP) {
      if (!IsValid(p)) continue;
      points.push_back(p);
      behind += p.z() < kNearest_m;
    }
    if (behind * 100 > points.size()) {
      X_NV = MakeTransform(RotX(kPi), Vector3(0, 0, 1.5));
      const Eigen::Isometry3f X_VS = (X_NV.inverse() * cloud.X_NS).cast<float>();
      for (auto& p : points) p = X_VS * p;
    }
    std::erase_if(points, [](const auto& p) { return !MayBeSeen(p); });
    if (!points.empty()) raster = SeeAnew(points, pitch_m);
  }
  raster.X_NS = X_NV;
  return raster;
}

ViewImage MakeEmptyImage(const ViewRaster& raster) {
  ViewImage image;
  const int b = raster.block * kBlocksPerCell;
  image.width = (raster.block_columns() + kBlocksPerCell - 1) / kBlocksPerCell;
  image.height = (raster.block_rows() + kBlocksPerCell - 1) / kBlocksPerCell;
  image.pitch_m = raster.pitch_m * kBlocksPerCell;
  image.fx = raster.fx / b;
  image.fy = raster.fy / b;
  image.cx = (raster.cx - 0.5 * (b - 1)) / b;
  image.cy = (raster.cy - 0.5 * (b - 1)) / b;
  image.X_NS = raster.X_NS;
  image.X_SN = raster.X_NS.inverse();
  const std::size_t n =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.z_near.resize(n);
  image.z_far.resize(n);
  return image;
}

std::optional<Vector3> NormalAt(const ViewRaster& view, int column, int row, int near) {
  const Eigen::Vector3f along =
      Neighbour(view, column, row, 1, 0, near) - Neighbour(view, column, row, -1, 0, near);
  const Eigen::Vector3f down =
      Neighbour(view, column, row, 0, 1, near) - Neighbour(view, column, row, 0, -1, near);
  const Vector3 n = down.cross(along).cast<double>();
  const double length = n.norm();
  if (!(length > 0.0)) return std::nullopt;
  return Vector3(n / length);
}

}  // namespace tubetwin

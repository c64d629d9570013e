#include "perception/view_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hw_bridge/base/error.h"

namespace tubetwin {
namespace {

/// A block that spans more depth than this shows an edge or a flying pixel.
constexpr float kEdgeDepth_m = 0.003f;
/// Points nearer than this are no measurement of a scanner.
constexpr float kNearest_m = 0.05f;
/// A cloud is a pinhole image when the fitted camera explains the raster this well.
constexpr double kPinholeResidual_px = 1.0;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

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

/// Sums of the points of one block.
struct Block {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  float near = std::numeric_limits<float>::infinity();
  float far = 0.0f;
  void Add(const Eigen::Vector3f& p) {
    sum += p;
    ++count;
    near = std::min(near, p.z());
    far = std::max(far, p.z());
  }
};

void Allocate(ViewImage& image) {
  const std::size_t n =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.p_S.assign(n, InvalidPoint());
  image.z_near.assign(n, kNaN);
  image.z_far.assign(n, kNaN);
}

void Store(const Block& block, std::size_t index, ViewImage& image) {
  if (block.count == 0) return;
  image.z_near[index] = block.near;
  image.z_far[index] = block.far;
  if (block.far - block.near <= kEdgeDepth_m) {
    image.p_S[index] = block.sum / static_cast<float>(block.count);
  }
}

ViewImage ReduceRaster(const OrganizedCloud& cloud, const Pinhole& camera, double pitch_m) {
  ViewImage image;
  const double pixel_m = camera.depth_m / camera.fx;
  const int b = std::clamp(static_cast<int>(std::lround(pitch_m / pixel_m)), 1, 16);
  image.width = cloud.width / b;
  image.height = cloud.height / b;
  image.pitch_m = pixel_m * b;
  image.fx = camera.fx / b;
  image.fy = camera.fy / b;
  image.cx = (camera.cx - 0.5 * (b - 1)) / b;
  image.cy = (camera.cy - 0.5 * (b - 1)) / b;
  Allocate(image);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      Block block;
      for (int j = 0; j < b; ++j) {
        const auto* p = &cloud.p_SP[static_cast<std::size_t>(row * b + j) * cloud.width +
                                    static_cast<std::size_t>(column) * b];
        for (int i = 0; i < b; ++i) {
          if (IsValid(p[i]) && p[i].z() >= kNearest_m) block.Add(p[i]);
        }
      }
      Store(block, image.Index(column, row), image);
    }
  }
  return image;
}

/// Side of the squares that hold one point each on average, from the occupied 5 mm cells.
double PointPitch(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kCell_m = 0.005;
  std::vector<std::int64_t> cells;
  cells.reserve(points.size());
  for (const auto& p : points) {
    const auto ix = static_cast<std::int64_t>(std::floor(p.x() / kCell_m));
    const auto iy = static_cast<std::int64_t>(std::floor(p.y() / kCell_m));
    cells.push_back(ix * 1000003 + iy);
  }
  std::sort(cells.begin(), cells.end());
  const auto occupied = std::unique(cells.begin(), cells.end()) - cells.begin();
  return kCell_m * std::sqrt(static_cast<double>(occupied) / static_cast<double>(points.size()));
}

/// An image of points in any order as a pinhole at S sees them: nearest surface per block.
ViewImage Reproject(const std::vector<Eigen::Vector3f>& points_S, double pitch_m) {
  ViewImage image;
  if (points_S.empty()) return image;
  constexpr float kWidest = 3.0f;  // 143 degrees: a scanner sees less.
  Eigen::AlignedBox2f box;
  std::vector<float> depths;
  for (const auto& p : points_S) {
    const Eigen::Vector2f q = p.head<2>() / p.z();
    if (q.cwiseAbs().maxCoeff() > kWidest) continue;
    box.extend(q);
    depths.push_back(p.z());
  }
  if (depths.empty()) return image;
  std::nth_element(depths.begin(), depths.begin() + depths.size() / 2, depths.end());
  const double depth_m = depths[depths.size() / 2];
  // A little coarser than the points, so that few blocks between them stay empty.
  image.pitch_m = std::max(pitch_m, 1.3 * PointPitch(points_S));
  image.fx = image.fy = depth_m / image.pitch_m;
  image.cx = 1.0 - box.min().x() * image.fx;
  image.cy = 1.0 - box.min().y() * image.fy;
  constexpr double kMost = 8192;
  image.width = static_cast<int>(std::min(kMost, box.sizes().x() * image.fx + 3));
  image.height = static_cast<int>(std::min(kMost, box.sizes().y() * image.fy + 3));
  Allocate(image);
  std::vector<Block> blocks(image.p_S.size());
  auto index_of = [&image](const Eigen::Vector3f& p) {
    const long c = std::lround(image.fx * p.x() / p.z() + image.cx);
    const long r = std::lround(image.fy * p.y() / p.z() + image.cy);
    const bool inside = c >= 0 && r >= 0 && c < image.width && r < image.height;
    return inside
               ? static_cast<std::ptrdiff_t>(image.Index(static_cast<int>(c), static_cast<int>(r)))
               : std::ptrdiff_t{-1};
  };
  for (const auto& p : points_S) {
    if (const auto i = index_of(p); i >= 0) blocks[i].near = std::min(blocks[i].near, p.z());
  }
  for (const auto& p : points_S) {
    const auto i = index_of(p);
    if (i >= 0 && p.z() <= blocks[i].near + kEdgeDepth_m) blocks[i].Add(p);
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) Store(blocks[i], i, image);
  return image;
}

}  // namespace

ViewImage MakeViewImage(const OrganizedCloud& cloud, double pitch_m) {
  if (!cloud.X_NS.matrix().allFinite()) {
    throw Error(ErrorKind::kBadData, "cloud: the scanner's pose is not finite");
  }
  if (cloud.size() != static_cast<std::size_t>(cloud.width) * cloud.height) {
    throw Error(ErrorKind::kBadData, "cloud: " + std::to_string(cloud.size()) + " points, " +
                                         std::to_string(cloud.width) + " x " +
                                         std::to_string(cloud.height) + " were announced");
  }
  ViewImage image;
  RigidTransform X_NV = cloud.X_NS;
  const Pinhole camera = FitPinhole(cloud);
  if (camera.fits) {
    image = ReduceRaster(cloud, camera, pitch_m);
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
    std::erase_if(points, [](const auto& p) { return p.z() < kNearest_m; });
    image = Reproject(points, pitch_m);
  }
  image.X_NS = X_NV;
  image.X_SN = X_NV.inverse();
  return image;
}

Sight LookAt(const ViewImage& view, const Vector3& p_NC, double radius_m, double slack_m) {
  if (view.width == 0) return Sight::kOutside;
  const Vector3 p_SC = view.X_SN * p_NC;
  if (p_SC.z() < kNearest_m) return Sight::kOutside;
  const long column = std::lround(view.fx * p_SC.x() / p_SC.z() + view.cx);
  const long row = std::lround(view.fy * p_SC.y() / p_SC.z() + view.cy);
  if (column < 1 || row < 1 || column + 1 >= view.width || row + 1 >= view.height) {
    return Sight::kOutside;
  }
  // The nearest return around the pixel: an edge beside the place must not deny it.
  float z = std::numeric_limits<float>::infinity();
  int returns = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const float near =
          view.z_near[view.Index(static_cast<int>(column) + i, static_cast<int>(row) + j)];
      if (!(near == near)) continue;
      ++returns;
      z = std::min(z, near);
    }
  }
  if (returns < 3) return Sight::kUnknown;
  const double along = p_SC.z() / p_SC.norm();
  const double surface = p_SC.z() - radius_m * along;
  if (z > surface + slack_m * along) return Sight::kSeenThrough;
  return z < surface - slack_m * along ? Sight::kHidden : Sight::kSurface;
}

}  // namespace tubetwin

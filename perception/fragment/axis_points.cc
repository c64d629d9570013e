#include "perception/fragment/axis_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "perception/fragment/depth_blocks.h"

namespace tubetwin {
namespace {

/// Cosine of the steepest incidence that still gives a normal.
constexpr float kGrazing = 0.3f;
/// Fewest neighbours of a normal, and the largest roughness of their plane as a share of the
/// radius (a window of 3.5 mm on a tube bulges by 0.01 r).
constexpr float kFewest = 8.0f;
constexpr float kRoughness = 0.035f;
/// A line of blocks has no normal.
constexpr float kMinRoundness = 0.2f;
constexpr int kLargestHalf = 4;

/// Blocks on either side of the centre, so that the window is about 3.5 mm wide.
int HalfWindow(const ViewRaster& raster) {
  return std::clamp(static_cast<int>(std::lround(0.0015 / raster.pitch_m)), 1, kLargestHalf);
}

/// The rows of blocks around the one that is looked at, in turn.
class Rows {
 public:
  Rows(const ViewRaster& raster, const Foreground& foreground, int half, int first)
      : source_(raster, foreground), half_(half), next_(first - half) {
    for (int j = 0; j < 2 * half; ++j) Read();
  }

  /// Moves on by one row; rows()[half] is the one in the middle.
  void Advance() {
    Read();
    for (int j = 0; j <= 2 * half_; ++j) {
      around_[static_cast<std::size_t>(j)] = &ring_[Slot(next_ - 1 - 2 * half_ + j)];
    }
  }
  const BlockRow* const* rows() const { return around_.data(); }

 private:
  std::size_t Slot(int row) const {
    const int size = 2 * half_ + 1;
    return static_cast<std::size_t>((row % size + size) % size);
  }
  void Read() {
    source_.Fill(next_, ring_[Slot(next_)]);
    ++next_;
  }

  DepthBlocks source_;
  int half_, next_;
  std::array<BlockRow, 2 * kLargestHalf + 1> ring_;
  std::array<const BlockRow*, 2 * kLargestHalf + 1> around_{};
};

/// Turns windows into surface points.
class PointMaker {
 public:
  PointMaker(const ViewRaster& raster, double radius_m, int half)
      : X_NS_(raster.X_NS.cast<float>()),
        r_(static_cast<float>(radius_m)),
        half_(half),
        // Along a surface seen at 60 degrees a window reaches twice as far as its width.
        reach_m_(static_cast<float>(2.5 * (half + 0.5) * raster.pitch_m)) {}

  void AddRow(const BlockRow* const* rows, SurfaceOfView& out) const {
    const BlockRow& row = *rows[half_];
    for (const auto& [from, to] : row.spans) {
      for (int c = from; c < to; c += 4) {
        const WindowPlanes planes = FitWindows(rows, half_, c, reach_m_);
        for (int i = 0; i < 4; ++i) Add(row, c + i, planes, i, out);
      }
    }
  }

 private:
  void Add(const BlockRow& row, int column, const WindowPlanes& planes, int i,
           SurfaceOfView& out) const {
    const auto at = static_cast<std::size_t>(column + kRowMargin);
    const float w = row.w[at];
    if (!(w == w)) return;
    const Eigen::Vector3f ray_S(row.u[at], row.v[at], 1.0f);
    const Eigen::Vector3f p_N = X_NS_ * Eigen::Vector3f(ray_S / w);
    const Eigen::Vector3f away_S(planes.a[i], planes.b[i], planes.c[i]);
    const float norm = away_S.norm();
    const float incidence = away_S.dot(ray_S) / (norm * ray_S.norm());
    // A point's distance from the plane is its error in 1/z over w and the normal's length.
    const float rough = kRoughness * r_ * w * norm;
    const bool smooth = planes.count[i] >= kFewest && planes.roundness[i] > kMinRoundness &&
                        planes.variance[i] <= rough * rough && incidence >= kGrazing;
    if (!smooth) {
      out.rejected_N.push_back(p_N);
      return;
    }
    const Eigen::Vector3f n_N = X_NS_.linear() * (away_S * (-1.0f / norm));
    out.points.push_back({p_N, n_N, p_N - r_ * n_N, incidence});
  }

  const Eigen::Isometry3f X_NS_;
  const float r_;
  const int half_;
  const float reach_m_;
};

/// Lets the depths of one row of blocks into its row of cells.
void AddDepths(const BlockRow& row, int block_row, int columns, ViewImage& image) {
  const int cell_row = block_row / kBlocksPerCell;
  const bool first = block_row % kBlocksPerCell == 0;
  for (int k = 0; k < image.width; ++k) {
    float near = std::numeric_limits<float>::infinity(), far = 0.0f;
    for (int c = kBlocksPerCell * k; c < std::min(columns, kBlocksPerCell * (k + 1)); ++c) {
      near = std::min(near, row.near[static_cast<std::size_t>(c + kRowMargin)]);
      far = std::max(far, row.far[static_cast<std::size_t>(c + kRowMargin)]);
    }
    const std::size_t cell = image.Index(k, cell_row);
    image.z_near[cell] = first ? near : std::min(image.z_near[cell], near);
    image.z_far[cell] = first ? far : std::max(image.z_far[cell], far);
  }
}

}  // namespace

SurfaceOfView ExtractSurfaceBand(const ViewRaster& raster, const Foreground& foreground,
                                 double radius_m, int band, ViewImage& image) {
  SurfaceOfView out;
  const int first = band * kRowsPerBand;
  const int last = std::min(raster.block_rows(), first + kRowsPerBand);
  const int half = HalfWindow(raster);
  Rows rows(raster, foreground, half, first);
  const PointMaker maker(raster, radius_m, half);
  for (int row = first; row < last; ++row) {
    rows.Advance();
    AddDepths(*rows.rows()[half], row, raster.block_columns(), image);
    maker.AddRow(rows.rows(), out);
  }
  // Cells without return so far hold infinity and 0.
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = image.Index(0, first / kBlocksPerCell);
       i < image.Index(0, (last + kBlocksPerCell - 1) / kBlocksPerCell); ++i) {
    if (image.z_far[i] > 0.0f) continue;
    image.z_near[i] = image.z_far[i] = kNaN;
  }
  return out;
}

}  // namespace tubetwin

#include "perception/label_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/fragment/axis_points.h"

namespace tubetwin {
namespace {

/// A point belongs to a tube up to this many radii from its axis: noise, hand-eye error and what
/// the centerline is off.
constexpr double kReach = 1.25;
/// Side of the lookup's cells.
constexpr float kCell_m = 0.01f;
/// Points of one unit of work.
constexpr int kBlock = 65536;

/// Pieces of centerlines near every cell of the room that the tubes take.
class NearbyPieces {
 public:
  struct Piece {
    Eigen::Vector3f a, ab;
    float per_length2, reach2;
    std::uint32_t label;
  };

  explicit NearbyPieces(const TubeScene& scene) {
    Eigen::AlignedBox3f box;
    for (std::size_t k = 0; k < scene.tubes.size(); ++k) AddTube(scene.tubes[k], k, box);
    if (pieces_.empty()) return;
    low_ = box.min();
    for (int i = 0; i < 3; ++i) {
      cells_[i] = static_cast<int>((box.max()[i] - low_[i]) / kCell_m) + 1;
    }
    near_.resize(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]);
    for (std::size_t i = 0; i < pieces_.size(); ++i) Enter(static_cast<std::uint32_t>(i));
  }

  std::uint32_t LabelOf(const Eigen::Vector3f& p_N) const {
    int c[3];
    for (int i = 0; i < 3; ++i) {
      const float along = (p_N[i] - low_[i]) / kCell_m;
      if (!(along >= 0.0f) || along >= static_cast<float>(cells_[i])) return kLabelCell;
      c[i] = static_cast<int>(along);
    }
    std::uint32_t label = kLabelCell;
    float best = std::numeric_limits<float>::infinity();
    for (const std::uint32_t i : near_[Index(c[0], c[1], c[2])]) {
      const Piece& piece = pieces_[i];
      const Eigen::Vector3f d = p_N - piece.a;
      const float t = std::clamp(d.dot(piece.ab) * piece.per_length2, 0.0f, 1.0f);
      const float distance2 = (d - t * piece.ab).squaredNorm();
      if (distance2 < best && distance2 < piece.reach2) {
        best = distance2;
        label = piece.label;
      }
    }
    return label;
  }

 private:
  void AddTube(const PerceivedTube& tube, std::size_t index, Eigen::AlignedBox3f& box) {
    const auto reach = static_cast<float>(kReach * tube.radius_m);
    for (std::size_t i = 1; i < tube.centerline_N.size(); ++i) {
      const Eigen::Vector3f a = tube.centerline_N[i - 1].cast<float>();
      const Eigen::Vector3f b = tube.centerline_N[i].cast<float>();
      const float length2 = (b - a).squaredNorm();
      pieces_.push_back({a, b - a, length2 > 0 ? 1.0f / length2 : 0.0f, reach * reach,
                         kLabelFirstTube + static_cast<std::uint32_t>(index)});
      for (const Eigen::Vector3f& p : {a, b}) {
        box.extend(p - Eigen::Vector3f::Constant(reach));
        box.extend(p + Eigen::Vector3f::Constant(reach));
      }
    }
  }

  /// Into every cell that the piece's own box, widened by its reach, touches.
  void Enter(std::uint32_t i) {
    const Piece& piece = pieces_[i];
    const float reach = std::sqrt(piece.reach2);
    int from[3], to[3];
    for (int k = 0; k < 3; ++k) {
      const float low = std::min(piece.a[k], piece.a[k] + piece.ab[k]) - reach - low_[k];
      const float high = std::max(piece.a[k], piece.a[k] + piece.ab[k]) + reach - low_[k];
      from[k] = std::clamp(static_cast<int>(std::floor(low / kCell_m)), 0, cells_[k] - 1);
      to[k] = std::clamp(static_cast<int>(std::floor(high / kCell_m)), 0, cells_[k] - 1);
    }
    for (int z = from[2]; z <= to[2]; ++z) {
      for (int y = from[1]; y <= to[1]; ++y) {
        for (int x = from[0]; x <= to[0]; ++x) near_[Index(x, y, z)].push_back(i);
      }
    }
  }

  std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * cells_[1] + y) * cells_[0] + x;
  }

  std::vector<Piece> pieces_;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  int cells_[3] = {0, 0, 0};
  std::vector<std::vector<std::uint32_t>> near_;
};

}  // namespace

std::vector<std::uint32_t> LabelPoints(const OrganizedCloud& cloud, const TubeScene& scene,
                                       const Bin& bin, Parallelism parallelism) {
  const NearbyPieces pieces(scene);
  // Whatever a tube touches, its own surface there stands clear of floor and walls.
  const Foreground foreground(bin, std::numeric_limits<double>::infinity());
  const Eigen::Isometry3f X_NS = cloud.X_NS.cast<float>();
  std::vector<std::uint32_t> label(cloud.size(), kLabelNone);
  const int blocks = static_cast<int>((cloud.size() + kBlock - 1) / kBlock);
  ParallelFor(blocks, parallelism, [&](int block, int) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    const std::size_t last = std::min(first + kBlock, cloud.size());
    for (std::size_t i = first; i < last; ++i) {
      if (!IsValid(cloud.p_SP[i])) continue;
      const Eigen::Vector3f p_N = X_NS * cloud.p_SP[i];
      label[i] = foreground.Contains(p_N.x(), p_N.y(), p_N.z()) ? pieces.LabelOf(p_N) : kLabelCell;
    }
  });
  return label;
}

}  // namespace tubetwin

#include "perception/scene/bin_state.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tubetwin {
namespace {

constexpr double kCell_m = 0.01;
/// A tube needs this share of its length in unseen axis cells, whatever its shape, and this share
/// from end to end (a hooked hose's ends come as near as that).
constexpr double kHidingCells = 0.7;
constexpr double kHidingReach = 0.35;

struct Hiding {
  double area_m2 = 0.0;  ///< Of the largest place in which a tube may lie; 0: there is none.
  Vector3 centre_N = Vector3::Zero();
};

/// Whether some view sees past a place of the tube whose axis passes `p_NC`: its top, or a flank
/// that a wall's shadow leaves free. Then the tube is not there.
bool Denied(const std::vector<ViewImage>& views, const Vector3& p_NC, double radius_m) {
  constexpr double kDeeper_m = 0.003;  // Than noise and hand-eye error make a return.
  constexpr double kInside = 0.8;      // Of the radius: what is asked for is surely tube.
  static const Vector3 kPlaces[] = {{0, 0, 0},  {0, 0, 1}, {1, 0, 0},
                                    {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (const Vector3& place : kPlaces) {
    const Vector3 p_N = p_NC + kInside * radius_m * place;
    for (const ViewImage& view : views) {
      if (QueryVisibility(view, p_N, 0.0, kDeeper_m) == Visibility::kSeenThrough) return true;
    }
  }
  return false;
}

/// Cells that tubes' axes may pass, at one radius over the floor.
class AxisGrid {
 public:
  AxisGrid(const std::vector<ViewImage>& views, const Bin& bin, double radius_m) {
    const double x = bin.half_x_m() - radius_m, y = bin.half_y_m() - radius_m;
    columns_ = std::max(1, static_cast<int>(std::ceil(2 * x / kCell_m)));
    rows_ = std::max(1, static_cast<int>(std::ceil(2 * y / kCell_m)));
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const Vector3 p_N((2.0 * i + 1.0) / columns_ * x - x, (2.0 * j + 1.0) / rows_ * y - y,
                          radius_m);
        p_N_.push_back(p_N);
        open_.push_back(Denied(views, p_N, radius_m) ? 0 : 1);
      }
    }
  }

  /// The largest connected place that takes a tube of this length; consumes the grid.
  Hiding Largest(double length_m) {
    Hiding best;
    for (std::size_t first = 0; first < open_.size(); ++first) {
      if (open_[first] == 0) continue;
      const std::vector<std::size_t> place = Connected(first);
      Eigen::AlignedBox3d box;
      Vector3 sum = Vector3::Zero();
      for (const std::size_t i : place) {
        box.extend(p_N_[i]);
        sum += p_N_[i];
      }
      const double area_m2 = static_cast<double>(place.size()) * kCell_m * kCell_m;
      const bool fits = static_cast<double>(place.size()) * kCell_m > kHidingCells * length_m &&
                        box.sizes().norm() > kHidingReach * length_m;
      if (fits && area_m2 > best.area_m2) {
        best = {area_m2, sum / static_cast<double>(place.size())};
      }
    }
    return best;
  }

 private:
  std::vector<std::size_t> Connected(std::size_t first) {
    std::vector<std::size_t> place = {first};
    open_[first] = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      const int row = static_cast<int>(place[k]) / columns_;
      const int column = static_cast<int>(place[k]) % columns_;
      for (int j = std::max(0, row - 1); j <= std::min(rows_ - 1, row + 1); ++j) {
        for (int i = std::max(0, column - 1); i <= std::min(columns_ - 1, column + 1); ++i) {
          const auto next = static_cast<std::size_t>(j) * columns_ + i;
          if (open_[next] == 0) continue;
          open_[next] = 0;
          place.push_back(next);
        }
      }
    }
    return place;
  }

  int columns_ = 0, rows_ = 0;
  std::vector<Vector3> p_N_;
  std::vector<char> open_;
};

std::string At(const Vector3& p_N) {
  char text[64];
  std::snprintf(text, sizeof text, "around (%.2f, %.2f, %.2f) m", p_N.x(), p_N.y(), p_N.z());
  return text;
}

}  // namespace

void JudgeBinContent(TubeScene& scene, const std::vector<ViewImage>& views, const Part& part,
                     const Bin& bin) {
  if (!scene.tubes.empty()) {
    scene.bin_content = BinContent::kNotEmpty;
    const std::size_t n = scene.tubes.size();
    scene.bin_content_reason = std::to_string(n) + (n == 1 ? " tube is seen" : " tubes are seen");
    return;
  }
  if (!scene.unexplained_N.empty()) {
    Vector3 sum = Vector3::Zero();
    for (const Vector3& p : scene.unexplained_N) sum += p;
    scene.bin_content = BinContent::kNotEmpty;
    scene.bin_content_reason = "no tube is seen, but " +
                               std::to_string(scene.unexplained_N.size()) + " unexplained points " +
                               At(sum / static_cast<double>(scene.unexplained_N.size()));
    return;
  }
  const Hiding hiding = AxisGrid(views, bin, part.radius_m).Largest(part.length_m);
  if (hiding.area_m2 > 0.0) {
    char area[32];
    std::snprintf(area, sizeof area, "%.3f", hiding.area_m2);
    scene.bin_content = BinContent::kUnseen;
    scene.bin_content_reason = "no tube is seen, but one may lie where no view looked, on " +
                               std::string(area) + " m2 " + At(hiding.centre_N);
    return;
  }
  scene.bin_content = BinContent::kEmpty;
  scene.bin_content_reason = "nothing is seen and no tube can hide";
}

}  // namespace tubetwin

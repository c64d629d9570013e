#include "perception/view/common_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tubetwin {
namespace {

constexpr double kHeightCell_m = 0.005;
/// Nearer to the walls every way shows the same.
constexpr double kFromWall_m = 0.015;
/// Higher places tell something; heights this close are the same.
constexpr float kTelling_m = 0.012f, kSameHeight_m = 0.005f;
/// A way is right when this share of at least so many telling cells agrees, and no other comes
/// near with at least so many.
constexpr double kRightShare = 0.85, kRivalShare = 0.6;
constexpr int kFewestTelling = 150, kFewestOfRival = 40;

/// Greatest heights over the floor that one view sees; NaN where it sees nothing.
class HeightMap {
 public:
  HeightMap(const OrganizedCloud& cloud, const RigidTransform& X_NS, const Bin& bin)
      : columns_(Cells(bin.size_m[0])),
        rows_(Cells(bin.size_m[1])),
        heights_m_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kUnseen) {
    for (const auto& p_S : cloud.p_SP) {
      if (!IsValid(p_S)) continue;
      const Vector3 p = X_NS * p_S.cast<double>();
      const int column = static_cast<int>(std::floor(p.x() / kHeightCell_m)) + columns_ / 2;
      const int row = static_cast<int>(std::floor(p.y() / kHeightCell_m)) + rows_ / 2;
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      float& height = heights_m_[Index(column, row)];
      const auto z = static_cast<float>(p.z());
      if (!(height >= z)) height = z;
    }
  }

  /// How many cells of `other` tell something here, and how many of them agree.
  void Compare(const HeightMap& other, int& telling, int& agree) const {
    for (int row = 1; row + 1 < rows_; ++row) {
      for (int column = 1; column + 1 < columns_; ++column) {
        const float theirs = other.heights_m_[Index(column, row)];
        const float own = heights_m_[Index(column, row)];
        if (!(std::max(own, theirs) > kTelling_m) || !(own == own) || !(theirs == theirs)) continue;
        ++telling;
        float low = own, high = own;
        for (int k = 0; k < 9; ++k) {
          const float near = heights_m_[Index(column + k % 3 - 1, row + k / 3 - 1)];
          if (near < low) low = near;
          if (near > high) high = near;
        }
        agree += theirs > low - kSameHeight_m && theirs < high + kSameHeight_m;
      }
    }
  }

 private:
  static constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  static int Cells(double size_m) {
    return 2 * static_cast<int>((0.5 * size_m - kFromWall_m) / kHeightCell_m);
  }
  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  int columns_, rows_;
  std::vector<float> heights_m_;
};

/// Places views around the first.
class Placing {
 public:
  Placing(const std::vector<std::vector<FloorWay>>& ways,
          const std::vector<std::vector<HeightMap>>& maps, std::size_t first)
      : ways_(ways), maps_(maps), chosen_(ways.size()) {
    chosen_[0] = first;
  }

  /// Places the view that has most in common with those placed; false: there is none.
  bool PlaceNext() {
    std::size_t best_view = 0, best_way = 0;
    int most = 0;
    for (std::size_t v = 1; v < ways_.size(); ++v) {
      if (chosen_[v]) continue;
      int telling = 0;
      const std::optional<std::size_t> way = RightWay(v, telling);
      if (!way || telling <= most) continue;
      most = telling;
      best_view = v;
      best_way = *way;
    }
    if (best_view == 0) return false;
    chosen_[best_view] = best_way;
    return true;
  }

  /// The first view that is not placed.
  std::optional<std::size_t> Left() const {
    for (std::size_t v = 0; v < chosen_.size(); ++v) {
      if (!chosen_[v]) return v;
    }
    return std::nullopt;
  }

  std::vector<FloorWay> Result() const {
    std::vector<FloorWay> out;
    for (std::size_t v = 0; v < chosen_.size(); ++v) out.push_back(ways_[v][*chosen_[v]]);
    return out;
  }

 private:
  std::optional<std::size_t> RightWay(std::size_t view, int& telling_of_right) const {
    std::optional<std::size_t> right;
    int rivals = 0;
    for (std::size_t w = 0; w < ways_[view].size(); ++w) {
      int telling = 0, agree = 0;
      for (std::size_t placed = 0; placed < chosen_.size(); ++placed) {
        if (chosen_[placed])
          maps_[placed][*chosen_[placed]].Compare(maps_[view][w], telling, agree);
      }
      const double share = telling > 0 ? static_cast<double>(agree) / telling : 0.0;
      rivals += telling >= kFewestOfRival && share > kRivalShare;
      if (telling < kFewestTelling || share < kRightShare) continue;
      right = w;
      telling_of_right = telling;
    }
    return rivals == 1 ? right : std::nullopt;
  }

  const std::vector<std::vector<FloorWay>>& ways_;
  const std::vector<std::vector<HeightMap>>& maps_;
  std::vector<std::optional<std::size_t>> chosen_;
};

}  // namespace

ChosenWays ChooseByCommonHeights(const std::vector<OrganizedCloud>& clouds,
                                 const std::vector<std::vector<FloorWay>>& ways, const Bin& bin) {
  std::vector<std::vector<HeightMap>> maps;
  for (std::size_t v = 0; v < clouds.size(); ++v) {
    maps.emplace_back();
    for (const FloorWay& way : ways[v]) maps.back().emplace_back(clouds[v], way.X_NC, bin);
  }
  ChosenWays out;
  int complete = 0;
  for (std::size_t first = 0; first < ways[0].size(); ++first) {
    Placing placing(ways, maps, first);
    while (placing.PlaceNext()) {
    }
    if (const auto left = placing.Left()) {
      out.why_none = "cloud " + std::to_string(*left + 1) +
                     " has too little of the pile in common with the others to tell how they stand "
                     "to each other";
      continue;
    }
    ++complete;
    out.ways = placing.Result();
  }
  if (complete > 1) {
    out = {{},
           "the clouds fit together in " + std::to_string(complete) +
               " ways: they show too few "
               "of the bin's walls"};
  }
  return out;
}

}  // namespace tubetwin

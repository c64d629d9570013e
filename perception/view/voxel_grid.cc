#include "perception/view/voxel_grid.h"

#include <cmath>

#include "models/base/error.h"

namespace tubetwin {

void VoxelGrid::Allocate(const Eigen::Array3f& low, const Eigen::Array3f& high) {
  constexpr float kMaxCells = 3e10f;  // 4 GB of bits.
  low_ = (low * per_metre_).floor() - static_cast<float>(kMargin);
  const Eigen::Array3f size = (high * per_metre_).floor() - low_ + static_cast<float>(kMargin + 1);
  TT_CHECK(size.allFinite() && size.prod() < kMaxCells);
  size_x_ = static_cast<int>(size[0]);
  size_y_ = static_cast<int>(size[1]);
  const std::size_t bits = BitOf(0, 0, static_cast<int>(size[2]));
  words_.assign(bits / 64 + 2, 0);  // A window may look into the word after the last.
  before_.resize(words_.size());
}

void VoxelGrid::Count() {
  for (std::size_t i = 0; i < words_.size(); ++i) {
    before_[i] = size_;
    if (words_[i] != 0) size_ += std::popcount(words_[i]);
  }
}

}  // namespace tubetwin

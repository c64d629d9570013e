#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include <Eigen/Dense>

namespace tubetwin {

/// Occupied cells of a grid of cubes, numbered from 0 in raster order (z slowest, x fastest).
/// Stores one bit for each cell of the box around all points, and for each word of 64 bits how many
/// cells are occupied before it.
class VoxelGrid {
 public:
  /// Cells around the box that are never occupied, so that neighbours need no test for its limits.
  static constexpr int kMargin = 4;

  /// Occupies the cell of each point of `points`: edge `cell_m`, corners at its multiples. `at`
  /// gives the coordinates (float 3-vector) of one element.
  template <class Points, class At>
  VoxelGrid(const Points& points, double cell_m, At at)
      : per_metre_(static_cast<float>(1.0 / cell_m)) {
    Eigen::Array3f low = Eigen::Array3f::Constant(1e30f), high = -low;
    for (const auto& point : points) {
      low = low.min(at(point).array());
      high = high.max(at(point).array());
    }
    if (!points.empty()) Allocate(low, high);
    for (const auto& point : points) Occupy(CellOf(at(point)));
    Count();
  }

  /// Cell coordinates, counted from the corner of the box.
  struct Cell {
    int x, y, z;
  };
  Cell CellOf(const Eigen::Vector3f& p) const {
    // Positive by construction, so that truncation is the floor.
    return {static_cast<int>(p.x() * per_metre_ - low_[0]),
            static_cast<int>(p.y() * per_metre_ - low_[1]),
            static_cast<int>(p.z() * per_metre_ - low_[2])};
  }

  /// Occupied cells.
  int size() const { return size_; }

  /// Number of an occupied cell.
  int NumberOf(const Cell& cell) const {
    const std::size_t bit = BitOf(cell.x, cell.y, cell.z);
    const std::uint64_t below = words_[bit / 64] & ((std::uint64_t{1} << (bit % 64)) - 1);
    return before_[bit / 64] + std::popcount(below);
  }

  /// Calls `visit(number)` for the occupied cells at most `reach` (up to kMargin) cells away along
  /// each axis, in ascending order, the own one included.
  template <class Visit>
  void ForNeighbours(const Cell& cell, int reach, Visit visit) const {
    const std::uint64_t window = (std::uint64_t{2} << (2 * reach)) - 1;
    for (int dz = -reach; dz <= reach; ++dz) {
      for (int dy = -reach; dy <= reach; ++dy) {
        const std::size_t bit = BitOf(cell.x - reach, cell.y + dy, cell.z + dz);
        const std::size_t word = bit / 64, shift = bit % 64;
        std::uint64_t bits = words_[word] >> shift;
        if (shift > 0) bits |= words_[word + 1] << (64 - shift);
        bits &= window;
        if (bits == 0) continue;
        const std::uint64_t below = words_[word] & ((std::uint64_t{1} << shift) - 1);
        int number = before_[word] + std::popcount(below);
        for (; bits != 0; bits &= bits - 1) visit(number++);
      }
    }
  }

 private:
  std::size_t BitOf(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_y_) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_x_) +
           static_cast<std::size_t>(x);
  }
  void Allocate(const Eigen::Array3f& low, const Eigen::Array3f& high);
  void Occupy(const Cell& cell) {
    const std::size_t bit = BitOf(cell.x, cell.y, cell.z);
    words_[bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  void Count();

  float per_metre_;
  Eigen::Array3f low_ = Eigen::Array3f::Zero();  ///< In cells, whole numbers.
  int size_x_ = 0, size_y_ = 0, size_ = 0;
  std::vector<std::uint64_t> words_;
  std::vector<int> before_;
};

}  // namespace tubetwin

#include "perception/view/voxel_grid.h"

#include <map>
#include <tuple>

#include "models/base/frames.h"
#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Key = std::tuple<int, int, int>;  // z, y, x: raster order.

Key KeyOf(const VoxelGrid::Cell& cell) { return {cell.z, cell.y, cell.x}; }

const auto kItself = [](const Eigen::Vector3f& p) { return p; };

TEST_CASE("Cells are numbered in raster order and know their occupied neighbours", "[unit]") {
  RandomStream stream(1, 0, "voxel grid");
  for (const int count : {1, 30, 3000}) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < count; ++i) {
      const Vector3 p(0.3 * stream.Normal(), 0.05 * stream.Normal(), 0.02 * stream.Uniform());
      points.push_back(p.cast<float>());
    }
    const VoxelGrid grid(points, 0.0025, kItself);
    std::map<Key, int> number;
    for (const auto& p : points) number[KeyOf(grid.CellOf(p))] = 0;
    int next = 0;
    for (auto& [key, n] : number) n = next++;
    REQUIRE(grid.size() == next);
    for (const auto& p : points) {
      const VoxelGrid::Cell cell = grid.CellOf(p);
      REQUIRE(grid.NumberOf(cell) == number[KeyOf(cell)]);
      for (const int reach : {1, 3}) {
        std::vector<int> expected, found;
        for (int dz = -reach; dz <= reach; ++dz) {
          for (int dy = -reach; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
              const auto it = number.find({cell.z + dz, cell.y + dy, cell.x + dx});
              if (it != number.end()) expected.push_back(it->second);
            }
          }
        }
        grid.ForNeighbours(cell, reach, [&](int n) { found.push_back(n); });
        REQUIRE(found == expected);
      }
    }
  }
}

TEST_CASE("Cells have their corners at multiples of the edge, below zero too", "[unit]") {
  const std::vector<Eigen::Vector3f> points = {
      {-0.001f, 0.0f, 0.0f}, {0.001f, 0.0f, 0.0f}, {-0.024f, 0.0f, 0.0f}, {-0.006f, 0.0f, 0.0f}};
  const VoxelGrid grid(points, 0.01, kItself);
  CHECK(grid.size() == 3);
  CHECK(grid.CellOf(points[1]).x == grid.CellOf(points[0]).x + 1);
  CHECK(grid.CellOf(points[3]).x == grid.CellOf(points[0]).x);
  CHECK(grid.CellOf(points[2]).x == grid.CellOf(points[0]).x - 2);
}

TEST_CASE("No point occupies nothing", "[unit]") {
  const VoxelGrid grid(std::vector<Eigen::Vector3f>{}, 0.01, kItself);
  CHECK(grid.size() == 0);
}

}  // namespace
}  // namespace tubetwin

// What a part is judged against is what the rooms that own the figures say.

#include "models/part_fit/part_fit.h"
#include "models/physics.h"
#include "perception/joining/bridges.h"
#include "planner/motion/path_config.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

TEST_CASE("A part is judged against the figures that a pick goes by", "[unit]") {
  const PartFitCell cell(PaperCell());
  const PathConfig path;
  const PhysicsRanges physics;
  CHECK(cell.grip_force_N == path.grip_force_N);
  CHECK(cell.carry_acceleration_m_s2 == path.transfer_acceleration_m_s2);
  CHECK(cell.pad_friction == physics.pad_friction[0]);
  CHECK(cell.noise_N == physics.wrench_noise_counts * cell.count_N);
  CHECK(cell.drift_N == physics.wrench_bias_walk_N);
  CHECK(cell.even_turn_m == Approx(kEven_m - kStraightest_m));
}

}  // namespace
}  // namespace tubetwin

// A new resolution strategy, as planner/resolution/README.md explains: one function, one line.
#include "models/bin.h"
#include "planner/motion/path_builder.h"
#include "planner/resolution/strategies.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

// [example]
/// "dip": twice down by 15 cm and up again at the tilt station; the load is weighed in between.
PickPath MakeDip(const ResolutionInput& input) {
  PathBuilder path(input.paths, input.ramp_s);
  path.Line("to the station", To(TiltStation(input)), input.lift_speed_m_s);
  for (int k = 0; k < 2; ++k) {
    if (k > 0) path.NextStage();
    path.Line("down", By(Vector3(0, 0, -0.15)), input.lift_speed_m_s);
    path.Line("up", By(Vector3(0, 0, 0.15)), input.lift_speed_m_s);
  }
  return path.path();
}

/// Its line in the registry.
const ResolutionStrategy kDip = {"dip", "dips twice", MakeDip};
// [example]

TEST_CASE("Example: a strategy of one's own is a path that the arm can run", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const Bin bin;
  const ResolutionConfig config;
  const PathConfig paths;
  const MotionPlanner planner(PaperCell(), bin);
  const RigidTransform X_BE = MakeTransform(RotX(kPi), Vector3(0.6, 0.0, 0.55));
  PathStart start;
  start.q = *planner.Reach(X_BE);
  const PickPath path =
      kDip.make({X_BE, Vector3::Zero(), layout, bin, config, paths, 0.25, 0.0, 0.0});
  CHECK(path.num_stages() == 2);
  const PathCheck check = Check(planner, path, start);
  REQUIRE(RefusalOf(check) == nullptr);
  const RigidTransform end = planner.PoseOfE(std::get<CheckedPath>(check).end().q);
  CHECK((end.translation() - layout.p_BTilt).norm() < 1e-6);
}

TEST_CASE("Every strategy of the registry ends upright where it began to tilt", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const Bin bin;
  const ResolutionConfig config;
  const PathConfig paths;
  const MotionPlanner planner(PaperCell(), bin);
  const RigidTransform X_BE = MakeTransform(RotX(kPi), Vector3(0.6, 0.0, 0.55));
  PathStart start;
  start.q = *planner.Reach(X_BE);
  for (const ResolutionStrategy& strategy : ResolutionStrategies()) {
    if (strategy.make == nullptr) continue;
    INFO(strategy.name);
    bool any = false;
    for (double yaw_deg = -160.0; yaw_deg <= 160.0 && !any; yaw_deg += 20.0) {
      const PickPath path = strategy.make(
          {X_BE, Vector3(0.1, 0, 0), layout, bin, config, paths, 0.25, 0.0, Radians(yaw_deg)});
      const PathCheck check = Check(planner, path, start);
      if (RefusalOf(check) != nullptr) continue;
      any = true;
      const RigidTransform end = planner.PoseOfE(std::get<CheckedPath>(check).end().q);
      CHECK((end.linear().col(2) + Vector3::UnitZ()).norm() < 1e-6);
      CHECK((end.translation() - layout.p_BTilt).norm() < 1e-6);
    }
    CHECK(any);
  }
}

}  // namespace
}  // namespace tubetwin

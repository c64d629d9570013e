#include "planner/pick/tool_path.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/planning.h"

namespace tubetwin {
namespace {

Eigen::Quaterniond About(const Vector3& axis, double angle_deg) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(Radians(angle_deg), axis));
}

RigidTransform Down(const Vector3& p_NE) { return MakeTransform(RotX(kPi), p_NE); }

ObjectPath Tilted() {
  ObjectPath way;
  way.waypoints_N = {Vector3::Zero(), Vector3::Zero(), Vector3(0, 0, 0.4)};
  way.rotations_N = {About(Vector3::UnitY(), 0), About(Vector3::UnitY(), 30),
                     About(Vector3::UnitY(), 30)};
  way.pivot_N = Vector3(0.1, 0, 0);
  return way;
}

TEST_CASE("A way that turns goes round its pivot", "[unit]") {
  const ObjectPath way = Tilted();
  CHECK((PoseAt(way, 1) * way.pivot_N).isApprox(way.pivot_N, kExact));
  // A point 0.2 m behind the pivot rises by 0.2 sin 30.
  const Vector3 p = PoseAt(way, 1) * Vector3(-0.1, 0, 0);
  CHECK(p.isApprox(Vector3(0.1 - 0.2 * std::cos(Radians(30)), 0, 0.1), kExact));
  CHECK((PoseAt(way, 2) * Vector3(-0.1, 0, 0) - p).isApprox(Vector3(0, 0, 0.4), kExact));
}

TEST_CASE("No point within reach moves farther than asked from pose to pose", "[unit]") {
  const ObjectPath way = Tilted();
  const std::vector<RigidTransform> poses = PosesAlong(way, 0.01, 0.3);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    for (const Vector3& p : {Vector3(-0.2, 0, 0), Vector3(0.1, 0, 0.3), Vector3(0.4, 0, 0)}) {
      CHECK((poses[k] * p - poses[k - 1] * p).norm() <= 0.01 + kExact);
    }
  }
  CHECK(poses.back().isApprox(PoseAt(way, 2), kExact));
}

TEST_CASE("A way that turns survives its file, a straight one stays as short", "[unit]") {
  Json json = Json::object();
  AddObjectPath(Tilted(), json);
  const ObjectPath read = ObjectPathFromJson(JsonView(json, "test"));
  REQUIRE(read.rotations_N.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(PoseAt(read, k).isApprox(PoseAt(Tilted(), k), kExact));
  json["rotations_wxyz"].erase(2);
  CHECK_THROWS_WITH(ObjectPathFromJson(JsonView(json, "test")),
                    Catch::Contains("one rotation for each waypoint is needed"));
  ObjectPath up;
  up.waypoints_N = {Vector3::Zero(), Vector3(0, 0, 0.4)};
  Json straight = Json::object();
  AddObjectPath(up, straight);
  CHECK(straight.size() == 1);
}

TEST_CASE("A tool that was tilted on the way points down at the end", "[unit]") {
  const RigidTransform X_NE = Down({0, 0, 0.02});
  const std::vector<RigidTransform> tool = ToolPath(Tilted(), X_NE);
  REQUIRE(tool.size() == 3);
  CHECK(tool[1].linear().isApprox(RotY(Radians(30)) * X_NE.linear(), kExact));
  CHECK(tool[2].linear().isApprox(X_NE.linear(), kExact));
  CHECK(tool[2].translation().isApprox(tool[1].translation(), kExact));
  ObjectPath up;
  up.waypoints_N = {Vector3::Zero(), Vector3(0, 0, 0.4)};
  CHECK(ToolPath(up, X_NE).size() == 1);
}

TEST_CASE("A straight way is cut where the first lift ends", "[unit]") {
  const RigidTransform X_NE = Down({0.1, 0.2, 0.02});
  ObjectPath way;
  way.waypoints_N = {Vector3::Zero(), Vector3(0, 0, 0.02), Vector3(0.05, 0, 0.02),
                     Vector3(0.05, 0, 0.42)};
  const SplitPath split = SplitAt(ToolPath(way, X_NE), X_NE, 0.03);
  REQUIRE(split.first.size() == 2);
  CHECK(split.first[1].translation().isApprox(Vector3(0.11, 0.2, 0.04), kExact));
  REQUIRE(split.rest.size() == 2);
  CHECK(split.rest[0].translation().isApprox(Vector3(0.15, 0.2, 0.04), kExact));
}

TEST_CASE("Nothing is weighed with a tilted tool", "[unit]") {
  const RigidTransform X_NE = Down({0, 0, 0.02});
  const SplitPath split = SplitAt(ToolPath(Tilted(), X_NE), X_NE, 0.03);
  CHECK(split.first.size() == 3);
  CHECK(split.rest.empty());
  ObjectPath back = Tilted();
  back.waypoints_N.push_back(Vector3(0, 0, 0.4));
  back.waypoints_N.push_back(Vector3(0, 0, 0.5));
  back.rotations_N.push_back(About(Vector3::UnitY(), 0));
  back.rotations_N.push_back(About(Vector3::UnitY(), 0));
  const SplitPath later = SplitAt(ToolPath(back, X_NE), X_NE, 0.03);
  CHECK(later.first.size() == 3);
  CHECK(later.rest.size() == 1);
}

}  // namespace
}  // namespace tubetwin

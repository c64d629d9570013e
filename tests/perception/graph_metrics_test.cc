#include "tests/support/graph_metrics.h"

#include "tests/support/catch.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

TubeScene SceneOf(const std::vector<Polyline>& lines_N) {
  TubeScene scene;
  for (const Polyline& line : lines_N) {
    PerceivedTube tube;
    tube.id = static_cast<int>(scene.tubes.size());
    tube.centerline_N = line;
    tube.radius_m = kRadius;
    tube.node_visible.assign(line.size(), 1);
    scene.tubes.push_back(tube);
  }
  AssignClasses(scene, kRadius);
  return scene;
}

/// Points on top of the lines, those within `hide_m` of the z axis left out.
std::vector<TubePoint> TopOf(const std::vector<Polyline>& lines_N, double hide_m) {
  std::vector<TubePoint> out;
  for (std::size_t t = 0; t < lines_N.size(); ++t) {
    for (const Vector3& p : Resample(lines_N[t], 0.0005)) {
      if (p.head<2>().norm() < hide_m) continue;
      out.push_back({p + Vector3(0, 0, kRadius), static_cast<int>(t)});
    }
  }
  return out;
}

/// Two tubes that cross at the origin, the second one on top.
const std::vector<Polyline> kCross = {{{-0.2, 0, 0.0125}, {0.2, 0, 0.0125}},
                                      {{0, -0.2, 0.0375}, {0, 0.2, 0.0375}}};

struct Scores {
  TubeScore tubes;
  CrossingScore crossings;
  JointScore joints;
  CenterlineErrors errors;
};

Scores ScoreAll(const std::vector<Polyline>& perceived, double hide_m) {
  const TubeScene scene = SceneOf(perceived);
  const auto points = TopOf(kCross, hide_m);
  const auto seen = FindSeen(kCross, points);
  Scores out;
  out.tubes = ScoreTubes(scene, kCross, points, kRadius);
  out.crossings = ScoreCrossings(scene, kCross, seen, out.tubes, kRadius);
  out.joints = ScoreJoints(scene, kCross, seen);
  out.errors = MeasureErrors(scene, kCross, seen, out.tubes);
  return out;
}

TEST_CASE("A crossing in sight is visible, one behind something wide is hidden", "[unit]") {
  const Scores open = ScoreAll(kCross, 0.0);
  CHECK(open.crossings.visible == 1);
  CHECK(open.crossings.visible_right == 1);
  CHECK(open.crossings.hidden == 0);
  CHECK(open.joints.truth == 0);
  const Scores hidden = ScoreAll(kCross, 0.06);
  CHECK(hidden.crossings.hidden == 1);
  CHECK(hidden.crossings.hidden_right == 1);
  CHECK(hidden.crossings.on_unseen_end == 0);
  CHECK(hidden.crossings.visible == 0);
  CHECK(hidden.joints.truth == 2);
  CHECK(hidden.joints.perceived == 2);
  CHECK(hidden.joints.right == 2);
  CHECK(hidden.errors.seen_m.size() > 50);
  CHECK(hidden.errors.hidden_m.size() > 20);
}

TEST_CASE("A hidden crossing with nothing seen beyond it lies on an unseen end", "[unit]") {
  auto points = TopOf(kCross, 0.0);
  std::erase_if(points, [](const TubePoint& p) { return p.tube == 0 && p.p_N.x() > -0.08; });
  const TubeScene scene = SceneOf(kCross);
  const CrossingScore score = ScoreCrossings(scene, kCross, FindSeen(kCross, points),
                                             ScoreTubes(scene, kCross, points, kRadius), kRadius);
  CHECK(score.hidden == 1);
  CHECK(score.on_unseen_end == 1);
  CHECK(score.on_unseen_end_right == 1);
}

TEST_CASE("Tubes perceived in the wrong order make a reversed crossing", "[unit]") {
  // Bent near the crossing only, so that most points still pair the tubes.
  const Polyline raised = {
      {-0.2, 0, 0.0125}, {-0.05, 0, 0.0125}, {0, 0, 0.06}, {0.05, 0, 0.0125}, {0.2, 0, 0.0125}};
  const Scores score = ScoreAll({raised, kCross[1]}, 0.0);
  REQUIRE(score.tubes.paired == 2);
  CHECK(score.crossings.visible == 1);
  CHECK(score.crossings.visible_right == 0);
  CHECK(score.crossings.visible_reversed == 1);
  CHECK(score.crossings.spurious == 0);
}

TEST_CASE("Partners exchanged behind the occluder are wrong joints, none right", "[unit]") {
  const Scores score = ScoreAll({{{-0.2, 0, 0.0125}, {0, 0, 0.02}, {0, 0.2, 0.0375}},
                                 {{0.2, 0, 0.0125}, {0, 0, 0.02}, {0, -0.2, 0.0375}}},
                                0.06);
  CHECK(score.joints.truth == 2);
  CHECK(score.joints.perceived == 2);
  CHECK(score.joints.right == 0);
  CHECK(score.tubes.found == 0);
  CHECK(score.errors.seen_m.empty());
}

TEST_CASE("A tube left in two pieces lacks a joint, an invented crossing is spurious", "[unit]") {
  const Scores split = ScoreAll(
      {{{-0.2, 0, 0.0125}, {-0.06, 0, 0.0125}}, {{0.06, 0, 0.0125}, {0.2, 0, 0.0125}}, kCross[1]},
      0.06);
  CHECK(split.joints.truth == 2);
  CHECK(split.joints.perceived == 1);
  CHECK(split.joints.right == 1);
  std::vector<Polyline> twice = kCross;
  twice[1] = {{0, -0.2, 0.0375}, {0, 0.2, 0.0375}, {0.15, 0.2, 0.0375}, {0.15, -0.1, 0.0375}};
  const Scores invented = ScoreAll(twice, 0.0);
  CHECK(invented.crossings.visible_right == 1);
  CHECK(invented.crossings.spurious == 1);
}

}  // namespace
}  // namespace tubetwin

#include <cmath>

#include "models/base/error.h"
#include "models/part.h"
#include "planner/evaluator/evaluator.h"
#include "planner/evaluator/rollout.h"
#include "planner/extraction/generators.h"
#include "tests/support/catch.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

CandidateScore Score(const TubeScene& scene, const CandidateMotion& motion, bool full = false,
                     double give_up_m = EvaluatorConfig().give_up_m) {
  EvaluatorOptions options;
  options.config.give_up_m = give_up_m;
  options.gripper = FirstGripper();
  EvaluationRequest request;
  request.candidates = {motion};
  request.grasp_at_m = {0.4 * Length(scene.tubes[0].centerline_N)};
  request.full = full;
  return MakeEvaluator(options)(scene, LoadPart("pvc_a"), Bin{}, request).candidates[0];
}

CandidateMotion Turned(const Vector3& pivot_N, const Vector3& axis,
                       const std::vector<double>& angles_deg) {
  CandidateMotion motion;
  motion.tube = 1;
  motion.name = "turned";
  motion.pivot_N = pivot_N;
  motion.waypoints_N = {Vector3::Zero()};
  motion.rotations_N = {Eigen::Quaterniond::Identity()};
  for (const double angle_deg : angles_deg) {
    motion.waypoints_N.emplace_back(0, 0, 0.4);
    motion.rotations_N.emplace_back(Eigen::AngleAxisd(Radians(angle_deg), axis));
  }
  return motion;
}

TEST_CASE("What rides along on the way up slides off a tube that is turned steeply", "[physics]") {
  const TubeScene scene = Balanced();
  int pitches = 0;
  for (const CandidateMotion& tip : MotionsOf({"tilt_and_shed"}, scene, scene.tubes[0]).motions) {
    if (tip.name != "pitch") continue;
    ++pitches;
    // What it displaces on the way is no reason to give up.
    const CandidateScore score = Score(scene, tip, false, 0.1);
    CHECK(score.status == CandidateScore::Status::kDone);
    CHECK_FALSE(score.lower_bound);
    CHECK(score.extra_probability == 0.0);
    CHECK(score.displacement_m < 0.4);
  }
  CHECK(pitches == 3);
}

TEST_CASE("A tube that is thrown out of the bin came along", "[physics]") {
  // Turned beside the wall instead of over the bin's middle, so that the other slides over it.
  const TubeScene scene = Balanced();
  CandidateMotion tip = Turned(Vector3(0, 0, kRadius), Vector3::UnitX(), {0.0, 0.0, -75.0, 0.0});
  for (std::size_t k = 2; k < tip.waypoints_N.size(); ++k) tip.waypoints_N[k].y() = 0.22;
  CHECK(Score(scene, tip, true).extra_probability == 1.0);

  // One that hung over the wall before and stays there did not.
  const double over_wall = Bin{}.wall_m() + kRadius;
  const TubeScene beside =
      PerfectScene({StraightLine({-0.25, 0.1, kRadius}, {-0.05, 0.1, kRadius}),
                    StraightLine({0.20, 0.20, kRadius}, {0.20, 0.42, over_wall + 0.02})},
                   kRadius);
  CandidateMotion up = Turned(Vector3::Zero(), Vector3::UnitX(), {0.0});
  up.waypoints_N = {Vector3::Zero(), {0, 0, 0.4}};
  CHECK(Score(beside, up, true).extra_probability == 0.0);
}

TEST_CASE("A roll-out does not end before a turn that comes down on others", "[physics]") {
  const TubeScene scene = PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                                        StraightLine({0.20, 0.10, kRadius}, {0.20, 0.25, kRadius})},
                                       kRadius);
  CandidateMotion dip = Turned(Vector3(0, 0, kRadius), Vector3::UnitY(), {0.0, 60.0, 0.0});
  // Over the second tube, half of it then goes down through where that lies.
  dip.waypoints_N = {Vector3::Zero(), {0, 0, 0.2}, {0.08, 0.17, 0.2}, {0.08, 0.17, 0.4}};
  const CandidateScore score = Score(scene, dip);
  CHECK(score.displacement_m > 0.02);
  dip.rotations_N.assign(4, Eigen::Quaterniond::Identity());
  CHECK(Score(scene, dip).displacement_m < 0.005);
}

TEST_CASE("A leg profile knows until when it is turned over", "[unit]") {
  const auto profile = [](const CandidateMotion& motion) {
    return LegProfile(motion.waypoints_N, 0.25, motion.rotations_N, 0.5);
  };
  const Vector3 origin = Vector3::Zero();
  const LegProfile tip = profile(Turned(origin, Vector3::UnitX(), {0, 60, 0}));
  CHECK(tip.TurnedOverUntil() == Approx(0.4 / 0.25 + 0.15 + Radians(60.0) / 0.5 + 0.15));
  CHECK(profile(Turned(origin, Vector3::UnitZ(), {0, 60, 0})).TurnedOverUntil() == 0.0);
  CHECK(LegProfile({origin, {0, 0, 0.4}}, 0.25).TurnedOverUntil() == 0.0);
}

TEST_CASE("The hand turns on beyond half a turn", "[physics]") {
  // Gripped at 80 degrees, turned by 160 more.
  const Vector3 centre(0, 0, kRadius), half(0.035, 0.197, 0.0);
  const TubeScene scene = PerfectScene({StraightLine(centre - half, centre + half)}, kRadius);
  const CandidateMotion turn = Turned(centre, Vector3::UnitZ(), {0.0, 80.0, 160.0});
  // The long way back would keep the drive at its limit: a jam.
  CHECK(Score(scene, turn, true).status == CandidateScore::Status::kDone);
}

TEST_CASE("A turn that the hand's hinges cannot follow is refused", "[unit]") {
  const TubeScene scene = Balanced();
  CHECK(Score(scene, Turned(Vector3::Zero(), Vector3::UnitX(), {0.0, 120.0, 0.0})).status !=
        CandidateScore::Status::kDiverged);
  CHECK_THROWS_AS(Score(scene, Turned(Vector3::Zero(), Vector3::UnitY(), {0.0, 85.0, 0.0})), Error);
  CandidateMotion short_of_one = Turned(Vector3::Zero(), Vector3::UnitX(), {0.0, 20.0});
  short_of_one.rotations_N.pop_back();
  CHECK_THROWS_AS(Score(scene, short_of_one), Error);
}

}  // namespace
}  // namespace tubetwin

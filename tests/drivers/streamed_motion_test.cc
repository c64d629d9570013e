// The conversation alone, against the controller's increment queue: no socket, no clock.

#include "hw_bridge/drivers/yaskawa/streamed_motion.h"

#include <cmath>

#include "hw_bridge/emulators/yaskawa/increment_queue.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;

constexpr double kAhead_s = 0.2;

JointVector Somewhere() {
  JointVector q;
  q << 0.1, 0.4, 1.5, 0.0, 0.25, 0.0;
  return q;
}

JointTrajectory AllJointsBy(double by_rad, double duration_s) {
  TrajectoryPoint a, b;
  a.q = Somewhere();
  b.q = a.q + by_rad * JointVector::Ones();
  b.time_s = duration_s;
  return {{a, b}};
}

/// One millisecond after another: asks, answers as the controller does, lets the queue run.
struct Exchange {
  Exchange(const JointTrajectory& trajectory, const JointVector& q_start)
      : motion(trajectory, q_start, PaperCell().arm, kAhead_s), q(q_start) {}

  sm::MotionReply Answer(const sm::Body& request) {
    sm::MotionReply reply;
    if (const auto* point = std::get_if<sm::JointPoint>(&request)) {
      reply.sequence = point->sequence;
      if (queue.in_process() || busy > 0) {
        busy = std::max(0, busy - 1);
        reply.result = sm::Result::kBusy;
        return reply;
      }
      const IncrementQueue::Point next{static_cast<std::int64_t>(point->time_s * 1000.0f),
                                       sm::ToJoints(point->q_rad), sm::ToJoints(point->qd_rad_s)};
      if (point->sequence == 0) {
        queue.Begin(next);
      } else {
        CHECK(next.time_ms > last_ms);
        CHECK(next.time_ms - last_ms <= 40);
        queue.Add(next);
      }
      last_ms = next.time_ms;
      return reply;
    }
    const auto& control = std::get<sm::MotionControl>(request);
    if (control.command == sm::Command::kStopMotion) queue.Clear();
    reply.subcode = queue.size();
    return reply;
  }

  /// False: the motion is over, or has a problem.
  bool Step() {
    if (const auto request = motion.Next(now_s)) {
      if (const auto trouble = motion.Take(*request, Answer(*request), now_s)) {
        problem = trouble->text;
        return false;
      }
    }
    queue.Cut();
    most = std::max(most, queue.size());
    if (runs) {
      if (const auto reference = queue.Next(q, rate)) {
        q = reference->q;
        fastest_rad_s2 = std::max(fastest_rad_s2, reference->qdd.cwiseAbs().maxCoeff());
      }
    }
    now_s += 0.001;
    return !motion.over();
  }

  StreamedMotion motion;
  IncrementQueue queue;
  JointVector q;
  bool runs = true;
  double rate = 1.0;
  int busy = 0, most = 0;
  std::int64_t last_ms = 0;
  double now_s = 10.0, fastest_rad_s2 = 0.0;
  std::string problem;
};

TEST_CASE("A streamed motion runs as planned, no more than its lead ahead", "[unit]") {
  const double duration_s = GENERATE(0.003, 0.0404, 0.7, 1.2345);
  CAPTURE(duration_s);
  const JointTrajectory planned = AllJointsBy(0.3 * duration_s * duration_s, duration_s);
  Exchange exchange(planned, Somewhere());
  double worst_rad = 0.0, begin_s = 0.0;
  while (exchange.Step()) {
    REQUIRE(exchange.now_s < 15.0);
    if (begin_s == 0.0 && !exchange.queue.empty()) begin_s = exchange.now_s;
    const JointVector at = Sample(planned, exchange.now_s - begin_s).q;
    // Within a few milliseconds of it in time.
    if (begin_s > 0.0) worst_rad = std::max(worst_rad, (exchange.q - at).cwiseAbs().maxCoeff());
  }
  CHECK(exchange.problem.empty());
  CHECK_FALSE(exchange.motion.stopped());
  CHECK((exchange.q - planned.points.back().q).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(worst_rad < 0.006);
  CHECK(exchange.most * 4 <= 1000 * kAhead_s + 40 + 8);
  CHECK(exchange.now_s - begin_s < duration_s + 0.15);
}

TEST_CASE("A start beside the path is led onto it", "[unit]") {
  const JointTrajectory planned = AllJointsBy(0.3, 1.0);
  Exchange exchange(planned, Somewhere() + 0.003 * JointVector::Ones());
  while (exchange.Step()) REQUIRE(exchange.now_s < 15.0);
  CHECK((exchange.q - planned.points.back().q).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(exchange.fastest_rad_s2 < 3.0);
}

TEST_CASE("Points that find the controller busy come again unchanged", "[unit]") {
  Exchange exchange(AllJointsBy(0.3, 1.0), Somewhere());
  for (int i = 0; exchange.Step(); ++i) {
    if (i % 100 == 0) exchange.busy = 3;
    REQUIRE(exchange.now_s < 15.0);
  }
  CHECK(exchange.problem.empty());
  CHECK((exchange.q - AllJointsBy(0.3, 1.0).points.back().q).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("A ramp ends on the path, within half of the acceleration limits and little more",
          "[unit]") {
  const double at_s = GENERATE(0.2, 0.9, 1.5);
  CAPTURE(at_s);
  const JointTrajectory planned = AllJointsBy(1.0, 2.0);
  Exchange exchange(planned, Somewhere());
  while (exchange.now_s < 10.0 + at_s) REQUIRE(exchange.Step());
  const double before_rad_s2 = exchange.fastest_rad_s2;
  exchange.motion.Stop(StopKind::kOnPath, JointVector::Ones());
  CHECK(exchange.motion.stopped());
  while (exchange.Step()) REQUIRE(exchange.now_s < 15.0);
  CHECK(exchange.problem.empty());
  CHECK(exchange.q[0] < planned.points.back().q[0] - 0.01);
  // Along one direction: all joints have gone as far.
  const JointVector way = exchange.q - Somewhere();
  CHECK((way - way[0] * JointVector::Ones()).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(exchange.motion.stream().NearestTime(exchange.q, exchange.now_s - 10.0) ==
        Approx(exchange.motion.Progress_s(exchange.now_s)).margin(0.003));
  const double limit_rad_s2 = PaperCell().arm.joints[0].max_acceleration_rad_s2;
  CHECK(exchange.fastest_rad_s2 < std::max(before_rad_s2, limit_rad_s2));
}

TEST_CASE("A stop before anything moves is a stop at once", "[unit]") {
  Exchange exchange(AllJointsBy(0.3, 1.0), Somewhere());
  exchange.motion.Stop(StopKind::kOnPath, JointVector::Zero());
  CHECK(exchange.motion.StopDue());
  while (exchange.Step()) REQUIRE(exchange.now_s < 11.0);
  CHECK(exchange.motion.halted());
  CHECK(exchange.q == Somewhere());
}

TEST_CASE("An arm that is held back is not given more, and is told as held back", "[unit]") {
  Exchange exchange(AllJointsBy(0.3, 2.0), Somewhere());
  while (exchange.now_s < 10.5) REQUIRE(exchange.Step());
  CHECK_FALSE(exchange.motion.held_back());
  exchange.runs = false;
  while (exchange.now_s < 12.0) REQUIRE(exchange.Step());
  CHECK(exchange.motion.held_back());
  CHECK(exchange.most * 4 <= 1000 * (kAhead_s + 0.1) + 40 + 8);
  exchange.runs = true;
  while (exchange.Step()) REQUIRE(exchange.now_s < 15.0);
  CHECK_FALSE(exchange.motion.held_back());
  CHECK((exchange.q - AllJointsBy(0.3, 2.0).points.back().q).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("A controller that limits the speed holds the arm back, from a quarter on", "[unit]") {
  const auto [rate, held] = GENERATE(table<double, bool>({{0.9, false}, {0.6, true}, {0.2, true}}));
  CAPTURE(rate);
  Exchange exchange(AllJointsBy(0.3, 2.0), Somewhere());
  while (exchange.now_s < 10.5) REQUIRE(exchange.Step());
  exchange.rate = rate;
  while (exchange.now_s < 11.4) {
    REQUIRE(exchange.Step());
    if (rate > 0.8) REQUIRE_FALSE(exchange.motion.held_back());
  }
  CHECK(exchange.motion.held_back() == held);
  CHECK(exchange.most * 4 <= 1000 * (kAhead_s + 0.1) + 40 + 8);
  exchange.rate = 1.0;
  while (exchange.Step()) REQUIRE(exchange.now_s < 25.0);
  CHECK(exchange.problem.empty());
  CHECK_FALSE(exchange.motion.held_back());
  CHECK((exchange.q - AllJointsBy(0.3, 2.0).points.back().q).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("A controller that has run dry on the way is a problem", "[unit]") {
  Exchange exchange(AllJointsBy(0.3, 2.0), Somewhere());
  while (exchange.now_s < 10.5) REQUIRE(exchange.Step());
  while (!exchange.queue.empty()) exchange.queue.Next(exchange.q);
  exchange.now_s += 0.2;  // The link was away.
  while (exchange.Step()) REQUIRE(exchange.now_s < 15.0);
  CHECK_THAT(exchange.problem, Catch::Matchers::Contains("ran out of points"));
}

TEST_CASE("What is appended is streamed on, at rest or before", "[unit]") {
  const double at_s = GENERATE(0.05, 0.39, 0.49);
  CAPTURE(at_s);
  Exchange exchange(AllJointsBy(0.05, 0.4), Somewhere());
  while (exchange.now_s < 10.0 + at_s) exchange.Step();
  JointTrajectory back = AllJointsBy(0.05, 0.4);
  std::swap(back.points.front().q, back.points.back().q);
  exchange.motion.Append(back);
  CHECK_FALSE(exchange.motion.over());
  while (exchange.Step()) REQUIRE(exchange.now_s < 15.0);
  CHECK(exchange.problem.empty());
  CHECK((exchange.q - Somewhere()).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(exchange.motion.Progress_s(exchange.now_s) == Approx(0.8));
}

}  // namespace
}  // namespace tubetwin::test

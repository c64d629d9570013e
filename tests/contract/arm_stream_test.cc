// Streamed through driver, loopback and emulated controller, a trajectory moves the twin's arm as
// the twin's own trajectory does. `contract_arm_tests [measure]` prints the figures.

#include <cstdio>
#include <random>

#include "tests/contract/arm_rigs.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

constexpr double kAllowed_mm = 0.5;
/// The clocks of two cells begin together within that many periods.
constexpr int kMostShift = 3;

Vector3 Fingers(const Cell& cell, const JointVector& q) {
  return (FlangePose(cell.model.arm, q) * cell.model.layout.X_FE).translation();
}

/// Largest distance of the fingers at equal times, for the best common beginning.
double Apart_mm(const Cell& cell, const std::vector<JointVector>& a,
                const std::vector<JointVector>& b) {
  double least_mm = 1e9;
  for (int shift = -kMostShift; shift <= kMostShift; ++shift) {
    double worst_mm = 0.0;
    const int size = static_cast<int>(std::min(a.size(), b.size())) - kMostShift;
    for (int i = kMostShift; i < size; ++i) {
      const Vector3 apart = Fingers(cell, a[i]) - Fingers(cell, b[i + shift]);
      worst_mm = std::max(worst_mm, 1e3 * apart.norm());
    }
    least_mm = std::min(least_mm, worst_mm);
  }
  return least_mm;
}

struct Figures {
  double apart_mm = 0.0;    ///< At equal times.
  double end_mm = 0.0;      ///< Where both stand afterwards.
  double duration_s = 0.0;  ///< Planned.
  double longer_s = 0.0;    ///< By that the streamed one lasted longer, as the drives moved.
};

/// One trajectory in both cells.
Figures Compare(Bench& own, DriverArmRig& streamed, const CheckedTrajectory& trajectory) {
  Cell& cell = own.cell();
  std::vector<JointVector> track;
  REQUIRE(cell.arm.Start(trajectory).accepted());
  while (cell.arm.State().mode == ArmMode::kMoving) {
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
    track.push_back(own.impl().arm.TruePosition());
  }
  REQUIRE(cell.arm.State().done);

  Cell& other = streamed.cell();
  streamed.TakeTrack();
  const CommandResult started = other.arm.Start(trajectory);
  INFO(started.reason);
  REQUIRE(started.accepted());
  while (other.arm.State().mode == ArmMode::kMoving) Wait(other, 0.005);
  INFO(other.arm.State().fault);
  REQUIRE(other.arm.State().done);
  const std::vector<JointVector> streamed_track = streamed.TakeTrack();
  REQUIRE(streamed_track.size() > 2 * kMostShift);
  Figures figures;
  figures.apart_mm = Apart_mm(cell, track, streamed_track);
  figures.end_mm =
      1e3 * (Fingers(cell, track.back()) - Fingers(cell, streamed_track.back())).norm();
  figures.duration_s = trajectory.duration_s();
  figures.longer_s =
      1e-3 * (static_cast<double>(streamed_track.size()) - static_cast<double>(track.size()));
  Wait(cell, 0.1);
  Wait(other, 0.1);
  return figures;
}

/// A line of the tool, vertical, to a random place over the bin, at a random speed.
CheckedTrajectory SomeLine(Bench& own, std::mt19937& random) {
  std::uniform_real_distribution<double> x(0.50, 0.75), y(-0.2, 0.2), z(0.35, 0.55), v(0.1, 0.9);
  MotionOptions options;
  options.speed_m_s = v(random);
  return own.Line(own.Down({x(random), y(random), z(random)}), options);
}

TEST_CASE("A streamed trajectory moves the arm as the twin's own does, within 0.5 mm",
          "[contract]") {
  Bench own(TubeAside());
  DriverArmRig streamed;
  std::mt19937 random(11);
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i);
    const Figures figures = Compare(own, streamed, SomeLine(own, random));
    CHECK(figures.apart_mm < kAllowed_mm);
    CHECK(figures.end_mm < kAllowed_mm);
    CHECK(std::abs(figures.longer_s) < 0.02);
  }
}

TEST_CASE("Figures of streamed trajectories against the twin's own", "[.][measure]") {
  constexpr int kMotions = 40;
  Bench own(TubeAside());
  DriverArmRig streamed;
  std::mt19937 random(12);
  double apart_mm = 0.0, end_mm = 0.0, sum_mm = 0.0, moved_s = 0.0, longer_s = 0.0;
  for (int i = 0; i < kMotions; ++i) {
    const Figures figures = Compare(own, streamed, SomeLine(own, random));
    apart_mm = std::max(apart_mm, figures.apart_mm);
    sum_mm += figures.apart_mm;
    end_mm = std::max(end_mm, figures.end_mm);
    moved_s += figures.duration_s;
    longer_s = std::max(longer_s, std::abs(figures.longer_s));
  }
  std::printf(
      "%d motions, %.1f s: apart at most %.4f mm (mean of each motion's most %.4f), "
      "ends %.4f mm, durations %.0f ms; %d points came again for BUSY\n",
      kMotions, moved_s, apart_mm, sum_mm / kMotions, end_mm, 1e3 * longer_s,
      streamed.busy_answers());
  CHECK(apart_mm < kAllowed_mm);
}

}  // namespace
}  // namespace tubetwin::test

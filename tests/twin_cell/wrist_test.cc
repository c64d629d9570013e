#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/twin_cell/cell_fixture.h"
#include "twin/cell/twin_wrist.h"

namespace tubetwin::test {
namespace {

constexpr double kHalfCount_N = 0.5 / 40.0;
constexpr double kHalfCount_Nm = 0.5 * 10.0 / 13333.0;

RoundPhysics Quiet() {
  RoundPhysics physics;
  physics.wrench_noise_counts = 0.0;
  physics.wrench_bias_walk_N = 0.0;
  physics.wrench_cross_talk = 0.0;
  return physics;
}

/// The chain's answer to a constant load once the low-pass has settled.
WrenchSample Settled(const RoundPhysics& physics, const Wrench& load) {
  WrenchChain chain(PaperCell().wrist, physics, RandomStream(1, 0, "wrench"));
  WrenchSample sample;
  for (int i = 0; i < 100; ++i) sample = chain.Next(load, kControlPeriod * i);
  return sample;
}

}  // namespace

TEST_CASE("a hanging mass reads as its weight along z out of the tool") {
  const Pile pile = OneTube("pvc_a", Vector3(0, 0, 0.0125));
  Bench bench(pile, NominalOptions(pile, true));
  Wait(bench.cell(), 0.5);
  const Wrench empty = AverageWrench(bench.cell(), 0.2).mean_K;
  const double tool_N =
      (PaperCell().gripper.mass_kg + PaperCell().gripper.coupling_mass_kg) * kGravity;
  CHECK(empty.force_N.z() == Approx(tool_N).margin(kHalfCount_N));
  CHECK(std::abs(empty.force_N.x()) < 0.02);
  CHECK(std::abs(empty.force_N.y()) < 0.02);
}

TEST_CASE("a held tube adds its weight and the torque of its centre of mass") {
  // Held a quarter of its length from the middle: the heavy side lies towards N's +x.
  const double radius_m = LoadPart("pvc_a").radius_m;
  const Pile pile = OneTube("pvc_a", Vector3(0.125, 0, radius_m));
  Bench bench(pile, NominalOptions(pile, true));
  RigidTransform X_BE = bench.Down(pile.bin.X_BN * Vector3(0, 0, 0.4));
  bench.MoveLine(X_BE);
  Wait(bench.cell(), 0.5);
  const Wrench empty = AverageWrench(bench.cell(), 0.2).mean_K;
  REQUIRE(bench.GraspAt(Vector3(0, 0, radius_m)).object == GripperObject::kContactClosing);
  bench.MoveLine(X_BE);
  Wait(bench.cell(), 1.0);
  const Wrench load = AverageWrench(bench.cell(), 0.2).mean_K - empty;
  const double weight_N = pile.part.mass_kg * kGravity;
  CHECK(load.force_N.z() == Approx(weight_N).margin(2 * kHalfCount_N));
  // Torque about K's origin: p_KC x weight; all in K, whose axes E shares.
  const CellWorld& world = bench.impl().world;
  const Vector3 p_BC = world.tubes()[0].CentreOfMass_W(world.model(), world.data());
  const CellLayout& layout = bench.cell().model.layout;
  const RigidTransform X_BK = bench.X_BE() * layout.X_FE.inverse() * layout.X_FK;
  const Vector3 expected_Nm =
      (X_BK.inverse() * p_BC).cross(X_BK.linear().transpose() * Vector3(0, 0, -weight_N));
  CHECK(expected_Nm.norm() > 0.05);
  // Closing moves the fingers' own weight along z only; counts of two averages remain.
  for (int k = 0; k < 3; ++k) {
    CHECK(load.torque_Nm[k] == Approx(expected_Nm[k]).margin(4 * kHalfCount_Nm));
  }
}

TEST_CASE("readings come in counts and follow the load within half a count") {
  const Wrench load{Vector3(1.234, -2.345, 10.1), Vector3(0.1234, -0.4567, 0.0101)};
  const WrenchSample sample = Settled(Quiet(), load);
  CHECK_FALSE(sample.saturated);
  for (int k = 0; k < 3; ++k) {
    const double count_N = k == 2 ? 1.0 / 40.0 : 1.0 / 80.0, count_Nm = 10.0 / 13333.0;
    const double force = sample.wrench_K.force_N[k], torque = sample.wrench_K.torque_Nm[k];
    CHECK(force == Approx(load.force_N[k]).margin(0.51 * count_N));
    CHECK(torque == Approx(load.torque_Nm[k]).margin(0.51 * count_Nm));
    CHECK(force / count_N == Approx(std::round(force / count_N)).margin(1e-6));
    CHECK(torque / count_Nm == Approx(std::round(torque / count_Nm)).margin(1e-6));
  }
}

TEST_CASE("loads beyond the range are clamped to it and flagged") {
  const WrenchSample z = Settled(Quiet(), {Vector3(0, 0, 250), Vector3::Zero()});
  CHECK(z.saturated);
  CHECK(z.wrench_K.force_N.z() == Approx(200.0));
  const WrenchSample x = Settled(Quiet(), {Vector3(-70, 0, 0), Vector3::Zero()});
  CHECK(x.saturated);
  CHECK(x.wrench_K.force_N.x() == Approx(-65.0));
  const WrenchSample torque = Settled(Quiet(), {Vector3::Zero(), Vector3(0, 6, 0)});
  CHECK(torque.saturated);
  CHECK(torque.wrench_K.torque_Nm.y() <= 5.0);
  CHECK(torque.wrench_K.torque_Nm.y() > 4.999);
  CHECK_FALSE(Settled(Quiet(), {Vector3(64, 0, 199), Vector3::Zero()}).saturated);
}

TEST_CASE("white noise has one count of deviation and repeats with its stream") {
  RoundPhysics physics = Quiet();
  physics.wrench_noise_counts = 1.0;
  WrenchChain chain(PaperCell().wrist, physics, RandomStream(5, 2, "wrench"));
  WrenchChain same(PaperCell().wrist, physics, RandomStream(5, 2, "wrench"));
  WrenchChain other(PaperCell().wrist, physics, RandomStream(5, 3, "wrench"));
  constexpr int kSamples = 4000;
  double sum = 0.0, squares = 0.0;
  int equal_to_other = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double z = chain.Next({}, kControlPeriod * i).wrench_K.force_N.z();
    CHECK(z == same.Next({}, kControlPeriod * i).wrench_K.force_N.z());
    equal_to_other += z == other.Next({}, kControlPeriod * i).wrench_K.force_N.z() ? 1 : 0;
    sum += z;
    squares += z * z;
  }
  const double deviation_N = std::sqrt(squares / kSamples - std::pow(sum / kSamples, 2));
  // One count and a twelfth of a count squared for rounding; 4000 samples are good to 5 %.
  CHECK(deviation_N == Approx(std::sqrt(1.0 + 1.0 / 12.0) / 40.0).epsilon(0.05));
  CHECK(equal_to_other < kSamples / 2);
}

TEST_CASE("bias walks as far as the round's physics says") {
  RoundPhysics physics = Quiet();
  physics.wrench_bias_walk_N = 10.0;             // Exaggerated against the counts.
  constexpr int kStreams = 60, kSamples = 6000;  // A hundredth of ten minutes.
  double squares = 0.0;
  for (int s = 0; s < kStreams; ++s) {
    WrenchChain chain(PaperCell().wrist, physics, RandomStream(9, s, "wrench"));
    WrenchSample last;
    for (int i = 0; i < kSamples; ++i) last = chain.Next({}, kControlPeriod * i);
    squares += std::pow(last.wrench_K.force_N.z(), 2) / kStreams;
  }
  // A tenth of the deviation; of 60 streams it is known to 9 %, three times that is allowed.
  CHECK(std::sqrt(squares) == Approx(1.0).epsilon(0.28));
}

TEST_CASE("cross-talk stays below its share of full scale and is the same all round") {
  RoundPhysics physics = Quiet();
  physics.wrench_cross_talk = 0.01;
  const WrenchSample sample = Settled(physics, {Vector3(0, 0, 200), Vector3::Zero()});
  const Vector3 force = sample.wrench_K.force_N, torque = sample.wrench_K.torque_Nm;
  CHECK(std::abs(force.x()) <= 0.65 + kHalfCount_N);
  CHECK(std::abs(force.y()) <= 0.65 + kHalfCount_N);
  CHECK(torque.cwiseAbs().maxCoeff() <= 0.05 + kHalfCount_Nm);
  CHECK(force.head<2>().norm() > 0.02);  // It is there.
  const WrenchSample again = Settled(physics, {Vector3(0, 0, 200), Vector3::Zero()});
  CHECK(again.wrench_K.force_N == force);
}

}  // namespace tubetwin::test

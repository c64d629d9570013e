#include "tests/contract/wrist_contract.h"

#include <cmath>

#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

const Vector3 kCount_N(1.0 / 80.0, 1.0 / 80.0, 1.0 / 40.0);
constexpr double kCount_Nm = 10.0 / 13333.0;
/// Newton metres are rounded once more on the wire, to 1e-6.
constexpr double kWire = 1e-6;
/// A sample older than this is not the newest one of a sensor of 7000 to 100 Hz.
constexpr TimeNs kOldest = std::chrono::milliseconds(25);

WrenchSample Settled(Cell& cell) {
  Wait(cell, 0.5);
  return cell.wrist.Read();
}

double CountsOff(double value, double count) {
  return std::abs(value - count * std::round(value / count));
}

}  // namespace

void CheckWristTimes(WristContractRig& rig) {
  Cell& cell = rig.cell();
  TimeNs newest = cell.wrist.Read().time;
  int young = 0, newer = 0;
  constexpr int kReads = 200;
  for (int i = 0; i < kReads; ++i) {
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
    const WrenchSample sample = cell.wrist.Read();
    const TimeNs now = cell.clock.Now();
    CHECK(sample.time >= newest);
    CHECK(sample.time <= now);
    young += now - sample.time < kOldest ? 1 : 0;
    newer += sample.time > newest ? 1 : 0;
    newest = sample.time;
  }
  // A busy host may be late for some.
  CHECK(young > kReads * 3 / 4);
  CHECK(newer > kReads / 4);
}

void CheckWristReads(WristContractRig& rig) {
  Cell& cell = rig.cell();
  const WrenchSample empty = Settled(cell);
  CHECK_FALSE(empty.saturated);
  // Whoever has read before: nobody has tared it.
  CHECK(std::abs(empty.wrench_K.force_N.z() - rig.tool_weight_N()) <= kCount_N.z());
  for (const Vector3& force_K : {Vector3(0, 0, 20), Vector3(0, 0, -20), Vector3(15, 0, 0),
                                 Vector3(0, -12, 0), Vector3(3, 4, 5), Vector3(0, 0, 0)}) {
    CAPTURE(force_K.transpose());
    const Wrench load = rig.Pull(force_K);
    const WrenchSample sample = Settled(cell);
    CHECK_FALSE(sample.saturated);
    const Wrench more = sample.wrench_K - empty.wrench_K;
    for (int k = 0; k < 3; ++k) {
      CAPTURE(k);
      // The arm gives way a little, so the weight turns: a thousandth of it for each 10 N.
      CHECK(std::abs(more.force_N[k] - load.force_N[k]) < 1.5 * kCount_N[k] + 0.03);
      CHECK(std::abs(more.torque_Nm[k] - load.torque_Nm[k]) < 1.5 * kCount_Nm + 0.005);
      CHECK(CountsOff(sample.wrench_K.force_N[k], kCount_N[k]) < kWire);
      CHECK(CountsOff(sample.wrench_K.torque_Nm[k], kCount_Nm) < kWire);
    }
  }
}

void CheckWristSaturates(WristContractRig& rig) {
  Cell& cell = rig.cell();
  CHECK_FALSE(Settled(cell).saturated);
  rig.Pull({80, 0, 0});
  const WrenchSample beyond = Settled(cell);
  CHECK(beyond.saturated);
  CHECK(beyond.wrench_K.force_N.x() == Approx(65.0));
  CHECK(beyond.wrench_K.torque_Nm.cwiseAbs().maxCoeff() <= 5.0);
  rig.Pull({-80, 0, 0});
  CHECK(Settled(cell).wrench_K.force_N.x() == Approx(-65.0));
  CHECK(cell.wrist.Read().saturated);
  rig.Pull({0, 0, 0});
  const WrenchSample empty = Settled(cell);
  CHECK_FALSE(empty.saturated);
  CHECK(std::abs(empty.wrench_K.force_N.z() - rig.tool_weight_N()) <= 2 * kCount_N.z());
}

}  // namespace tubetwin::test

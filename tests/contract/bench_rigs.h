#pragma once

#include <asio.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "hw_bridge/cell/wall_clock.h"
#include "hw_bridge/emulators/emulator.h"
#include "scenes/engine/mj_handles.h"
#include "tests/drivers/served_arm.h"
#include "tests/support/paper_cell.h"
#include "tests/twin_cell/cell_fixture.h"
#include "twin/cell/arm_body.h"
#include "twin/cell/gripper_body.h"

namespace tubetwin::test {

/// A bench whose fingers stand open around a tube, or high over the bin: the rigs' common world.
/// Its own devices, `cell()`, and what somebody sees who stands by.
class RigWorld {
 public:
  explicit RigWorld(bool around_tube)
      : bench_(OneTube("pvc_a", Vector3(0, 0, Radius())), Options()) {
    if (!around_tube) return;
    bench_.GraspAt(Vector3(0, 0, Radius()));
    MoveGripper(bench_.cell(), {0.085, 0.15, 60.0});
  }
  Cell& cell() { return bench_.cell(); }
  TwinCell::Impl& impl() { return bench_.impl(); }
  static double Radius() { return LoadPart("pvc_a").radius_m; }

  void TakeTubeAway() {
    mjData& data = impl().world.data();
    const int joint = IdOf(impl().world.model(), mjOBJ_JOINT, "tube3_free");
    data.qpos[impl().world.model().jnt_qposadr[joint] + 2] += 1.0;
  }
  double PadForce_N() {
    const mjModel& model = impl().world.model();
    const mjData& data = impl().world.data();
    const int pad = IdOf(model, mjOBJ_GEOM, kPadLeftGeom);
    double sum_N = 0.0;
    for (int i = 0; i < data.ncon; ++i) {
      if (data.contact[i].geom[0] != pad && data.contact[i].geom[1] != pad) continue;
      mjtNum force[6];
      mj_contactForce(&model, &data, i, force);
      sum_N += force[0];
    }
    return sum_N;
  }
  Wrench Pull(const Vector3& force_K) {
    const mjModel& model = impl().world.model();
    mjData& data = impl().world.data();
    const int site = IdOf(model, mjOBJ_SITE, kWristSite), body = model.site_bodyid[site];
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WK(data.site_xmat +
                                                                              9 * site);
    const Vector3 p_WK(data.site_xpos + 3 * site), p_WC(data.xipos + 3 * body);
    Eigen::Map<Vector3>(data.xfrc_applied + 6 * body) = R_WK * force_K;
    return {force_K, (R_WK.transpose() * (p_WC - p_WK)).cross(force_K)};
  }
  static double ToolWeight_N() {
    return (PaperCell().gripper.mass_kg + PaperCell().gripper.coupling_mass_kg) * kGravity;
  }

 private:
  static TwinCellOptions Options() {
    return NominalOptions(OneTube("pvc_a", Vector3(0, 0, Radius())), true);
  }
  Bench bench_;
};

/// The same cell with other clock, gripper and sensor.
inline Cell With(Cell& cell, CellClock& clock, Gripper& gripper, ForceTorqueSensor& wrist) {
  return {clock, cell.arm, gripper, wrist, cell.scanner, cell.model, cell.bin, SafetyLimits()};
}

/// A world whose time runs by itself, with one emulator before it.
template <typename EmulatorType>
class ServedWorld {
 public:
  /// `make(io, impl)`: the emulator.
  template <typename Make>
  ServedWorld(bool around_tube, Make make)
      : world_(around_tube),
        emulator_(make(io_, world_.impl())),
        thread_(1.0, mutex_, [this, before = world_.cell().clock.Now()](TimeNs now) {
          io_.poll();
          world_.cell().clock.AdvanceTo(before + now);
          emulator_->Tick(before + now);
        }) {}
  /// Between two periods.
  template <typename Script>
  auto Do(Script script) {
    const std::lock_guard lock(mutex_);
    return script(world_);
  }
  EmulatorType& emulator() { return *emulator_; }  ///< For what never changes: its ports.

 private:
  asio::io_context io_;
  RigWorld world_;
  std::unique_ptr<EmulatorType> emulator_;
  std::mutex mutex_;
  PacedThread thread_;
};

}  // namespace tubetwin::test

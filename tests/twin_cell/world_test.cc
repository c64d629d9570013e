#include <cmath>

#include "scenes/engine/engine_error.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/twin_cell/cell_fixture.h"
#include "twin/cell/truth.h"
#include "twin/render/scan/ray_scene.h"

namespace tubetwin::test {
namespace {

/// Small and quick: what is tested is who sees what from where.
TwinCellOptions ScanOptions(const Pile& pile) {
  TwinCellOptions options = NominalOptions(pile);
  options.scan.width = 258;
  options.scan.height = 193;
  options.scan.labels = true;
  return options;
}

}  // namespace

TEST_CASE("a tube on the tray lies still and counts as there") {
  const CellLayout layout = PaperCell().layout;
  Pile pile = OneTube("pvc_a", Vector3::Zero());
  const Vector3 p_NT = pile.bin.X_BN.inverse() * layout.X_BT.translation();
  pile = OneTube("pvc_a", p_NT + Vector3(0, 0, 0.013));
  TakeEngineWarnings();
  Bench bench(pile);
  Wait(bench.cell(), 1.0);
  const Truth::Tube early = Truth(bench.twin()).Tubes().at(0);
  CHECK(early.id == 3);
  CHECK(early.over_tray);
  CHECK_FALSE(early.over_bin);
  CHECK_FALSE(early.hangs);
  CHECK_FALSE(early.outside);
  CHECK(early.speed_m_s < 1e-3);
  Wait(bench.cell(), 5.0);
  const Truth::Tube late = Truth(bench.twin()).Tubes().at(0);
  CHECK((late.centre_of_mass_B - early.centre_of_mass_B).norm() < 1e-4);
  CHECK(TakeEngineWarnings().empty());
}

TEST_CASE("a tube that misses bin and tray is outside") {
  Pile pile = OneTube("pvc_a", Vector3(0.0, 0.55, 0.05));
  Bench bench(pile);
  Wait(bench.cell(), 1.5);
  const Truth::Tube tube = Truth(bench.twin()).Tubes().at(0);
  CHECK(tube.outside);
  CHECK_FALSE(tube.over_bin);
  CHECK_FALSE(tube.over_tray);
}

TEST_CASE("truth follows a tube from the bin into the fingers") {
  const double radius_m = LoadPart("pvc_a").radius_m;
  Bench bench(OneTube("pvc_a", Vector3(0, 0, radius_m)));
  CHECK(Truth(bench.twin()).Held() == 0);
  bench.GraspAt(Vector3(0, 0, radius_m));
  RigidTransform X_BE = bench.X_BE();
  X_BE.translation().z() += 0.1;
  bench.MoveLine(X_BE);
  const Truth::Tube held = Truth(bench.twin()).Tubes().at(0);
  CHECK(held.touches_pads);
  CHECK(held.hangs);
  CHECK(Truth(bench.twin()).Held() == 1);
  CHECK(Truth(bench.twin()).CurrentPile().tubes[0].centerline_N[0].z() > 0.1);
  MoveGripper(bench.cell(), {0.085, 0.15, 60.0});
  Wait(bench.cell(), 1.0);
  CHECK(Truth(bench.twin()).Held() == 0);
  CHECK(Truth(bench.twin()).Tubes().at(0).over_bin);
}

TEST_CASE("the same seed gives the same cell, bit for bit") {
  const double radius_m = LoadPart("hose_b").radius_m;
  std::vector<double> qpos[2];
  Wrench wrench[2];
  for (int run = 0; run < 2; ++run) {
    Bench bench(OneTube("hose_b", Vector3(0.05, 0, radius_m)));
    bench.GraspAt(Vector3(0, 0, radius_m));
    bench.Tilt(Vector3(0, 0, 0.2));
    qpos[run] = bench.twin().Qpos();
    wrench[run] = bench.cell().wrist.Read().wrench_K;
  }
  CHECK(qpos[0] == qpos[1]);
  CHECK(wrench[0].force_N == wrench[1].force_N);
  CHECK(wrench[0].torque_Nm == wrench[1].torque_Nm);
}

TEST_CASE("frames come at k/30 s rounded to the step") {
  Bench bench(OneTube("pvc_a", Vector3(0, 0, 0.0126)));
  std::vector<std::int64_t> times_ms;
  bench.twin().SetFrameObserver(
      [&] { times_ms.push_back(bench.cell().clock.Now() / kControlPeriod); });
  Wait(bench.cell(), 2.0);
  REQUIRE(times_ms.size() == 60);
  for (std::size_t k = 0; k < times_ms.size(); ++k) {
    CHECK(times_ms[k] == std::llround(static_cast<double>(k + 1) * 1000.0 / 30.0));
  }
}

TEST_CASE("the compiled model as XML loads, compiles and has the same coordinates") {
  Bench bench(OneTube("hose_b", Vector3(0, 0, 0.0101)));
  const std::string xml = bench.twin().ModelXml();
  char error[1000] = "";
  const MjSpec spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error)));
  INFO(error);
  REQUIRE(spec != nullptr);
  const MjModel model = Compile(*spec, "the cell read back");
  CHECK(static_cast<std::size_t>(model->nq) == bench.twin().Qpos().size());
  REQUIRE(model->nkey == 1);
  for (int i = 0; i < model->nq; ++i) {
    CHECK(model->key_qpos[i] == Approx(bench.twin().Qpos()[i]).margin(1e-6));
  }
  CHECK(model->nbody == bench.impl().world.model().nbody);
  CHECK(xml.find("impratio=\"100\"") != std::string::npos);
  // Nothing but friction holds tubes: the only equalities are the gripper's couplings.
  CHECK(model->neq == 2);
  CHECK(xml.find("weld") == std::string::npos);
  CHECK(xml.find("adhesion") == std::string::npos);
}

TEST_CASE("a scan takes its time, refuses a second one and sees tube, bin and pose") {
  const Pile pile = OneTube("pvc_a", Vector3(0, 0, 0.0126));
  Bench bench(pile, ScanOptions(pile));
  Cell& cell = bench.cell();
  const RigidTransform X_BE =
      bench.planner().PoseOfEForScan(ScanPosesOf(PaperCell(), pile.bin).front());
  const MotionResult there = bench.planner().PlanTransfer(cell.arm.State().q, X_BE, {});
  REQUIRE(std::holds_alternative<CheckedTrajectory>(there));
  REQUIRE(RunTrajectory(cell, std::get<CheckedTrajectory>(there)).status ==
          WaitOutcome::Status::kDone);
  CHECK(cell.scanner.Status() == ScanStatus::kIdle);
  const TimeNs start = cell.clock.Now();
  REQUIRE(cell.scanner.Trigger().accepted());
  CHECK_THAT(cell.scanner.Trigger().reason, Catch::Contains("a scan is running"));
  while (cell.scanner.Status() == ScanStatus::kBusy) Wait(cell, 0.001);
  CHECK(Seconds(cell.clock.Now() - start) == Approx(PaperCell().scanner.scan_time_s));
  const OrganizedCloud cloud = cell.scanner.Take();
  CHECK(cell.scanner.Status() == ScanStatus::kIdle);
  REQUIRE(cloud.width == 258);
  REQUIRE(cloud.size() == 258u * 193u);

  // Nominal physics has no hand-eye error: points of the floor lie on the floor.
  const RigidTransform X_NSTrue = pile.bin.X_BN.inverse() * Truth(bench.twin()).X_BS();
  CHECK((X_NSTrue.translation() - cloud.X_NS.translation()).norm() < 1e-4);
  int tube = 0, on_tube = 0, floor = 0, seen = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!IsValid(cloud.p_SP[i])) continue;
    ++seen;
    const Vector3 p_N = cloud.X_NS * cloud.p_SP[i].cast<double>();
    if (cloud.label[i] == kLabelFirstTube) {
      ++tube;
      const double off_m = std::hypot(p_N.y(), p_N.z() - 0.0126) - 0.0125;
      on_tube += std::abs(off_m) < 0.001 ? 1 : 0;
    } else if (std::abs(p_N.z()) < 0.002) {
      ++floor;
    }
  }
  CHECK(seen > 10000);
  CHECK(floor > seen / 2);
  CHECK(tube > 50);
  CHECK(on_tube > 0.9 * tube);  // Flying pixels at the edges are the rest.
}

TEST_CASE("nothing of arm and gripper stands in the camera's view or in the projector's light") {
  const Pile pile = OneTube("pvc_a", Vector3(0, 0, 0.0126));
  Bench bench(pile, ScanOptions(pile));
  Cell& cell = bench.cell();
  Pinhole pinhole{258, 193, static_cast<float>(PaperCell().scanner.focal_px * 258 / 2064)};
  const auto views = ScanPosesOf(PaperCell(), pile.bin);
  for (const double width_m : {0.085, 0.0}) {
    cell.gripper.Command({width_m, 0.1, 60.0});
    for (const RigidTransform& X_BSView : {views.front(), views[views.size() / 2], views.back()}) {
      const MotionResult there = bench.planner().PlanTransfer(
          cell.arm.State().q, bench.planner().PoseOfEForScan(X_BSView), {});
      REQUIRE(std::holds_alternative<CheckedTrajectory>(there));
      REQUIRE(RunTrajectory(cell, std::get<CheckedTrajectory>(there)).status ==
              WaitOutcome::Status::kDone);
      const RigidTransform X_BS = Truth(bench.twin()).X_BS();
      const ScanGeometry all = bench.impl().world.Geometry();
      // The robot is nearer to the scanner than anything else can be.
      constexpr double kRobot_m = 0.33;
      const auto near = [&](const Vector3& p_B) { return (X_BS.inverse() * p_B).z() < kRobot_m; };
      ScanGeometry others = all;
      std::erase_if(others.capsules, [&](const auto& c) { return near(0.5 * (c.a + c.b)); });
      std::erase_if(others.boxes, [&](const auto& b) { return near(b.X_BBox.translation()); });
      REQUIRE(others.boxes.size() + 5 < all.boxes.size());  // Scanner, bracket, gripper are gone.
      REQUIRE(others.boxes.size() >= 7);                    // Plate, tray, plinth, bin.
      HitImage with(pinhole), without(pinhole);
      RayScene(all, X_BS, {}).CastRows(pinhole, 0, pinhole.height, true, with);
      RayScene(others, X_BS, {}).CastRows(pinhole, 0, pinhole.height, true, without);
      int differ = 0;
      for (int row = 0; row < pinhole.height; ++row) {
        for (int column = 0; column < pinhole.width; ++column) {
          const std::size_t i = with.Index(row, column);
          differ +=
              with.z_m[i] != without.z_m[i] || with.cos_projector[i] != without.cos_projector[i];
        }
      }
      CHECK(differ == 0);
    }
  }
}

TEST_CASE("the hand-eye error moves the true scanner and not the believed one") {
  const Pile pile = OneTube("pvc_a", Vector3(0, 0, 0.0126));
  TwinCellOptions options = ScanOptions(pile);
  options.physics.X_SbelievedS = Translation(0.001, 0, 0);
  Bench bench(pile, options);
  const OrganizedCloud cloud = Scan(bench.cell());
  const RigidTransform X_NSTrue = pile.bin.X_BN.inverse() * Truth(bench.twin()).X_BS();
  const Vector3 error_S = (cloud.X_NS.inverse() * X_NSTrue).translation();
  // Rest of the arm's encoder counts at a metre.
  CHECK((error_S - Vector3(0.001, 0, 0)).norm() < 1e-4);
}

}  // namespace tubetwin::test

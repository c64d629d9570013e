// What one pick costs, stage by stage, on the seven pvc_a tubes of `run --seed 1`.
// ./dev bench runs it; the tests run each benchmark once so that none rots.

#include <benchmark/benchmark.h>

#include "models/arm/arm.h"
#include "models/base/cloud/cloud.h"
#include "models/base/random.h"
#include "models/cell_model.h"
#include "perception/perceive.h"
#include "planner/evaluator/evaluator.h"
#include "scenes/pile.h"
#include "tests/support/paper_cell.h"
#include "tests/support/paper_scan.h"
#include "tests/support/planning.h"
#include "tests/support/temporary_folder.h"
#include "twin/cell/twin_cell.h"

namespace tubetwin {
namespace {

const Pile& SevenTubes() {
  static const Pile pile = [] {
    const Part part = LoadPart("pvc_a");
    return GeneratePile(part, Bin(), 7, "dropped", 1, NominalPhysics(part)).pile;
  }();
  return pile;
}

ScanGeometry Geometry() {
  ScanGeometry out;
  const auto albedo = static_cast<float>(SevenTubes().part.albedo());
  const auto gloss = static_cast<float>(SevenTubes().part.gloss);
  for (const PileTube& tube : SevenTubes().tubes) {
    const Polyline line_B = Transformed(SevenTubes().bin.X_BN, tube.centerline_N);
    for (const AxisPiece& piece : PiecesWithin(line_B, tube.radius_m)) {
      out.capsules.push_back({piece.from, piece.to, tube.radius_m, kLabelFirstTube, albedo, gloss});
    }
  }
  const Bin& bin = SevenTubes().bin;
  const auto box = [&](const Vector3& centre_N, const Vector3& half_m) {
    out.boxes.push_back({bin.X_BN * Translation(centre_N), half_m, kLabelCell, kCellAlbedo});
  };
  box({0, 0, -0.01}, {0.5, 0.5, 0.01});
  for (const double side : {-1.0, 1.0}) {
    box({side * (bin.half_x_m() + 0.005), 0, 0.5 * bin.wall_m()}, {0.005, 0.4, 0.5 * bin.wall_m()});
    box({0, side * (bin.half_y_m() + 0.005), 0.5 * bin.wall_m()}, {0.5, 0.005, 0.5 * bin.wall_m()});
  }
  return out;
}

TubeScene Scene() {
  TubeScene scene;
  for (const PileTube& tube : SevenTubes().tubes) {
    PerceivedTube seen;
    seen.id = tube.id;
    seen.centerline_N = tube.centerline_N;
    seen.radius_m = tube.radius_m;
    seen.length_m = Length(tube.centerline_N);
    seen.confidence = seen.visible_fraction = 1.0;
    scene.tubes.push_back(std::move(seen));
  }
  AssignClasses(scene, SevenTubes().part.radius_m);
  return scene;
}

/// One view with every effect; argument: 1 for 2064 x 1544, 0 for 1032 x 772. All cores.
void BM_Scan(benchmark::State& state) {
  ScanSettings settings = PaperScan();
  if (state.range(0) == 1) {
    settings.width = settings.spec.full_width;
    settings.height = settings.spec.full_height;
  }
  const ScanGeometry geometry = Geometry();
  const RigidTransform X_BS = ScanPosesOf(PaperCell(), SevenTubes().bin)[1];
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        CastScan(geometry, X_BS, settings, RandomStream(1, 0, "bench"), Parallelism::All()));
  }
}
BENCHMARK(BM_Scan)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A PCD file of one view of 2064 x 1544 to a cloud.
void BM_ReadCloud(benchmark::State& state) {
  ScanSettings settings = PaperScan();
  settings.width = settings.spec.full_width;
  settings.height = settings.spec.full_height;
  const RigidTransform X_BS = ScanPosesOf(PaperCell(), SevenTubes().bin)[1];
  const TemporaryFolder folder;
  WritePcd(CastScan(Geometry(), X_BS, settings, RandomStream(1, 0, "bench"), Parallelism::All()),
           folder / "view.pcd");
  for (auto _ : state) benchmark::DoNotOptimize(ReadPcd(folder / "view.pcd"));
}
BENCHMARK(BM_ReadCloud)->Unit(benchmark::kMillisecond);

/// Eight views of 1032 x 772 to tubes and crossings. All cores.
void BM_Perceive(benchmark::State& state) {
  std::vector<OrganizedCloud> views;
  const Bin bin = SevenTubes().bin;
  for (const RigidTransform& X_BS : ScanPosesOf(PaperCell(), bin)) {
    views.push_back(CastScan(Geometry(), X_BS, PaperScan(), RandomStream(1, views.size(), "bench"),
                             Parallelism::All()));
    views.back().X_NS = bin.X_BN.inverse() * X_BS;
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(Perceive(views, SevenTubes().part, bin, {}, Parallelism::All()));
  }
}
BENCHMARK(BM_Perceive)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Straight lifts of all seven tubes, nothing pruned or cut short; items are roll-outs. All cores.
void BM_EvaluateFull(benchmark::State& state) {
  const TubeScene scene = Scene();
  EvaluationRequest request;
  request.full = true;
  for (const PerceivedTube& tube : scene.tubes) {
    request.candidates.push_back(StraightUp({scene, tube, Bin{}, {}}));
    request.grasp_at_m.push_back(0.5 * tube.length_m);
  }
  const EvaluateFunction evaluate = MakeEvaluator({Parallelism::All(), {}, FirstGripper()});
  for (auto _ : state) {
    benchmark::DoNotOptimize(evaluate(scene, SevenTubes().part, SevenTubes().bin, request));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.tubes.size()));
}
BENCHMARK(BM_EvaluateFull)->Unit(benchmark::kMillisecond)->UseRealTime();

/// All branches of the arm's inverse kinematics at one pose.
void BM_InverseAll(benchmark::State& state) {
  const RigidTransform X_BF = MakeTransform(RotZ(0.3) * RotX(kPi - 0.2), Vector3(0.6, -0.1, 0.4));
  for (auto _ : state) benchmark::DoNotOptimize(InverseAll(PaperCell().arm, X_BF));
}
BENCHMARK(BM_InverseAll)->Unit(benchmark::kMicrosecond);

/// One second of the whole cell standing still with seven tubes, one core.
void BM_CellSecond(benchmark::State& state) {
  TwinCellOptions options;
  options.model = PaperCell();
  options.scan = PaperScan();
  options.physics = NominalPhysics(SevenTubes().part);
  TwinCell twin(SevenTubes(), options);
  for (auto _ : state) twin.cell().clock.AdvanceTo(twin.cell().clock.Now() + FromSeconds(1.0));
}
BENCHMARK(BM_CellSecond)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tubetwin

BENCHMARK_MAIN();

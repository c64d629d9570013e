// The evaluator against plain roll-outs of the same lifts: one MuJoCo model per candidate at 1 ms,
// settled each, nothing shared or cut short; and ODE at 1 ms as the 2020 paper used it. `./dev
// bench evaluator`; README.md beside this file holds a measured table. Methods run in turns, the
// fastest of several repeats counts.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "models/base/parallel.h"
#include "planner/evaluator/evaluator.h"
#include "planner/evaluator/rollout.h"
#include "scenes/pile.h"
#include "tests/benchmark/ode_lift.h"
#include "tests/support/planning.h"

namespace tubetwin {
namespace {

double Seconds(const std::function<void()>& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

TubeScene SceneOf(const Pile& pile) {
  TubeScene scene;
  for (const PileTube& tube : pile.tubes) {
    PerceivedTube seen;
    seen.id = tube.id;
    seen.centerline_N = tube.centerline_N;
    seen.radius_m = tube.radius_m;
    seen.length_m = Length(tube.centerline_N);
    seen.confidence = seen.visible_fraction = 1.0;
    seen.node_visible.assign(tube.centerline_N.size(), 1);
    scene.tubes.push_back(std::move(seen));
  }
  AssignClasses(scene, pile.part.radius_m);
  return scene;
}

EvaluationRequest Ups(const TubeScene& scene, bool full) {
  EvaluationRequest request;
  request.full = full;
  for (const PerceivedTube& tube : scene.tubes) {
    request.candidates.push_back(StraightUp({scene, tube, Bin{}, {}}));
    request.grasp_at_m.push_back(0.5 * tube.length_m);
  }
  return request;
}

/// Sixteen motions of covered tubes, four samples each.
EvaluationRequest SixtyFour(const TubeScene& scene, const Bin& bin) {
  EvaluationRequest request;
  request.samples = 4;
  for (const bool covered : {true, false}) {
    for (const PerceivedTube& tube : scene.tubes) {
      if ((tube.tube_class != TubeClass::kFree) != covered) continue;
      for (CandidateMotion& motion : MotionsOf(kPaperKinds, scene, tube, bin).motions) {
        if (request.candidates.size() == 16) break;
        request.grasp_at_m.push_back(0.5 * tube.length_m);
        request.candidates.push_back(std::move(motion));
      }
    }
  }
  return request;
}

/// The obvious way: everything anew for each candidate.
void PlainRollouts(const Pile& pile, const EvaluationRequest& request) {
  EvaluatorConfig config;
  config.timestep_s = 0.001;
  config.tolerance = 1e-8;
  for (std::size_t k = 0; k < request.candidates.size(); ++k) {
    const RolloutScene scene(pile.tubes, pile.part, pile.bin, pile.part.friction,
                             pile.part.bending_stiffness_Nm2,
                             {Parallelism{1}, config, FirstGripper()});
    const MjModel model(mj_copyModel(nullptr, &scene.model()));
    const MjData data = MakeData(*model);
    RollOut(scene, static_cast<int>(k), 0.5, request.candidates[k], true, config, *model, *data);
  }
}

std::string Machine() {
  std::ifstream cpu("/proc/cpuinfo");
  for (std::string line; std::getline(cpu, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

struct Case {
  const char* part;
  int count;
};

void Measure(const Case& which, int piles, int repeats) {
  const Part part = LoadPart(which.part);
  std::map<std::string, double> best;
  const auto note = [&](const std::string& what, double value) {
    auto [found, fresh] = best.try_emplace(what, value);
    if (!fresh) found->second = std::min(found->second, value);
  };
  std::map<std::string, double> sum;
  for (int seed = 1; seed <= piles; ++seed) {
    best.clear();
    const Pile pile = GeneratePile(part, Bin(), which.count, "dropped",
                                   static_cast<std::uint64_t>(seed), NominalPhysics(part))
                          .pile;
    const TubeScene scene = SceneOf(pile);
    const EvaluationRequest full = Ups(scene, true), cut = Ups(scene, false);
    const EvaluationRequest many = SixtyFour(scene, pile.bin);
    const EvaluateFunction one = MakeEvaluator({Parallelism{1}, {}, FirstGripper()});
    const EvaluateFunction two = MakeEvaluator({Parallelism{2}, {}, FirstGripper()});
    const auto run = [&](const EvaluateFunction& evaluate, const EvaluationRequest& request) {
      return Seconds([&] { evaluate(scene, part, pile.bin, request); });
    };
    for (int repeat = 0; repeat < repeats; ++repeat) {
      note("full2", run(two, full));
      note("cut2", run(two, cut));
      note("many2", run(two, many) * 64.0 / (4.0 * static_cast<double>(many.candidates.size())));
      note("full1", run(one, full));
      note("plain1", Seconds([&] { PlainRollouts(pile, full); }));
      if (part.is_hose()) continue;
      double ode = 0.0;
      for (int k = 0; k < which.count; ++k) {
        ode += LiftInOde(pile, k, ExtractionConfig().lift_m, ExtractionConfig().lift_speed_m_s,
                         EvaluatorConfig().hold_s)
                   .wall_s;
      }
      note("ode1", ode);
    }
    for (const auto& [what, value] : best) sum[what] += value / piles;
  }
  const double n = which.count;
  std::printf("| `%s`, %d | %.1f | %.1f | %.2f | %.1f | %.1f | ", which.part, which.count,
              n / sum["full2"], n / sum["cut2"], sum["many2"], n / sum["full1"],
              sum["plain1"] / sum["full1"]);
  if (sum.count("ode1") != 0) {
    std::printf("%.1f |\n", sum["ode1"] / sum["full1"]);
  } else {
    std::printf("- |\n");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  using tubetwin::Case;
  const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
  const int piles = quick ? 1 : argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
  std::printf("%s, dropped piles: %d, fastest of %d each\n\n", tubetwin::Machine().c_str(), piles,
              quick ? 1 : 3);
  std::printf(
      "| part, tubes | full, 2 threads, 1/s | early ends, 2 threads, 1/s | 64 roll-outs, 2 "
      "threads, "
      "s | full, 1 thread, 1/s | plain 1 ms / full | ODE 1 ms / full "
      "|\n|---|---|---|---|---|---|---|\n");
  const std::vector<Case> cases =
      quick ? std::vector<Case>{{"pvc_a", 2}}
            : std::vector<Case>{{"pvc_a", 7}, {"pvc_a", 10}, {"hose_b", 7}};
  for (const Case& which : cases) tubetwin::Measure(which, piles, quick ? 1 : 3);
  return 0;
}

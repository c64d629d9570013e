// Both profiles of perception and a plain PCL writing of the paper's steps on the same clouds:
// accuracy and time by the number of tubes. `./dev bench perception`; README.md beside this file
// holds a measured table.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "models/base/error.h"
#include "models/base/parallel.h"
#include "perception/perceive.h"
#include "scenes/pile.h"
#include "tests/benchmark/plain_pcl.h"
#include "tests/support/toy_scanner.h"
#include "tests/support/tube_metrics.h"

namespace tubetwin {
namespace {

constexpr double kHeight_m = 1.1;   // Of the camera over the floor.
constexpr double kAcross_m = 0.98;  // Width of the image at that distance: the bin and its rim.
constexpr double kNoise_m = 0.0001;

struct Options {
  std::vector<int> counts = {1, 3, 5, 7, 10, 15, 20};
  std::string part = "leao2022";
  int width = 2064, height = 1544;
  int piles = 1;
  int repeats = 3;
  std::uint64_t seed = 1;
  int threads = Parallelism::All().threads;
  bool keep_short = false;
};

[[noreturn]] void Usage(const std::string& about) {
  std::fprintf(stderr,
               "perception_bench: %s\n"
               "  --counts 1,3,5     tubes per pile\n"
               "  --part NAME        part of the generated piles (leao2022)\n"
               "  --view WxH         image of the camera 1.1 m over the floor (2064x1544)\n"
               "  --piles N          piles per count (1)\n"
               "  --repeats N        runs per cloud, the fastest counts (3)\n"
               "  --seed N           of piles and noise (1)\n"
               "  --threads N        of all methods (all cores)\n"
               "  --keep-short       nothing is discarded for its length (paper's Table 2)\n"
               "  --quick            one small image, for the tests\n",
               about.c_str());
  std::exit(64);
}

int ToInt(const std::string& text) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || value < 1 || value > 1000000) {
    Usage("'" + text + "' is no count");
  }
  return static_cast<int>(value);
}

Options Parse(const std::vector<std::string>& arguments) {
  Options o;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& name = arguments[i];
    if (name == "--quick") {
      o.counts = {2};
      o.width = 480;
      o.height = 360;
      o.repeats = 1;
      continue;
    }
    if (name == "--keep-short") {
      o.keep_short = true;
      continue;
    }
    if (i + 1 == arguments.size()) Usage("'" + name + "' is unknown or lacks its value");
    const std::string& value = arguments[++i];
    if (name == "--counts") {
      o.counts.clear();
      for (std::size_t at = 0; at <= value.size();) {
        const std::size_t comma = std::min(value.find(',', at), value.size());
        o.counts.push_back(ToInt(value.substr(at, comma - at)));
        at = comma + 1;
      }
    } else if (name == "--part") {
      o.part = value;
    } else if (name == "--view") {
      const std::size_t x = value.find('x');
      if (x == std::string::npos) Usage("--view '" + value + "': WxH is needed");
      o.width = ToInt(value.substr(0, x));
      o.height = ToInt(value.substr(x + 1));
    } else if (name == "--piles") {
      o.piles = ToInt(value);
    } else if (name == "--repeats") {
      o.repeats = ToInt(value);
    } else if (name == "--seed") {
      o.seed = static_cast<std::uint64_t>(ToInt(value));
    } else if (name == "--threads") {
      o.threads = ToInt(value);
    } else {
      Usage("'" + name + "' is unknown");
    }
  }
  return o;
}

struct Sample {
  Part part;
  Bin bin;
  std::vector<Polyline> lines_N;
  OrganizedCloud cloud;  ///< Without labels.
  std::vector<TubePoint> points;
};

Sample MakeSample(const Options& o, int count, std::uint64_t seed) {
  Sample sample;
  sample.part = LoadPart(o.part);
  sample.bin.size_m = {0.80, 0.60, 0.20};
  const Pile pile =
      GeneratePile(sample.part, sample.bin, count, "dropped", seed, NominalPhysics(sample.part))
          .pile;
  ToyScene scene;
  scene.radius_m = sample.part.radius_m;
  scene.bin = sample.bin;
  for (const PileTube& tube : pile.tubes) scene.tubes_N.push_back(tube.centerline_N);
  ToyCamera camera;
  camera.width = o.width;
  camera.height = o.height;
  camera.focal_px = kHeight_m * o.width / kAcross_m;
  camera.sigma_m = kNoise_m;
  const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, kHeight_m));
  sample.cloud = ToyScan(scene, camera, X_NS, RandomStream(seed, 0, "bench noise"));
  sample.points = TubePointsOf({sample.cloud}, {X_NS}, 29);
  sample.cloud.label.clear();
  sample.lines_N = std::move(scene.tubes_N);
  return sample;
}

struct Result {
  std::vector<double> recall, median_m, p95_m, wall_ms, cpu_ms;
  int found = 0, tubes = 0;
};

double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

enum Method { kBest, kLeao, kLeaoWide, kPlain, kMethods };
constexpr const char* kNames[kMethods] = {"best", "leao2020", "leao2020, joints to 5 cm, 50 deg",
                                          "plain PCL"};

TubeScene RunMethod(Method method, const Sample& sample, const Options& o) {
  if (method == kPlain) {
    return PlainPcl(sample.cloud, sample.part, sample.bin, o.threads, o.keep_short);
  }
  PerceptionConfig config;
  config.profile = method == kBest ? "best" : "leao2020";
  if (method == kLeaoWide) {  // What the method can do without the published limits of joints.
    config.leao2020.join_distance_m = 0.05;
    config.leao2020.join_angle_deg = 50.0;
  }
  if (o.keep_short) config.leao2020.least_share_rigid = config.leao2020.least_share_hose = 0.0;
  return Perceive({sample.cloud}, sample.part, sample.bin, config, {o.threads});
}

/// Methods take turns on each cloud, so that what else the machine does meets all of them.
void Measure(const Sample& sample, const Options& o, Result (&results)[kMethods]) {
  double wall_ms[kMethods], cpu_ms[kMethods];
  std::fill_n(wall_ms, kMethods, 1e12);
  std::fill_n(cpu_ms, kMethods, 1e12);
  for (int repeat = 0; repeat < o.repeats; ++repeat) {
    for (int m = 0; m < kMethods; ++m) {
      const std::clock_t began = std::clock();
      const TubeScene scene = RunMethod(static_cast<Method>(m), sample, o);
      cpu_ms[m] = std::min(cpu_ms[m], 1e3 * (std::clock() - began) / CLOCKS_PER_SEC);
      wall_ms[m] = std::min(wall_ms[m], scene.timing_ms.total);
      if (repeat > 0) continue;
      const TubeScore score =
          ScoreTubes(scene, sample.lines_N, sample.points, sample.part.radius_m);
      results[m].recall.push_back(score.micro_recall);
      results[m].found += score.found;
      results[m].tubes += score.true_tubes;
      if (score.paired == 0) continue;
      results[m].median_m.push_back(score.centerline_median_m);
      results[m].p95_m.push_back(score.centerline_p95_m);
    }
  }
  for (int m = 0; m < kMethods; ++m) {
    results[m].wall_ms.push_back(wall_ms[m]);
    results[m].cpu_ms.push_back(cpu_ms[m]);
  }
}

std::string CpuModel() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

void Run(const Options& o) {
  std::printf(
      "perception: %s, %d cores, %d threads; part %s, one view %d x %d from %.1f m, noise "
      "%.1f mm, %d pile(s) per count from seed %llu, fastest of %d\n",
      CpuModel().c_str(), Parallelism::All().threads, o.threads, o.part.c_str(), o.width, o.height,
      kHeight_m, 1e3 * kNoise_m, o.piles, static_cast<unsigned long long>(o.seed), o.repeats);
  std::printf(
      "| tubes | method | micro-recall | found | centerline median, p95 mm | wall ms | cpu "
      "ms | plain/this wall | cpu |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const int count : o.counts) {
    Result results[kMethods];
    for (int k = 0; k < o.piles; ++k) {
      Measure(MakeSample(o, count, o.seed + static_cast<std::uint64_t>(k)), o, results);
    }
    for (int m = 0; m < kMethods; ++m) {
      const Result& r = results[m];
      std::printf("| %d | %s | %.3f | %d/%d | %.2f, %.2f | %.0f | %.0f | %.1f | %.1f |\n", count,
                  kNames[m], Mean(r.recall), r.found, r.tubes, 1e3 * Median(r.median_m),
                  1e3 * Median(r.p95_m), Median(r.wall_ms), Median(r.cpu_ms),
                  Median(results[kPlain].wall_ms) / Median(r.wall_ms),
                  Median(results[kPlain].cpu_ms) / Median(r.cpu_ms));
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  try {
    tubetwin::Run(tubetwin::Parse(std::vector<std::string>(argv + 1, argv + argc)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "perception_bench: %s\n", error.what());
    return 70;
  }
  return 0;
}

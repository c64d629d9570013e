// How often perception is wrong about what a bin holds: bin_content empty|tube|foreign COUNT
// [FIRST [WIDTH [THREADS]]]. A line for every wrong case, then "wrong K of N" with the 95 %
// interval of the rate. Seeds FIRST to FIRST + COUNT - 1; a wrong one is looked at alone by
// COUNT 1.

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/support/bin_cases.h"
#include "twin/statistics/wilson.h"

namespace tubetwin {
namespace {

int Run(int argc, char** argv) {
  const char* const names[] = {"empty", "tube", "foreign"};
  int kind = 0;
  while (argc > 1 && kind < 3 && std::strcmp(argv[1], names[kind]) != 0) ++kind;
  if (argc < 3 || kind == 3) {
    std::fprintf(stderr, "usage: bin_content empty|tube|foreign COUNT [FIRST [WIDTH [THREADS]]]\n");
    return 64;
  }
  const int count = std::atoi(argv[2]);
  const int first = argc > 3 ? std::atoi(argv[3]) : 0;
  const int width = argc > 4 ? std::atoi(argv[4]) : 344;
  const Parallelism parallelism{argc > 5 ? std::atoi(argv[5]) : 1};
  int wrong = 0, one_tube = 0;
  for (int seed = first; seed < first + count; ++seed) {
    const BinCase c =
        DrawBinCase(static_cast<BinCase::Kind>(kind), static_cast<std::uint64_t>(seed));
    const TubeScene scene = Perceive(ScanBinCase(c, width, parallelism), c.part, c.bin,
                                     PerceptionConfig{}, parallelism);
    const std::string problem = JudgeBinCase(c, scene);
    one_tube += scene.tubes.size() == 1;
    if (problem.empty()) continue;
    ++wrong;
    std::printf("seed %d, %s in %.2f x %.2f x %.2f m, noise %.1f: %s\n", seed, c.what.c_str(),
                c.bin.size_m[0], c.bin.size_m[1], c.bin.size_m[2], c.noise_scale, problem.c_str());
    std::fflush(stdout);
  }
  const auto interval = Wilson95(wrong, count);
  std::printf("%s: wrong %d of %d (95 %% interval %.4f to %.4f), exactly one tube seen in %d\n",
              names[kind], wrong, count, interval.low, interval.high, one_tube);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) { return tubetwin::Run(argc, argv); }

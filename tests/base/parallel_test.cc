#include "models/base/parallel.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

std::vector<double> Draw(int threads) {
  const RandomStream parent(1, 0, "parallel");
  std::vector<double> out(1000);
  ParallelFor(1000, Parallelism{threads}, [&](int index, int) {
    RandomStream stream = parent.Fork("item", static_cast<std::uint64_t>(index));
    for (int i = 0; i <= index % 7; ++i) out[index] = stream.Normal();
  });
  return out;
}

}  // namespace

TEST_CASE("every index runs exactly once and workers stay below the thread count") {
  for (const int threads : {1, 2, 3, 16}) {
    std::vector<std::atomic<int>> runs(100);
    std::atomic<bool> good_worker = true;
    ParallelFor(100, Parallelism{threads}, [&](int index, int worker) {
      ++runs[index];
      if (worker < 0 || worker >= threads) good_worker = false;
    });
    CHECK(good_worker);
    for (const auto& n : runs) CHECK(n == 1);
  }
}

TEST_CASE("two threads never hold the same worker number at once") {
  std::vector<std::atomic<int>> inside(4);
  std::atomic<bool> shared = false;
  ParallelFor(2000, Parallelism{4}, [&](int, int worker) {
    if (++inside[worker] != 1) shared = true;
    --inside[worker];
  });
  CHECK_FALSE(shared);
}

TEST_CASE("results do not depend on the thread count") {
  const std::vector<double> one = Draw(1);
  CHECK(Draw(2) == one);
  CHECK(Draw(5) == one);
}

TEST_CASE("the exception of the lowest failing index is rethrown") {
  for (const int threads : {1, 2, 4}) {
    CHECK_THROWS_WITH(ParallelFor(200, Parallelism{threads},
                                  [](int index, int) {
                                    if (index >= 17 && index % 3 == 2) {
                                      throw std::runtime_error(std::to_string(index));
                                    }
                                  }),
                      "17");
  }
}

TEST_CASE("nothing to do and fewer items than threads are both fine") {
  int runs = 0;
  ParallelFor(0, Parallelism{4}, [&](int, int) { ++runs; });
  CHECK(runs == 0);
  ParallelFor(1, Parallelism{4}, [&](int, int) { ++runs; });
  CHECK(runs == 1);
  CHECK(Parallelism::All().threads >= 1);
}

}  // namespace tubetwin

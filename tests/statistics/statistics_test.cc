#include "twin/statistics/statistics.h"

#include <cmath>

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr double kRounding = 1e-12;

RandomStream Stream(std::uint64_t seed) { return RandomStream(seed, 0, "statistics_test"); }

TEST_CASE("The interval of a mean is Student's", "[unit]") {
  // t(0.975; 9) = 2.262157, any table.
  const Interval interval = MeanInterval95(10, 5.0, 2.0);
  CHECK(interval.high - 5.0 == Approx(2.262157 * 2.0 / std::sqrt(10.0)).epsilon(1e-6));
  CHECK(5.0 - interval.low == Approx(interval.high - 5.0));
  CHECK(std::isnan(MeanInterval95(1, 5.0, 0.0).low));
}

}  // namespace

TEST_CASE("a ratio of sums is drawn by whole clusters") {
  const std::vector<RatioPart> alike(5, {2.0, 4.0});
  const Interval point = RatioBootstrap95(alike, Stream(1), 5);
  CHECK(point.low == 0.5);
  CHECK(point.high == 0.5);
  // Two clusters drawn twice: 0, 1/2 or 1 in a quarter, a half, a quarter of the samples.
  const std::vector<RatioPart> two = {{0.0, 1.0}, {1.0, 1.0}};
  const Interval wide = RatioBootstrap95(two, Stream(1), 2);
  CHECK(wide.low == 0.0);
  CHECK(wide.high == 1.0);
  CHECK(RatioBootstrap95(two, Stream(1), 2, 50).low == RatioBootstrap95(two, Stream(1), 2, 50).low);
  CHECK(std::isnan(RatioBootstrap95({}, Stream(1), 0).low));
}

TEST_CASE("four times as many clusters halve the interval of a ratio") {
  std::vector<RatioPart> clusters;
  RandomStream random = Stream(3);
  for (int i = 0; i < 200; ++i) clusters.push_back({random.Uniform(0.0, 2.0), 1.0});
  const auto width = [&](int draws) {
    const Interval found = RatioBootstrap95(clusters, Stream(4), draws);
    return found.high - found.low;
  };
  constexpr double kOfDrawing = 0.1;  // 2000 samples: quantiles are off by some percent.
  CHECK(width(200) == Approx(2.0 * width(800)).epsilon(kOfDrawing));
  // A mean of numbers of standard deviation 1 / sqrt(3).
  CHECK(width(200) == Approx(2.0 * 1.96 / std::sqrt(3.0 * 200)).epsilon(kOfDrawing));
}

TEST_CASE("the exact McNemar test agrees with published values and counted coins") {
  // Fay 2011, exact2x2: 9 against 2 discordant pairs, p = 0.06543.
  CHECK(McNemarExact(9, 2) == Approx(0.06543).margin(5e-6));
  CHECK(McNemarExact(2, 9) == McNemarExact(9, 2));
  CHECK(McNemarExact(0, 0) == 1.0);
  CHECK(McNemarExact(3, 3) == 1.0);
  CHECK(McNemarExact(0, 10) == Approx(2.0 / 1024.0).epsilon(kRounding));
  CHECK(McNemarExact(1, 5) == Approx(2.0 * 7.0 / 64.0).epsilon(kRounding));
  CHECK_THROWS_AS(McNemarExact(-1, 2), LogicError);
}

TEST_CASE("Holm's adjustment keeps the order, steps down and never exceeds 1") {
  const std::vector<double> adjusted = HolmAdjusted({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected = {0.03, 0.06, 0.06, 0.02};
  for (int i = 0; i < 4; ++i) CHECK(adjusted[i] == Approx(expected[i]).epsilon(kRounding));
  CHECK(HolmAdjusted({0.7, 0.6}) == std::vector<double>{1.0, 1.0});
  CHECK(HolmAdjusted({0.2}) == std::vector<double>{0.2});
  CHECK(HolmAdjusted({}).empty());
}

TEST_CASE("quantiles interpolate between order statistics") {
  CHECK(Quantile({4, 1, 3, 2}, 0.5) == 2.5);
  CHECK(Quantile({4, 1, 3, 2}, 0.25) == 1.75);  // Type 7.
  CHECK(Quantile({4, 1, 3, 2}, 0.0) == 1.0);
  CHECK(Quantile({4, 1, 3, 2}, 1.0) == 4.0);
  CHECK(Quantile({9}, 0.95) == 9.0);
  CHECK_THROWS_AS(Quantile({}, 0.5), LogicError);
  const Spread spread = SpreadOf({2, 4, 4, 4, 5, 5, 7, 9});
  CHECK(spread.mean == 5.0);
  CHECK(spread.sd == Approx(std::sqrt(32.0 / 7.0)).epsilon(kRounding));
  CHECK(spread.median == 4.5);
  CHECK(spread.max == 9.0);
  CHECK(SpreadOf({}).n == 0);
}

TEST_CASE(
    "the clustered interval is as wide as independent trials allow when clusters are single") {
  // 200 rounds of one trial, 160 good: the normal interval is 0.8 +- 0.0554.
  std::vector<Counts> clusters;
  for (int i = 0; i < 200; ++i) clusters.push_back({i < 160 ? 1 : 0, 1});
  const ShareInterval found = ClusterBootstrap95(clusters, Stream(1));
  constexpr double kMonteCarlo = 0.01;  // 2,000 resamples leave about 0.003 on each bound.
  CHECK(found.low == Approx(0.7446).margin(kMonteCarlo));
  CHECK(found.high == Approx(0.8554).margin(kMonteCarlo));
}

TEST_CASE("the clustered interval widens by the square root of the cluster when trials agree") {
  std::vector<Counts> clusters;
  for (int i = 0; i < 200; ++i) clusters.push_back({i < 160 ? 7 : 0, 7});
  const ShareInterval found = ClusterBootstrap95(clusters, Stream(2));
  const ShareInterval independent = Wilson95(1120, 1400);
  const double ratio = (found.high - found.low) / (independent.high - independent.low);
  CHECK(ratio == Approx(std::sqrt(7.0)).epsilon(0.08));  // Monte Carlo.
}

TEST_CASE("the clustered interval covers the truth about 95 times in 100") {
  // Rounds with a chance of their own, 0.6 to 1, seven trials each: mean 0.8.
  int covered = 0;
  constexpr int kTrials = 300;
  RandomStream random = Stream(3);
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Counts> clusters;
    for (int i = 0; i < 60; ++i) {
      const double chance = random.Uniform(0.6, 1.0);
      Counts round{0, 7};
      for (int j = 0; j < 7; ++j) round.k += random.Uniform() < chance ? 1 : 0;
      clusters.push_back(round);
    }
    const ShareInterval found = ClusterBootstrap95(clusters, Stream(100 + trial), 400);
    covered += found.low <= 0.8 && 0.8 <= found.high ? 1 : 0;
  }
  CHECK(covered >= 0.90 * kTrials);  // A percentile interval of 60 clusters is a little narrow.
  CHECK(covered <= 0.99 * kTrials);
}

TEST_CASE("the same stream gives the same interval and no trial says nothing") {
  const std::vector<Counts> clusters = {{1, 2}, {3, 4}, {0, 0}, {2, 2}};
  const ShareInterval first = ClusterBootstrap95(clusters, Stream(4));
  const ShareInterval again = ClusterBootstrap95(clusters, Stream(4));
  CHECK(first.low == again.low);
  CHECK(first.high == again.high);
  CHECK(ClusterBootstrap95({}, Stream(4)).high == 1.0);
  CHECK(ClusterBootstrap95({{0, 0}}, Stream(4)).low == 0.0);
  CHECK(std::isnan(Bootstrap95(
                       0, [](const std::vector<int>&) { return 1.0; }, Stream(4))
                       .low));
}

}  // namespace tubetwin

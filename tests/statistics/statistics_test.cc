#include "twin/statistics/statistics.h"

#include <cmath>

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "twin/statistics/rate.h"

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

namespace {

/// Rounds of seven beta-binomial trials of chance `p`, two of a round correlated by `rho`: Polya's
/// urn, in which each success makes the next of its round more likely.
std::vector<Counts> BetaBinomial(double p, double rho, int rounds, RandomStream& random) {
  std::vector<Counts> out;
  for (int i = 0; i < rounds; ++i) {
    Counts round{0, 7};
    for (int j = 0; j < 7; ++j) {
      const double chance = (p * (1.0 - rho) + rho * round.k) / (1.0 - rho + rho * j);
      round.k += random.Uniform() < chance ? 1 : 0;
    }
    out.push_back(round);
  }
  return out;
}

}  // namespace

TEST_CASE("the interval by clusters is Wilson's when clusters are single or do not differ") {
  // 200 rounds of one trial: a design effect of 200 / 199, and (z / t)^2 of 199 degrees of freedom.
  std::vector<Counts> clusters;
  for (int i = 0; i < 200; ++i) clusters.push_back({i < 160 ? 1 : 0, 1});
  const ShareInterval found = ClusterWilson95(clusters);
  const ShareInterval wilson = Wilson95(160, 200);
  CHECK(found.low == Approx(wilson.low).margin(0.002));
  CHECK(found.high == Approx(wilson.high).margin(0.002));
  CHECK(found.low < wilson.low);
  CHECK(found.high > wilson.high);
  // Rounds more alike than chance makes them are not worth more than independent trials.
  const ShareInterval alike = ClusterWilson95(std::vector<Counts>(40, {6, 7}));
  CHECK(alike.low < Wilson95(240, 280).low);
}

TEST_CASE("the interval by clusters is that of published effective sizes") {
  // By hand: k 4, 2, 3, 1 of 5 each; share 0.5, variance between 5 / 300, deff 4 / 3, worth 15
  // trials, t(0.975; 3) = 3.182446: Wilson of 0.5 with 5.689447.
  const ShareInterval found = ClusterWilson95({{4, 5}, {2, 5}, {3, 5}, {1, 5}});
  const double n = 15.0 * std::pow(1.959964 / 3.182446, 2);
  const double z2 = 1.959964 * 1.959964;
  const double half = std::sqrt(z2 / n * (0.25 + z2 / (4.0 * n))) / (1.0 + z2 / n);
  CHECK(found.low == Approx(0.5 - half).margin(1e-6));
  CHECK(found.high == Approx(0.5 + half).margin(1e-6));
}

TEST_CASE("the interval by clusters widens by the square root of the cluster when trials agree") {
  std::vector<Counts> clusters;
  for (int i = 0; i < 200; ++i) clusters.push_back({i < 160 ? 7 : 0, 7});
  const ShareInterval found = ClusterWilson95(clusters);
  const ShareInterval independent = Wilson95(1120, 1400);
  const double ratio = (found.high - found.low) / (independent.high - independent.low);
  CHECK(ratio == Approx(std::sqrt(7.0)).epsilon(0.02));  // Wilson's own centre shifts a little.
}

TEST_CASE("where all trials succeed, or none, a whole cluster counts as one trial") {
  const ShareInterval all = ClusterWilson95(std::vector<Counts>(40, {7, 7}));
  CHECK(all.low == Wilson95(40, 40).low);
  CHECK(all.high == 1.0);
  const ShareInterval none = ClusterWilson95(std::vector<Counts>(40, {0, 7}));
  CHECK(none.low == 0.0);
  CHECK(none.high == Wilson95(0, 40).high);
  // Rounds in which nothing was tried say nothing.
  CHECK(ClusterWilson95({{7, 7}, {0, 0}, {7, 7}}).low == Wilson95(2, 2).low);
  CHECK(ClusterWilson95({{6, 7}}).low == Wilson95OfShare(6.0 / 7.0, 1.0).low);
}

TEST_CASE("the interval by clusters covers the truth of correlated trials, near 1 too") {
  constexpr int kTrials = 2000;
  constexpr double kLeast = 0.92;  // Of nominal 0.95; strongly correlated rounds come closest.
  RandomStream random = Stream(3);
  for (const double p : {0.8, 0.95, 0.99}) {
    for (const double rho : {0.0, 0.1, 0.2, 0.3}) {
      for (const int rounds : {20, 40, 80}) {
        int covered = 0;
        for (int trial = 0; trial < kTrials; ++trial) {
          const ShareInterval found = ClusterWilson95(BetaBinomial(p, rho, rounds, random));
          covered += found.low <= p && p <= found.high ? 1 : 0;
        }
        INFO("share " << p << ", correlation " << rho << ", " << rounds << " rounds: " << covered);
        CHECK(covered >= kLeast * kTrials);
      }
    }
  }
}

TEST_CASE("no trial says nothing, and impossible counts are a bug") {
  CHECK(ClusterWilson95({}).high == 1.0);
  CHECK(ClusterWilson95({{0, 0}}).low == 0.0);
  CHECK_THROWS_AS(ClusterWilson95({{3, 2}, {0, 5}}), LogicError);
  CHECK(std::isnan(Bootstrap95(
                       0, [](const std::vector<int>&) { return 1.0; }, Stream(4))
                       .low));
}

TEST_CASE("a rate tells its interval by rounds where there are several, else Wilson's") {
  const std::vector<Counts> rounds = {{7, 7}, {6, 8}, {7, 7}};
  const Rate clustered = RateOf(rounds, Trials::kClustered);
  REQUIRE(clustered.by_cluster);
  CHECK(Interval95(clustered).low == ClusterWilson95(rounds).low);
  const Json json = ToJson(clustered);
  CHECK(json["wilson95"][0] == Wilson95(20, 22).low);
  CHECK(json["cluster95"][1] == clustered.by_cluster->high);
  const Rate single = RateOf({{6, 8}}, Trials::kClustered);
  CHECK_FALSE(single.by_cluster);
  CHECK(Interval95(single).low == Wilson95(6, 8).low);
  CHECK_FALSE(RateOf(rounds, Trials::kIndependent).by_cluster);
}

}  // namespace tubetwin

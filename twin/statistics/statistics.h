#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/base/random.h"
#include "twin/statistics/wilson.h"

namespace tubetwin {

/// Successes and trials of one cluster of dependent trials: the attempts of one round.
struct Counts {
  int k = 0;
  int n = 0;
};

/// Sum over clusters.
Counts Total(const std::vector<Counts>& clusters);

/// 95 % interval of the chance of success, sum k / sum n, where trials of one cluster depend on
/// each other and clusters do not: Wilson's interval (1927) of the number of independent trials
/// that all of them are worth, n / deff. The design effect deff (Kish 1965) is the variance of the
/// ratio between the clusters over that of as many independent trials, at least 1; n / deff is
/// multiplied by (z / t)^2, t with one degree of freedom fewer than clusters (Korn and Graubard
/// 1998, Survey Methodology 24, 193-201). Where all trials succeed, or none, nothing can be
/// estimated: then a whole cluster counts as one trial (all its trials agree), so that 280 of 280
/// in 40 rounds say [91.2, 100] and not a point. Of beta-binomial rounds of seven it covers 92 % or
/// more up to a correlation of 0.3 within rounds (tests/statistics), and 89 % at 0.5 near a share
/// of 0.95. Clusters without a trial are left out. No trial at all: [0, 1].
ShareInterval ClusterWilson95(const std::vector<Counts>& clusters);

/// Interval of a number of any size.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// 95 % percentile interval of `statistic` over samples of the indices [0, count), drawn with
/// replacement; samples for which it is not finite are left out. All left out, or count = 0: NaN.
Interval Bootstrap95(int count, const std::function<double(const std::vector<int>&)>& statistic,
                     RandomStream random, int resamples = 2000);

/// What one cluster adds to a ratio of sums.
struct RatioPart {
  double numerator = 0.0;
  double denominator = 0.0;
};
/// 95 % percentile interval of sum of numerators / sum of denominators by drawing `draws` whole
/// clusters with replacement (Efron and Tibshirani 1993, 13.3). With `draws` = their number it is
/// the interval of the ratio; with more of them it is the one that as many clusters of the same
/// kind would give (Bickel, Goetze and van Zwet 1997, m of n). Of few clusters it is too narrow:
/// they do not show how much clusters can differ. No cluster, or no draw: NaN.
Interval RatioBootstrap95(const std::vector<RatioPart>& clusters, RandomStream random, int draws,
                          int resamples = 2000);

/// 95 % interval of the mean of `n` values with mean `mean` and standard deviation `sd` (of n - 1),
/// by Student's t with n - 1 degrees of freedom. n < 2: NaN.
Interval MeanInterval95(int n, double mean, double sd);

/// Sample quantile at `share` in [0, 1] of values in any order, with linear interpolation between
/// order statistics (Hyndman and Fan 1996, type 7). Precondition: values not empty.
double Quantile(std::vector<double> values, double share);

/// What is told of a sample of times.
struct Spread {
  int n = 0;
  double mean = 0.0, sd = 0.0;  ///< sd with n - 1; 0 for n < 2.
  double p5 = 0.0, median = 0.0, p95 = 0.0, max = 0.0;
};
Spread SpreadOf(const std::vector<double>& values);

/// Two-sided p of the exact McNemar test: of the discordant pairs, `only_a` succeeded under A alone
/// and `only_b` under B alone; under equality each is a fair coin (McNemar 1947, exact form). 1
/// when there is none.
double McNemarExact(int only_a, int only_b);

/// Holm's step-down adjustment (Holm 1979): p-values in the order given, each at most 1.
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

}  // namespace tubetwin

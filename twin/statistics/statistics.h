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

/// 95 % percentile interval of sum k / sum n by drawing whole clusters with replacement (Efron and
/// Tibshirani 1993, 13.3), so that dependence within a cluster widens it. `random` is taken by
/// value: same stream, same interval. Says nothing of its own when all clusters agree (the interval
/// is a point): read the Wilson interval then. No trial at all: [0, 1].
ShareInterval ClusterBootstrap95(const std::vector<Counts>& clusters, RandomStream random,
                                 int resamples = 2000);

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

#include "twin/statistics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kTail = 0.025;  // On each side of a 95 % interval.

/// Quantile of sorted values.
double SortedQuantile(const std::vector<double>& sorted, double share) {
  TT_CHECK(!sorted.empty() && 0.0 <= share && share <= 1.0);
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// The percentile interval over samples of `draws` of the indices [0, count).
Interval BootstrapOf(int count, int draws,
                     const std::function<double(const std::vector<int>&)>& statistic,
                     RandomStream random, int resamples) {
  TT_CHECK(count >= 0 && draws >= 0 && resamples > 0);
  std::vector<double> found;
  std::vector<int> drawn(static_cast<std::size_t>(draws));
  for (int r = 0; r < resamples && count > 0; ++r) {
    for (int& i : drawn) i = static_cast<int>(random.Index(static_cast<std::uint32_t>(count)));
    const double value = statistic(drawn);
    if (std::isfinite(value)) found.push_back(value);
  }
  if (found.empty()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  std::sort(found.begin(), found.end());
  return {SortedQuantile(found, kTail), SortedQuantile(found, 1.0 - kTail)};
}

}  // namespace

Counts Total(const std::vector<Counts>& clusters) {
  Counts sum;
  for (const Counts& cluster : clusters) {
    sum.k += cluster.k;
    sum.n += cluster.n;
  }
  return sum;
}

ShareInterval ClusterWilson95(const std::vector<Counts>& clusters) {
  const Counts all = Total(clusters);
  if (all.n == 0) return {};
  const double share = static_cast<double>(all.k) / all.n;
  int counted = 0;
  double squares = 0.0;
  for (const Counts& cluster : clusters) {
    TT_CHECK(0 <= cluster.k && cluster.k <= cluster.n);
    if (cluster.n == 0) continue;
    ++counted;
    const double off = cluster.k - share * cluster.n;
    squares += off * off;
  }
  if (counted < 2 || all.k == 0 || all.k == all.n) return Wilson95OfShare(share, counted);
  // Variances of the share, both times n^2.
  const double between = squares * counted / (counted - 1.0);
  const double independent = share * (1.0 - share) * all.n;
  const double worth = all.n / std::max(1.0, between / independent);
  static const double z = boost::math::quantile(boost::math::normal(), 1.0 - kTail);
  const boost::math::students_t_distribution<double> student(counted - 1);
  const double t = boost::math::quantile(boost::math::complement(student, kTail));
  return Wilson95OfShare(share, worth * (z / t) * (z / t));
}

Interval Bootstrap95(int count, const std::function<double(const std::vector<int>&)>& statistic,
                     RandomStream random, int resamples) {
  return BootstrapOf(count, count, statistic, random, resamples);
}

Interval RatioBootstrap95(const std::vector<RatioPart>& clusters, RandomStream random, int draws,
                          int resamples) {
  return BootstrapOf(
      static_cast<int>(clusters.size()), draws,
      [&](const std::vector<int>& drawn) {
        RatioPart sum;
        for (const int i : drawn) {
          sum.numerator += clusters[i].numerator;
          sum.denominator += clusters[i].denominator;
        }
        return sum.numerator / sum.denominator;
      },
      random, resamples);
}

Interval MeanInterval95(int n, double mean, double sd) {
  if (n < 2) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  const boost::math::students_t_distribution<double> t(n - 1);
  const double half = boost::math::quantile(boost::math::complement(t, kTail)) * sd / std::sqrt(n);
  return {mean - half, mean + half};
}

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return SortedQuantile(values, share);
}

Spread SpreadOf(const std::vector<double>& values) {
  Spread out;
  out.n = static_cast<int>(values.size());
  if (values.empty()) return out;
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  // Summed in sorted order: the same bytes whatever order the values came in.
  out.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / out.n;
  double squares = 0.0;
  for (const double value : sorted) squares += (value - out.mean) * (value - out.mean);
  if (out.n > 1) out.sd = std::sqrt(squares / (out.n - 1));
  out.p5 = SortedQuantile(sorted, 0.05);
  out.median = SortedQuantile(sorted, 0.5);
  out.p95 = SortedQuantile(sorted, 0.95);
  out.max = sorted.back();
  return out;
}

double McNemarExact(int only_a, int only_b) {
  TT_CHECK(only_a >= 0 && only_b >= 0);
  const int discordant = only_a + only_b;
  if (discordant == 0) return 1.0;
  const boost::math::binomial_distribution<double> fair(discordant, 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(fair, std::min(only_a, only_b)));
}

std::vector<double> HolmAdjusted(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double scaled = static_cast<double>(order.size() - i) * p_values[order[i]];
    largest = std::max(largest, std::min(1.0, scaled));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace tubetwin

#pragma once

#include <optional>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/statistics/statistics.h"

namespace tubetwin {

/// A share of trials as files and pages tell it: k of n with Wilson's interval and, where trials of
/// one round depend on each other, the interval by rounds.
struct Rate {
  Counts counts;
  std::optional<ShareInterval> by_cluster;
};

/// Whether trials of one cluster depend on each other.
enum class Trials {
  kIndependent,  ///< Wilson's interval says it all.
  kClustered,    ///< The attempts of a round.
};

/// The rate of all clusters together; of two or more with clustered trials also its interval by
/// ClusterWilson95(). One cluster cannot say how much clusters differ.
Rate RateOf(const std::vector<Counts>& clusters, Trials trials);

/// The interval to tell of a rate: by clusters where there is one, else Wilson's.
ShareInterval Interval95(const Rate& rate);

/// {k, n, wilson95: [low, high], cluster95?: [low, high]}.
Json ToJson(const Rate& rate);
Json ToJson(Counts counts);
/// Reads k and n of such an object; the intervals follow from them. Throws Error(kBadData).
Counts CountsFromJson(const JsonView& view);

/// SpreadOf() of the values; nothing when there is none.
std::optional<Spread> OptionalSpread(const std::vector<double>& values);
/// {n, mean, sd, p5, median, p95, max}, or null.
Json ToJson(const std::optional<Spread>& spread);

}  // namespace tubetwin

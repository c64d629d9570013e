#pragma once

#include <optional>
#include <vector>

#include "models/base/json_fwd.h"
#include "models/base/random.h"
#include "twin/statistics/statistics.h"

namespace tubetwin {

/// A share of trials as files and pages tell it: k of n with Wilson's interval and, where trials of
/// one round depend on each other, the interval of a bootstrap that draws whole rounds.
struct Rate {
  Counts counts;
  std::optional<ShareInterval> by_cluster;
};

/// The rate of all clusters together. With `random`, also its interval by ClusterBootstrap95().
Rate RateOf(const std::vector<Counts>& clusters, const std::optional<RandomStream>& random);

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

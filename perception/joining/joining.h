#pragma once

#include <vector>

#include "perception/joining/bridges.h"

namespace tubetwin {

/// Fragments in the order in which one tube passes through them.
struct Chain {
  std::vector<int> ends;     ///< Entry end of each fragment: 2 * fragment + end.
  std::vector<int> bridges;  ///< Index into the bridges, one less than fragments.
  double length_m = 0.0;     ///< Fragments and bridges.
  double cost = 0.0;
  /// By how much (nats) the cost of the whole scene would rise if this chain were not allowed; at
  /// most kMaxMargin. Large: there is no good alternative.
  double margin = 0.0;
};

inline constexpr double kMaxMargin = 6.0;

/// The most likely assignment of all fragments to tubes: every fragment is in exactly one chain,
/// and the sum of the chains' costs is smallest. A chain costs what its bridges cost, and more the
/// more it is shorter than a tube, as far as its two ends cannot hide the rest (`max_extensions_m`,
/// by end). Exact for the usual piles: branch and bound over sets of chains with bounds from
/// Lagrangian duals. After a fixed number of steps the best assignment found so far is taken.
std::vector<Chain> JoinFragments(const std::vector<Fragment>& fragments,
                                 const std::vector<Bridge>& bridges,
                                 const std::vector<double>& max_extensions_m, double tube_length_m);

}  // namespace tubetwin

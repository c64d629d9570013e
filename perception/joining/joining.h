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
  /// How much dearer (in nats) the best explanation of the scene without this chain is; at most
  /// kMostMargin.
  double margin = 0.0;
};

inline constexpr double kMostMargin = 6.0;

/// Most likely way to make tubes of all fragments: every fragment in exactly one chain, no chain
/// longer than a tube, each chain charged for its bridges and for the length that it lacks beyond
/// what its ends can hide (`rooms_m`, by end). Exact for the usual piles (branch and bound over
/// sets of chains with bounds from Lagrangian duals, and a step limit that keeps the best found).
std::vector<Chain> JoinFragments(const std::vector<Fragment>& fragments,
                                 const std::vector<Bridge>& bridges,
                                 const std::vector<double>& rooms_m, double tube_length_m);

}  // namespace tubetwin

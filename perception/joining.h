#pragma once

#include <vector>

#include "perception/bridges.h"

namespace tubetwin {

/// Fragments in the order in which one tube passes through them.
struct Chain {
  std::vector<int> ends;     ///< Entry end of each fragment: 2 * fragment + end.
  std::vector<int> bridges;  ///< Index into the bridges, one less than fragments.
  double length_m = 0.0;     ///< Fragments and bridges.
  double cost = 0.0;
};

/// Cheapest way to make tubes of all fragments: every fragment in exactly one chain, no chain
/// longer than a tube, each chain charged for its bridges and for the length it lacks. Exact for
/// the usual few fragments (branch and bound over sets of chains, with a step limit that keeps the
/// best found).
std::vector<Chain> JoinFragments(const std::vector<Fragment>& fragments,
                                 const std::vector<Bridge>& bridges, double tube_length_m);

}  // namespace tubetwin

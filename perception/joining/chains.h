#pragma once

#include <vector>

#include "perception/joining/joining.h"

namespace tubetwin {

/// The candidate chains for JoinFragments: no longer than a tube, and cheaper than the same
/// fragments in two separate chains. Every fragment alone is one of them. Sorted by cost.
std::vector<Chain> FindChains(const std::vector<Fragment>& fragments,
                              const std::vector<Bridge>& bridges,
                              const std::vector<double>& max_extensions_m, double tube_length_m);

}  // namespace tubetwin

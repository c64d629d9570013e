#pragma once

#include <vector>

#include "perception/joining/joining.h"

namespace tubetwin {

/// All chains that are worth a thought: no longer than a tube, and dearer in pieces. Every fragment
/// alone is among them. Ascending in cost.
std::vector<Chain> FindChains(const std::vector<Fragment>& fragments,
                              const std::vector<Bridge>& bridges,
                              const std::vector<double>& rooms_m, double tube_length_m);

}  // namespace tubetwin

#pragma once

#include <vector>

#include "scenes/pile.h"

namespace tubetwin {

/// How often each tube of a pile is under another, by truth: one for each run of its samples
/// (1 mm apart) that another tube covers (within one radius horizontally, more than a radius
/// above). 0 is a free tube, 1 weakly, 2 or more strongly occluded.
std::vector<int> CoveredRuns(const Pile& pile);

/// Number of tubes that nothing covers.
int CountFree(const Pile& pile);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"
#include "perception/view/floor_ways.h"

namespace tubetwin {

/// One way of each view, so that all agree about what lies in the bin.
struct ChosenWays {
  std::vector<FloorWay> ways;  ///< Of each view; empty: see why_none.
  std::string why_none;
};

/// Chooses among the ways in which each cloud may see the bin. Two views of the same pile show the
/// same heights where both look; views are placed one after another by what they have in common
/// with those placed before. `ways[v]`: those of view v, in whose S they hold; of view 0 its turns
/// left out, of the others all.
ChosenWays ChooseByCommonHeights(const std::vector<OrganizedCloud>& clouds,
                                 const std::vector<std::vector<FloorWay>>& ways, const Bin& bin);

}  // namespace tubetwin

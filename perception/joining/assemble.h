#pragma once

#include <vector>

#include "perception/joining/joining.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// Turns chains into tubes: fragments and bridges become one centerline, which is extended at its
/// ends to the part's length where occluded space allows it. Chains of which too little was seen,
/// and those that lie wholly outside the bin, are left out. Ids count from 0 in the order of the
/// chains' first fragments.
std::vector<PerceivedTube> AssembleTubes(const std::vector<Chain>& chains,
                                         const std::vector<Fragment>& fragments,
                                         const std::vector<Bridge>& bridges,
                                         const OccludedSpace& space, const Bin& bin,
                                         double tube_length_m);

}  // namespace tubetwin

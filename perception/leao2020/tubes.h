#pragma once

#include <vector>

#include "models/part.h"
#include "perception/leao2020/join.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// Virtual tubes as all later steps know tubes: cylinders' axes and joints in one centerline (ends
/// that overlap meet halfway), those shorter than Table 2 allows discarded, `class_paper` by the
/// occluded joints, confidence the share of the part's length that was modelled. Nodes of occluded
/// joints are the invisible ones. Crossings and geometric classes are left to AssignClasses.
std::vector<PerceivedTube> MakeLeaoTubes(const std::vector<LeaoTube>& chains,
                                         const std::vector<LeaoCylinder>& cylinders,
                                         const Part& part, const Leao2020Config& config);

}  // namespace tubetwin

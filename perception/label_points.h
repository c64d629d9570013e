#pragma once

#include <cstdint>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/base/parallel.h"
#include "models/bin.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// For every point of a cloud, whose it is by the perceived scene: kLabelFirstTube + index of the
/// tube whose surface it lies on (nearest axis, at most 1.25 radii off), kLabelCell for every other
/// return, kLabelNone where there is none. Points of floor and walls never get a tube's label.
/// [cloud.size()]. About 30 ns a point; does not depend on the thread count.
std::vector<std::uint32_t> LabelPoints(const OrganizedCloud& cloud, const TubeScene& scene,
                                       const Bin& bin, Parallelism parallelism);

}  // namespace tubetwin

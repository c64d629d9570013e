#pragma once

#include "models/bin.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// Sets `bin_content` and `bin_content_reason` from tubes, unexplained points and what the views
/// leave open. A tube may hide where a whole one fits on the floor of which no view would see any
/// part; above other tubes none hides that those do not betray. Cheap unless nothing was seen.
void JudgeBinContent(TubeScene& scene, const std::vector<ViewImage>& views, const Part& part,
                     const Bin& bin);

}  // namespace tubetwin

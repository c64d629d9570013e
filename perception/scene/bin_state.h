#pragma once

#include "models/bin.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// Sets `bin_content` and `bin_content_reason`. The bin is not empty when tubes or unexplained
/// points are seen. When nothing is seen it counts as empty only if no whole tube could lie on the
/// floor without any view seeing a part of it. Cheap unless nothing was seen.
void JudgeBinContent(TubeScene& scene, const std::vector<ViewImage>& views, const Part& part,
                     const Bin& bin);

}  // namespace tubetwin

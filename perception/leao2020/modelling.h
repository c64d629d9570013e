#pragma once

#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/base/parallel.h"
#include "models/bin.h"
#include "models/part.h"
#include "perception/leao2020/config.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// Tube modelling and classification of Leão, Costa, Sousa, Veiga, "Detecting and Solving Tube
/// Entanglement in Bin Picking Operations", Appl. Sci. 2020, 10, 2264, sections 3.1 and 3.2:
/// filtering, segmentation, cylinder fitting, joining, least length, occluded joints. The
/// baseline that other methods are compared with. The paper takes one view; several are fused by
/// their poses. `class_paper` counts occluded joints, `tube_class` crossings of its own tubes.
/// The paper has no certainty: confidence is the share of the part's length that was modelled.
/// `block_m`: pixel of the depth image that the visibility condition looks at. Results do not
/// depend on the thread count. Throws like Perceive.
TubeScene PerceiveLeao2020(const std::vector<OrganizedCloud>& views, const Part& part,
                           const Bin& bin, double block_m, const Leao2020Config& config,
                           Parallelism parallelism);

}  // namespace tubetwin

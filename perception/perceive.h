#pragma once

#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/base/config/config.h"
#include "models/base/parallel.h"
#include "models/bin.h"
#include "models/part.h"
#include "perception/leao2020/config.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// Config table [perception]. Lengths in metres. Defaults are for the scanner of the cell.
struct PerceptionConfig {
  std::string profile = "best";
  double block_m = 0.0007;     ///< Side of the pixel blocks that are averaged first.
  bool register_views = true;  ///< Correct the believed poses by the floor and walls that are seen.
  Leao2020Config leao2020;     ///< Used by the profile leao2020 only.
  void Visit(ConfigVisitor& v);
};

/// Tubes and crossings from clouds alone: axis-space method and joining by matching with vetoes, or
/// PerceiveLeao2020 when the profile says so.
/// `views`: at least one, organised or not, each with the pose that is believed. Radius and length
/// come from `part`. Never reads labels. Results do not depend on the thread count. A cloud without
/// any valid point is fine: nothing was seen. Throws Error(kBadData) when there is no view, a pose
/// is not finite or a cloud's sizes disagree.
TubeScene Perceive(const std::vector<OrganizedCloud>& views, const Part& part, const Bin& bin,
                   const PerceptionConfig& config, Parallelism parallelism);

}  // namespace tubetwin

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"
#include "perception/view/floor_pose.h"
#include "twin/app/common.h"

namespace CLI {
class Option;
}

namespace tubetwin {

/// Clouds from files and what must be known about them.
struct CloudInput {
  std::vector<std::string> clouds;
  std::string part, bin, profile, pose, units;
};

/// Adds --part, --bin, --profile, --pose and --units to a verb; returns --part.
CLI::Option* AddCloudOptions(CLI::App& verb, CloudInput& input);

/// Adds --units: that of a cloud's lengths.
void AddUnitsOption(CLI::App& verb, std::string& units);

/// Clouds as the pipeline gets them: each with a pose, none with labels.
struct ViewsOfFiles {
  std::vector<OrganizedCloud> clouds;
  std::optional<FloorPose> fitted;  ///< Where their poses come from with --pose floor.
};

/// Reads the clouds; --pose wins over what the files say. Throws Error(kBadData) for files without
/// a pose where none is given, with hardly a point, or none in the bin, and when floor and walls do
/// not fix the pose.
ViewsOfFiles ReadViews(const CloudInput& input, const Bin& bin, const Common& common);

}  // namespace tubetwin

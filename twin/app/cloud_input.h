#pragma once

#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"
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

/// The clouds as the pipeline gets them: each with a pose, none with labels. --pose wins over what
/// the files say. Throws Error(kBadData) for files without a pose where none is given, with hardly
/// a point, or none in the bin.
std::vector<OrganizedCloud> ReadViews(const CloudInput& input, const Bin& bin,
                                      const Common& common);

}  // namespace tubetwin

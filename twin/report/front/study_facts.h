#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/report/front/study_setup.h"

namespace tubetwin {

/// Names and plain texts that a front page tells.
using FactTexts = std::vector<std::pair<std::string, std::string>>;

/// Part, bin, cell, devices, scans of one variant; a dash for what its files do not say. The same
/// names in the same order for every variant.
FactTexts StudyFacts(const StudySetup& setup);

/// What was assumed: physics that rounds draw or have, noise, speeds. Likewise.
FactTexts StudyAssumptions(const StudySetup& setup);

/// Where the part's numbers come from, what was fitted to what, and what rounds draw: what rates
/// rest on. Likewise.
FactTexts StudyGrounds(const StudySetup& setup);

/// What the numbers leave out, one sentence each.
const std::vector<std::string>& NotModelled();

/// Whether every device of the cell is simulated; true where the files do not say.
bool IsSimulated(const StudySetup& setup);

/// A number as people write it, at most four digits.
std::string PlainNumber(double value);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/finding.h"
#include "models/base/json_fwd.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// Judges the scenario's cell for its part and pile before anything runs (planner/cell_check).
/// `folder` as in ScenarioBin. Throws as ScenarioModel, LoadPart and LoadPile do.
std::vector<Finding> CheckScenario(const Scenario& scenario, const std::string& folder);

/// A line for each finding, columns aligned; those that are not ok with their remedy below.
std::string FindingsTable(const std::vector<Finding>& findings);

/// [{verdict, what, found, allowed, remedy}].
Json FindingsJson(const std::vector<Finding>& findings);

/// Throws Error(kConfig) naming the first impossible finding with its remedy, and how many more
/// there are.
void RequirePossible(const std::vector<Finding>& findings);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/error.h"
#include "models/base/finding.h"
#include "models/base/json_fwd.h"
#include "models/part_fit/part_fit.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// Judges the scenario's cell for its part and pile before anything runs (planner/cell_check).
/// Throws as ScenarioModel, LoadPart and LoadPile do.
std::vector<Finding> CheckScenario(const Scenario& scenario);

/// What the scenario's cell and configuration judge a part by.
PartFitCell PartFitOf(const Scenario& scenario, const CellModel& model);

/// Judges the scenario's part (JudgePart). Throws as LoadPart does.
std::vector<Finding> CheckScenarioPart(const Scenario& scenario);

/// A line for each finding, columns aligned; those that are not ok with their remedy below.
std::string FindingsTable(const std::vector<Finding>& findings);

/// [{verdict, what, found, allowed, remedy}].
Json FindingsJson(const std::vector<Finding>& findings);

/// Throws an Error of `kind` naming the first impossible finding with its remedy, and how many more
/// there are. `who`: "the cell".
void RequirePossible(const std::vector<Finding>& findings, const std::string& who = "the cell",
                     ErrorKind kind = ErrorKind::kConfig);

}  // namespace tubetwin

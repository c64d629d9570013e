#pragma once

#include "models/base/json_fwd.h"
#include "models/base/parallel.h"
#include "twin/cell/twin_cell.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// The pile as it lies when the round of the scenario starts: `asked` (ScenarioPile) after
/// settling, unless it was generated settled. Throws Error(kBadData) when it does not settle.
Pile StartPile(const Scenario& scenario, const Pile& asked, const RoundPhysics& physics);

/// How the twin of the scenario is made for a round with that physics.
TwinCellOptions ScenarioTwin(const Scenario& scenario, const RoundPhysics& physics,
                             Parallelism parallelism);

/// What lies where in a twin now, by truth, for people and tests beside `emulate`: {placed_ids,
/// in_bin_ids, held_ids, outside_ids, tubes: [{id, centre_of_mass_m in B, speed_m_s}]}.
Json WhatLiesWhere(const TwinCell& twin);

}  // namespace tubetwin

#include "twin/round/twin_setup.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/cell/truth.h"
#include "twin/round/scoring.h"

namespace tubetwin {

Pile StartPile(const Scenario& scenario, const Pile& asked, const RoundPhysics& physics) {
  if (asked.settled && scenario.pile.file.empty()) return asked;
  const SettleResult settled = SettlePile(asked, physics);
  if (settled.status == SettleStatus::kDiverged) {
    throw Error(ErrorKind::kBadData,
                scenario.pile.file + ": the pile does not settle: " + settled.reason);
  }
  return settled.pile;  // Escaped tubes are part of the truth: they will not be placed.
}

TwinCellOptions ScenarioTwin(const Scenario& scenario, const RoundPhysics& physics,
                             Parallelism parallelism) {
  TwinCellOptions options;
  options.model = ScenarioModel(scenario);
  options.physics = physics;
  options.seed = static_cast<std::uint64_t>(scenario.seed);
  options.scan = ScenarioScan(scenario, options.model, physics);
  options.parallelism = parallelism;
  return options;
}

Json WhatLiesWhere(const TwinCell& twin) {
  const Truth truth(twin);
  const std::vector<Truth::Tube> tubes = truth.Tubes();
  Json out{{"placed_ids", CountTray(tubes, {}).placed_ids},
           {"in_bin_ids", Json::array()},
           {"held_ids", Json::array()},
           {"outside_ids", Json::array()},
           {"tubes", Json::array()}};
  for (const Truth::Tube& tube : tubes) {
    if (tube.hangs || tube.touches_pads) {
      out["held_ids"].push_back(tube.id);
    } else if (tube.outside) {
      out["outside_ids"].push_back(tube.id);
    } else if (tube.over_bin) {
      out["in_bin_ids"].push_back(tube.id);
    }
    out["tubes"].push_back(Json{{"id", tube.id},
                                {"centre_of_mass_m", ToJson(tube.centre_of_mass_B)},
                                {"speed_m_s", tube.speed_m_s}});
  }
  return out;
}

}  // namespace tubetwin

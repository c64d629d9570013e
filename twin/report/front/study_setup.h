#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "models/part.h"
#include "scenes/pile.h"
#include "twin/campaign/campaign.h"

namespace tubetwin {

/// What the rounds of one variant were run with, as their files say it: what a front page names.
struct StudySetup {
  std::string name;                  ///< Of the variant.
  std::optional<Part> part;          ///< Nothing: the files do not say.
  int tubes = 0;                     ///< At the start of a round.
  std::optional<std::int64_t> seed;  ///< Of a round; a campaign's variants share its own.
  Json config;                       ///< The resolved keys, nested; null: not known.
  std::optional<Bin> bin;            ///< Of a start pile that was kept.
  /// Centerlines of the part in shapes of their own: the one that it has, else some that are drawn.
  std::vector<Polyline> shapes;
  /// Tubes of one start pile, frame N, where one was kept.
  std::vector<Polyline> pile_N;
};

/// Of each variant of a campaign; the part's shapes are drawn from the campaign's seed.
std::vector<StudySetup> SetupsOf(const CampaignIdentity& identity);

/// Of a round's result folder: config.resolved.toml, start.pile.json. What is not there, and a
/// configuration of another version that this one cannot read, is left out. Throws Error(kBadData)
/// for a damaged pile.
StudySetup SetupOfRound(const std::string& folder);

/// Adds the start pile of a kept round's folder, if it holds one.
void AddStartPile(const std::string& folder, StudySetup& setup);

/// A key of the configuration, "physics/pad_friction"; null where there is none.
Json KeyOf(const StudySetup& setup, const std::string& path);

}  // namespace tubetwin

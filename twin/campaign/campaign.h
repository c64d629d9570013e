#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "models/part.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// Table [keep]: what stays of rounds besides their rows. Rows never depend on it.
struct KeepConfig {
  int failures = 20;     ///< Rounds with a failed attempt whose folder is kept, per shard.
  double sample = 0.01;  ///< Share of rounds whose folder is kept whatever came of them.
  bool films = true;     ///< Draw failed attempts and sampled rounds.
  void Visit(ConfigVisitor& v);
};

/// One variant: a scenario that every round runs with a seed of its own.
struct CampaignVariant {
  std::string name;   ///< Unique; made of part, count, profile and set when the file names none.
  Scenario scenario;  ///< Its seed is a placeholder, RoundSeed() says the round's.
  Part part;          ///< What scenario.pile.part came to.
  int tubes = 0;      ///< At the start of each round.
};

/// A campaign: rounds 0 to rounds - 1 of every variant. Round r of all variants has the same seed.
struct Campaign {
  std::int64_t seed = 1;
  int rounds = 20;
  /// "development", or "claim": of a seed that nothing was run with before, to state a rate. It is
  /// said before the first round and stays with the rows; nobody can check what else was run.
  std::string purpose = "development";
  KeepConfig keep;
  std::vector<CampaignVariant> variants;
};

/// Reads a campaign file: `seed`, `rounds`, `purpose`, `[keep]`, and `[[variant]]` tables with
/// `name`, `part`, `count`, `profile` and `set = {key = value}` of scenario keys. A list where a
/// key takes one value (or a list of lists where it takes a list) makes a variant of each.
/// `overrides` are `a.b=value`: seed, rounds and keep.* of the campaign, anything else a scenario
/// key of every variant. Everything that rounds read is read once here, so that errors come before
/// any round: throws Error(kConfig | kMissing | kBadData).
Campaign LoadCampaign(const std::string& path, const std::vector<std::string>& overrides,
                      std::optional<std::int64_t> seed);

/// Seed of one round's scenario, below 2^53; the same in every variant.
std::int64_t RoundSeed(std::int64_t campaign_seed, int round);

/// campaign.json: all that rows depend on, with program, its build and the engine's version. Two
/// campaigns with equal documents give equal rows.
struct CampaignIdentity {
  Json document;  ///< The whole; what follows is read from it.
  std::string program, mujoco;
  std::string build;  ///< BuildId() of the program that runs it; empty in files of before 0.4.
  std::int64_t seed = 0;
  int rounds = 0;                     ///< Of each variant.
  std::string purpose;                ///< Campaign::purpose; empty in files of before 0.4.
  std::vector<std::string> variants;  ///< Their names.

  std::string fingerprint() const;  ///< Of the document.
};
CampaignIdentity IdentityOf(const Campaign& campaign, const std::string& program_version);
/// Throws Error(kBadData) naming `source`.
CampaignIdentity IdentityFromJson(Json document, const std::string& source);

/// The first key in which two identities differ with both values, for messages; nothing when equal.
std::optional<std::string> FirstDifference(const Json& mine, const Json& theirs);

/// What keeps two identities from being one campaign's.
struct IdentityDifference {
  std::string what;         ///< The first key that differs, with both values.
  bool build_only = false;  ///< All that rows were asked for is the same, the build is not.
};
/// Nothing when shards of both are one campaign's.
std::optional<IdentityDifference> DifferenceOf(const CampaignIdentity& mine,
                                               const CampaignIdentity& theirs);

/// Makes `folder` this campaign's: writes campaign.json, or checks the one that is there. Safe for
/// processes that claim at the same time. A campaign.json that is no JSON is kept as
/// campaign.json.damaged and written anew. Throws Error(kCannotCreate) when the folder belongs to
/// another campaign (naming the first key that differs) or build, or holds a single round.
void ClaimCampaignFolder(const std::string& folder, const CampaignIdentity& identity);

/// Reads FOLDER/campaign.json. Throws Error(kMissing) when the folder is no campaign's,
/// Error(kBadData).
CampaignIdentity ReadCampaignIdentity(const std::string& folder);

}  // namespace tubetwin

#pragma once

#include <string>

#include "models/base/json_fwd.h"
#include "twin/campaign/campaign.h"

namespace tubetwin {

/// What a campaign file says besides its variants.
struct CampaignKeys {
  Campaign& campaign;
  void Visit(ConfigVisitor& v);
};

/// The keys of a [[variant]] table as texts: what they take is said by the scenario's own keys, and
/// a list where a key takes one value makes a variant of each.
struct VariantKeys {
  std::string name, part, count, profile, set;
  void Visit(ConfigVisitor& v);
};

/// JSON Schema (draft 2020-12) of a campaign file; the keys of `set` are those of the scenario's.
Json CampaignSchema();

/// Every key of a campaign file with its default and meaning, a line each, for people.
std::string CampaignKeysText();

}  // namespace tubetwin

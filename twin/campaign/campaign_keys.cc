#include "twin/campaign/campaign_keys.h"

#include "models/base/json.h"

namespace tubetwin {
namespace {

template <class Keys>
Json SchemaOf(Keys keys) {
  return Json::parse(WriteConfigSchema([&keys](ConfigVisitor& v) { keys.Visit(v); }));
}

std::string KeyLine(const std::string& key, const Json& schema, bool with_default) {
  constexpr std::size_t kColumn = 15;
  std::string out = "  " + key;
  out.append(kColumn > key.size() ? kColumn - key.size() : 1, ' ');
  out += schema["description"].get<std::string>();
  if (with_default) out += "; default " + schema["default"].dump();
  return out + "\n";
}

}  // namespace

void CampaignKeys::Visit(ConfigVisitor& v) {
  v.Field("seed", "seed of the campaign; each round's is drawn from it", campaign.seed,
          {0, 9007199254740991.0});
  v.Field("rounds", "rounds of every variant", campaign.rounds, {1, 1000000});
  v.Choice("purpose",
           "what it is run for: development, or claim, to state a rate by a seed that nothing was "
           "run with before; said before the first round, it stays with the rows",
           campaign.purpose, {"development", "claim"});
  v.Section("keep", "what stays of rounds besides their rows", campaign.keep);
}

void VariantKeys::Visit(ConfigVisitor& v) {
  v.Field("name", "what reports call it; else made of its keys", name);
  v.Field("part", "part name or part file; as pile.part", part);
  v.Field("count", "tubes in the bin; as pile.count", count);
  v.Field("profile", "pipeline profile", profile);
  v.Field("set", "scenario keys, {a.b = 1}: those of `tubetwin config dump`", set);
}

Json CampaignSchema() {
  Campaign campaign;
  Json out = SchemaOf(CampaignKeys{campaign});
  Json variant = SchemaOf(VariantKeys());
  variant.erase("$schema");
  for (auto& [name, key] : variant["properties"].items()) {
    key.erase("default");
    if (name == "set") {
      key["type"] = "object";
    } else if (name != "name") {
      key["type"] = Json::array({name == "count" ? "integer" : "string", "array"});
    }
  }
  out["properties"]["variant"] = Json{{"description", "a scenario that every round runs"},
                                      {"type", "array"},
                                      {"minItems", 1},
                                      {"items", std::move(variant)}};
  return out;
}

std::string CampaignKeysText() {
  const Json schema = CampaignSchema();
  std::string out;
  for (const auto& [name, key] : schema["properties"].items()) {
    if (!key.contains("properties") && !key.contains("items")) out += KeyLine(name, key, true);
  }
  out += "[keep]: " + schema["properties"]["keep"]["description"].get<std::string>() + "\n";
  for (const auto& [name, key] : schema["properties"]["keep"]["properties"].items()) {
    out += KeyLine(name, key, true);
  }
  out += "[[variant]]: " + schema["properties"]["variant"]["description"].get<std::string>() +
         ", one table each; a list in place of a value makes a variant of each\n";
  for (const auto& [name, key] : schema["properties"]["variant"]["items"]["properties"].items()) {
    out += KeyLine(name, key, false);
  }
  return out;
}

}  // namespace tubetwin

#include "twin/campaign/campaign.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "models/base/disk/build_id.h"
#include "models/base/disk/file_lock.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/json_text.h"
#include "models/base/random.h"
#include "models/base/text.h"
#include "scenes/engine/engine_error.h"
#include "twin/campaign/campaign_keys.h"
#include "twin/campaign/shard_file.h"
#include "twin/round/records/json_fields.h"
#include "twin/round/round_checkpoint.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr int kMostRounds = 1000000, kMostVariants = 1000;

bool IsCampaignKey(const std::string& override_text) {
  const std::string first = override_text.substr(0, override_text.find_first_of(".= \t"));
  return first == "seed" || first == "rounds" || first == "purpose" || first == "keep";
}

/// "pvc_a x 7, leao2020, resolution.strategy=plus45".
std::string VariantName(const std::string& given, bool alone, const ConfigSource& keys,
                        const CampaignVariant& variant) {
  if (!given.empty() && alone) return given;
  std::vector<std::string> parts;
  if (!given.empty()) parts.push_back(given);
  parts.push_back(variant.part.name + " x " + std::to_string(variant.tubes));
  if (variant.scenario.profile != Scenario().profile) parts.push_back(variant.scenario.profile);
  for (const auto& [key, value] : keys.Texts()) {
    if (key == "pile.part" || key == "pile.count" || key == "profile") continue;
    parts.emplace_back(key).append("=").append(value);
  }
  return Join(parts);
}

/// Reads what rounds will read, so that a missing part or pile is told before the first.
void ReadInputs(CampaignVariant& variant, int rounds) {
  Scenario& scenario = variant.scenario;
  RequireTwin(scenario, "a campaign");
  ScenarioVisuals(scenario);
  if (!scenario.pile.file.empty()) {
    Scenario first = scenario;
    std::error_code unknown;  // Then it is read as a file, which says why.
    if (fs::is_directory(scenario.pile.file, unknown)) {
      const std::vector<std::string> files = PileFilesOf(scenario);
      if (static_cast<int>(files.size()) < rounds) {
        throw Error(ErrorKind::kMissing, scenario.pile.file + ": holds " +
                                             std::to_string(files.size()) + " piles (*.json) for " +
                                             std::to_string(rounds) +
                                             " rounds; each needs its own");
      }
      first.pile.file = files.front();
    }
    const Pile pile = AskedPile(first);
    variant.part = pile.part;
    variant.tubes = static_cast<int>(pile.tubes.size());
    return;
  }
  variant.part = LoadPart(ScenarioPartName(scenario));
  variant.tubes = scenario.pile.count;
  ScenarioBin(scenario, std::nullopt);
}

void AddVariants(ConfigSource table, const std::string& where,
                 const std::vector<std::string>& overrides, Campaign& campaign) {
  ConfigSource keys = table.TakeTable("set");
  table.MoveKey("part", keys, "pile.part");
  table.MoveKey("count", keys, "pile.count");
  table.MoveKey("profile", keys, "profile");
  VariantKeys left;
  table.ReadInto(left);
  if (!IsPlainUtf8(left.name)) {
    throw Error(ErrorKind::kConfig, where + ": name is '" + Printable(left.name) +
                                        "'; allowed: UTF-8 without control characters");
  }
  Scenario any;
  std::vector<ConfigSource> grid = keys.ExpandLists([&any](ConfigVisitor& v) { any.Visit(v); });
  for (ConfigSource& point : grid) {
    for (const std::string& text : overrides) point.AddOverride(text);
    CampaignVariant variant;
    variant.scenario = ReadScenario(point);
    const auto texts = point.Texts();
    if (std::any_of(texts.begin(), texts.end(), [](const auto& t) { return t.first == "seed"; })) {
      throw Error(ErrorKind::kConfig,
                  where +
                      ": set: seed: rounds of all variants share the seeds that come from the "
                      "campaign's; give it at the top");
    }
    ReadInputs(variant, campaign.rounds);
    variant.name = VariantName(left.name, grid.size() == 1, point, variant);
    campaign.variants.push_back(std::move(variant));
  }
}

/// Every round of every variant is a task in memory, and its rows are later.
void RequireFewRounds(const Campaign& campaign, const std::string& path) {
  const std::size_t variants = campaign.variants.size();
  const std::size_t all = variants * static_cast<std::size_t>(campaign.rounds);
  if (variants <= std::size_t{kMostVariants} && all <= std::size_t{kMostRounds}) return;
  throw Error(ErrorKind::kConfig,
              path + ": " + std::to_string(variants) + " variants of " +
                  std::to_string(campaign.rounds) + " rounds are " + std::to_string(all) +
                  " rounds; allowed: " + std::to_string(kMostVariants) + " variants and " +
                  std::to_string(kMostRounds) + " rounds in all");
}

/// A claim rests on rounds that nothing was tuned with. The default seed was surely used.
void RequireOwnSeed(const Campaign& campaign, const std::string& path) {
  if (campaign.purpose != "claim" || campaign.seed != Campaign().seed) return;
  throw Error(ErrorKind::kConfig,
              path + ": purpose is 'claim' and seed is " + std::to_string(campaign.seed) +
                  ", the default, which development uses\nallowed: any other; give seed = a number "
                  "that nothing was run with before");
}

/// The tables of variants; earlier campaign files call them arms.
std::vector<ConfigSource> TakeVariants(ConfigSource& source, const std::string& path) {
  std::vector<ConfigSource> variants = source.TakeTables("variant");
  std::vector<ConfigSource> arms = source.TakeTables("arm");
  if (variants.empty()) return arms;
  if (!arms.empty()) {
    throw Error(ErrorKind::kConfig,
                path + ": has [[variant]] and [[arm]] tables, which are the same: use [[variant]]");
  }
  return variants;
}

/// Files by their names alone: shards may run in other folders. What is in them is in the
/// fingerprints and in what follows from the keys.
void NameFilesOnly(Scenario& scenario) {
  for (std::string* file : {&scenario.pile.file, &scenario.bin.mesh}) {
    *file = fs::path(*file).filename().string();
  }
  for (std::string* file : {&scenario.pile.part, &scenario.part.name, &scenario.cell.model}) {
    if (file->ends_with(".toml")) *file = fs::path(*file).filename().string();
  }
  for (std::string& file : scenario.cell.arm.visual_meshes) {
    file = fs::path(file).filename().string();
  }
}

/// Of a user's own cell files.
std::string FingerprintOf(const CellFiles& files) {
  std::string texts;
  for (const ModelFile* file :
       {&files.cell, &files.arm, &files.gripper, &files.wrist, &files.scanner}) {
    texts += file->text;
  }
  return Fingerprint(texts);
}

Json VariantJson(const CampaignVariant& variant, int index) {
  const Scenario& scenario = variant.scenario;
  Scenario named = scenario;
  NameFilesOnly(named);
  Json out;
  out["variant"] = index;
  out["config"] = Json::parse(WriteConfigJson([&named](ConfigVisitor& v) { named.Visit(v); }));
  out["config"].erase("seed");  // Each round has its own.
  if (!scenario.pile.file.empty()) {
    std::vector<std::string> files = PileFilesOf(scenario);
    if (files.empty()) files = {scenario.pile.file};
    std::string content;
    for (const std::string& file : files) content += ReadFile(file);
    out["pile_fingerprint"] = Fingerprint(content);
  }
  if (!scenario.bin.mesh.empty()) {
    out["bin_mesh_fingerprint"] = Fingerprint(ReadFile(scenario.bin.mesh));
  }
  const CellFiles cell = LoadCellModel(scenario.cell.model).files;
  if (!cell.cell.shipped) out["cell_fingerprint"] = FingerprintOf(cell);
  // What follows from the keys comes after them: a difference names the key.
  out["part"] = PartToJson(variant.part);
  out["tubes"] = variant.tubes;
  out["name"] = variant.name;
  return out;
}

std::string KeyOf(std::string pointer) {
  std::replace(pointer.begin(), pointer.end(), '/', '.');
  return pointer.empty() ? pointer : pointer.substr(1);
}

}  // namespace

void KeepConfig::Visit(ConfigVisitor& v) {
  v.Field("failures", "rounds with a failed attempt whose folder is kept, per shard", failures,
          {0, 1000000});
  v.Field("sample", "share of rounds whose folder is kept whatever came of them", sample, {0, 1});
  v.Field("films", "draw failed attempts and sampled rounds", films);
}

Campaign LoadCampaign(const std::string& path, const std::vector<std::string>& overrides,
                      std::optional<std::int64_t> seed) {
  ConfigSource source;
  source.AddFile(path);
  std::vector<std::string> for_variants;
  for (const std::string& text : overrides) {
    if (IsCampaignKey(text)) {
      source.AddOverride(text);
    } else {
      for_variants.push_back(text);
    }
  }
  std::vector<ConfigSource> tables = TakeVariants(source, path);
  Campaign campaign;
  CampaignKeys keys{campaign};
  source.ReadInto(keys);
  if (seed) campaign.seed = *seed;
  RequireOwnSeed(campaign, path);
  if (tables.empty()) {
    throw Error(ErrorKind::kConfig,
                path +
                    ": no [[variant]] table; at least one is needed, for example\n"
                    "[[variant]]\npart = \"pvc_a\"\ncount = 7");
  }
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string where = path + ": variant " + std::to_string(i);
    try {
      AddVariants(std::move(tables[i]), where, for_variants, campaign);
    } catch (const Error& error) {
      // A part or pile that is not there does not say who asked for it.
      const std::string what = error.what();
      if (what.starts_with(path) || what.starts_with("--set")) throw;
      throw Error(error.kind(), std::string(where).append(": ").append(what));
    }
    RequireFewRounds(campaign, path);
  }
  std::set<std::string> names;
  for (const CampaignVariant& variant : campaign.variants) {
    if (!names.insert(variant.name).second) {
      throw Error(ErrorKind::kConfig, path + ": two variants are called '" + variant.name +
                                          "'; each needs its own name");
    }
  }
  return campaign;
}

std::int64_t RoundSeed(std::int64_t campaign_seed, int round) {
  RandomStream stream(static_cast<std::uint64_t>(campaign_seed), static_cast<std::uint64_t>(round),
                      "round");
  const std::uint64_t high = stream.NextBits() >> 5;  // 27 bits
  const std::uint64_t low = stream.NextBits() >> 6;   // 26 bits
  return static_cast<std::int64_t>((high << 26) | low);
}

std::string CampaignIdentity::fingerprint() const { return Fingerprint(document.dump()); }

CampaignIdentity IdentityOf(const Campaign& campaign, const std::string& program_version) {
  Json out;
  out["schema"] = "tubetwin/campaign/2";
  out["program"] = program_version;
  out["build"] = BuildId();
  out["mujoco"] = EngineVersion();
  out["seed"] = campaign.seed;
  out["rounds"] = campaign.rounds;
  out["purpose"] = campaign.purpose;
  out["variants"] = Json::array();
  for (std::size_t i = 0; i < campaign.variants.size(); ++i) {
    out["variants"].push_back(VariantJson(campaign.variants[i], static_cast<int>(i)));
  }
  return IdentityFromJson(std::move(out), "campaign.json");
}

CampaignIdentity IdentityFromJson(Json document, const std::string& source) {
  CampaignIdentity out;
  const JsonView view(document, source);
  const int version = SchemaVersion(view, "campaign", 2);
  out.program = view.Field("program").AsString();
  if (const auto build = view.Optional("build")) out.build = build->AsString();
  out.mujoco = view.Field("mujoco").AsString();
  out.seed = view.Field("seed").AsInteger();
  out.rounds = IntegerIn(view.Field("rounds"), 1, kMostRounds);
  if (const auto purpose = view.Optional("purpose")) out.purpose = purpose->AsString();
  const JsonView variants = view.Field(version == 1 ? "arms" : "variants");
  for (std::size_t i = 0; i < variants.Size(); ++i) {
    out.variants.push_back(variants.Item(i).Field("name").AsString());
  }
  out.document = std::move(document);
  return out;
}

std::optional<std::string> FirstDifference(const Json& mine, const Json& theirs) {
  if (mine == theirs) return std::nullopt;
  const Json a = mine.flatten(), b = theirs.flatten();
  for (const auto& [key, value] : a.items()) {
    if (!b.contains(key)) return KeyOf(key) + " is " + value.dump() + " against nothing";
    if (b[key] != value) return KeyOf(key) + " is " + value.dump() + " against " + b[key].dump();
  }
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key)) return KeyOf(key) + " is nothing against " + value.dump();
  }
  return "the order of keys";  // Equal content, written by another version.
}

std::optional<IdentityDifference> DifferenceOf(const CampaignIdentity& mine,
                                               const CampaignIdentity& theirs) {
  Json here = mine.document, there = theirs.document;
  for (Json* document : {&here, &there}) document->erase("build");
  if (const auto what = FirstDifference(here, there)) return IdentityDifference{*what};
  if (mine.build == theirs.build) return std::nullopt;
  const auto name = [](const CampaignIdentity& of) {
    return of.build.empty() ? std::string("?") : of.build;
  };
  return IdentityDifference{"build is " + name(mine) + " against " + name(theirs), true};
}

namespace {

/// The identity in a folder's campaign.json; nothing when there is none, or half a one as a power
/// cut leaves it, which is kept beside. The heads of shards say whose they are all the same.
std::optional<CampaignIdentity> FoundIdentity(const std::string& folder, const std::string& file) {
  if (!fs::exists(file)) return std::nullopt;
  if (!Json::accept(ReadFile(file))) {
    RenameDurably(file, file + ".damaged");
    return std::nullopt;
  }
  return ReadCampaignIdentity(folder);
}

/// Throws unless no file of a merged result or a round is there.
void RequireFree(const std::string& folder) {
  for (const char* name : {"picks.jsonl", "timings.jsonl", "rounds.jsonl", "summary.json",
                           "manifest.json", "config.resolved.toml"}) {
    if (fs::exists(fs::symlink_status(fs::path(folder) / name))) {
      throw Error(ErrorKind::kCannotCreate,
                  folder + ": holds " + name + ", which is no campaign's; give another --out");
    }
  }
}

}  // namespace

void ClaimCampaignFolder(const std::string& folder, const CampaignIdentity& identity) {
  MakeFolder(folder);
  const fs::path out(folder);
  const auto lock = FileLock::Take((out / "campaign.lock").string());
  const std::string file = (out / "campaign.json").string();
  const std::optional<CampaignIdentity> found = FoundIdentity(folder, file);
  if (!found) {
    if (ShardFiles(folder).empty()) RequireFree(folder);
    WriteJsonFile(identity.document, file);
    return;
  }
  const auto schema = [](const CampaignIdentity& of) { return of.document["schema"]; };
  if (schema(*found) != schema(identity)) {
    throw Error(ErrorKind::kCannotCreate,
                folder + ": holds a campaign of another version of the program (" +
                    schema(*found).get<std::string>() +
                    "); it can be read and merged, not gone on with; give another --out");
  }
  const auto difference = DifferenceOf(identity, *found);
  if (!difference) return;
  const std::string what = difference->what + " there";
  throw Error(ErrorKind::kCannotCreate,
              difference->build_only
                  ? folder + ": its rounds are of another build of this program: " + what +
                        "\ngo on with that build (`tubetwin --version` tells a program's), or give "
                        "another --out to begin anew; what is there can be merged"
                  : folder + ": holds another campaign: " + what +
                        "; give another --out, or the old configuration to go on with it");
}

CampaignIdentity ReadCampaignIdentity(const std::string& folder) {
  const std::string file = (fs::path(folder) / "campaign.json").string();
  if (!fs::exists(file)) {
    throw Error(ErrorKind::kMissing, folder + ": holds no campaign (campaign.json is missing)");
  }
  if (fs::is_empty(file)) {
    throw Error(ErrorKind::kBadData,
                file +
                    ": is empty, as a power cut may leave it; `campaign run` of the same "
                    "campaign into this folder writes it anew");
  }
  return IdentityFromJson(ReadJsonFile(file), file);
}

}  // namespace tubetwin

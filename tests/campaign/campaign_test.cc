#include "twin/campaign/campaign.h"
#include "models/base/json.h"

#include <fstream>

#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign_keys.h"
#include "twin/campaign/campaign_round.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

Campaign Load(const TemporaryFolder& folder, const std::string& text,
              const std::vector<std::string>& overrides = {}) {
  std::ofstream(folder / "C.toml") << text;
  return LoadCampaign(folder / "C.toml", overrides, std::nullopt);
}

void CheckTextRefused(const std::string& text, ErrorKind kind, const std::string& said) {
  INFO(text);
  const TemporaryFolder folder;
  try {
    Load(folder, text);
    FAIL("not refused");
  } catch (const Error& e) {
    CHECK(e.kind() == kind);
    CHECK_THAT(e.what(), Contains(said));
  }
}

}  // namespace

TEST_CASE("a campaign file gives variants of part, count, profile and set") {
  const TemporaryFolder folder;
  const Campaign campaign = Load(folder, R"(
seed = 5
rounds = 40
[[variant]]
part = "pvc_a"
count = 7
profile = "best"
[[variant]]
name = "hoses"
part = "hose_b"
count = 9
set = {planner.exclude_free = true, "pile.arrangement" = "threaded", physics.randomize = false}
)");
  CHECK(campaign.seed == 5);
  CHECK(campaign.rounds == 40);
  REQUIRE(campaign.variants.size() == 2);
  CHECK(campaign.variants[0].name == "pvc_a x 7");
  CHECK(campaign.variants[0].part.name == "pvc_a");
  CHECK(campaign.variants[1].name == "hoses");
  CHECK(campaign.variants[1].tubes == 9);
  CHECK(campaign.variants[1].scenario.planner.exclude_free);
  CHECK(campaign.variants[1].scenario.pile.arrangement == "threaded");
  CHECK_FALSE(campaign.variants[1].scenario.physics.randomize);
}

TEST_CASE("lists make a variant of each combination, named by what differs") {
  const TemporaryFolder folder;
  const Campaign campaign = Load(folder, R"(
[[variant]]
part = ["pvc_a", "hose_b"]
count = [3, 7]
set = {resolution.strategy = ["plus45", "plus45_minus45"], bin.size_m = [0.77, 0.58, 0.09]}
)");
  REQUIRE(campaign.variants.size() == 8);
  CHECK(campaign.variants[0].scenario.bin.size_m == std::vector<double>{0.77, 0.58, 0.09});
  int hoses = 0, sevens = 0, both = 0;
  for (const CampaignVariant& variant : campaign.variants) {
    hoses += variant.part.name == "hose_b" ? 1 : 0;
    sevens += variant.tubes == 7 ? 1 : 0;
    both += variant.scenario.resolution.strategy == "plus45_minus45" ? 1 : 0;
    CHECK_THAT(variant.name, Contains("resolution.strategy=plus45"));
  }
  CHECK(hoses == 4);
  CHECK(sevens == 4);
  CHECK(both == 4);
  const Campaign bins = Load(folder, R"(
[[variant]]
set = {bin.size_m = [[0.77, 0.58, 0.09], [0.80, 0.60, 0.20]]}
)");
  REQUIRE(bins.variants.size() == 2);
  CHECK(bins.variants[1].scenario.bin.size_m[2] == 0.20);
}

TEST_CASE("a profile brings its own defaults under what the variant sets") {
  const TemporaryFolder folder;
  const Campaign campaign = Load(folder, R"(
[[variant]]
profile = ["best", "leao2020"]
set = {resolution.strategy = "none"}
)");
  REQUIRE(campaign.variants.size() == 2);
  CHECK(campaign.variants[1].scenario.profile == "leao2020");
  CHECK(campaign.variants[1].scenario.perception.profile == "leao2020");
  CHECK(campaign.variants[1].scenario.resolution.strategy == "none");
  CHECK_THAT(campaign.variants[1].name, Contains("leao2020"));
}

TEST_CASE("overrides reach the campaign or every variant") {
  const TemporaryFolder folder;
  const Campaign campaign =
      Load(folder, "rounds = 3\n[[variant]]\ncount = 2\n[[variant]]\ncount = 3\n",
           {"rounds=2", "keep.films=false", "planner.exclude_free=true"});
  CHECK(campaign.rounds == 2);
  CHECK_FALSE(campaign.keep.films);
  for (const CampaignVariant& variant : campaign.variants)
    CHECK(variant.scenario.planner.exclude_free);
}

TEST_CASE("files of before, which call variants arms, are read the same") {
  const TemporaryFolder folder;
  const std::string rest = "\npart = \"hose_b\"\ncount = [2, 3]\n";
  const CampaignIdentity now = IdentityOf(Load(folder, "[[variant]]" + rest), "1");
  CHECK(IdentityOf(Load(folder, "[[arm]]" + rest), "1").document == now.document);
  CheckTextRefused("[[variant]]\n[[arm]]\n", ErrorKind::kConfig, "use [[variant]]");
}

TEST_CASE("a bad campaign file is refused with its place and what is allowed") {
  CheckTextRefused("rounds = 0\n[[variant]]\n", ErrorKind::kConfig,
                   "C.toml:1:10: rounds: is 0, allowed");
  CheckTextRefused("rounds = 2\n", ErrorKind::kConfig, "no [[variant]] table");
  CheckTextRefused("round = 2\n[[variant]]\n", ErrorKind::kConfig, "nearest known is 'rounds'");
  CheckTextRefused("[[variant]]\nprt = \"pvc_a\"\n", ErrorKind::kConfig, "nearest known is 'part'");
  CheckTextRefused("[[variant]]\npart = \"pvc_b\"\n", ErrorKind::kMissing, "pvc_a");
  CheckTextRefused("[[variant]]\ncount = 0\n", ErrorKind::kConfig, "C.toml:2:9: pile.count: is 0");
  CheckTextRefused("[[variant]]\ncount = [7, \"x\"]\n", ErrorKind::kConfig, "C.toml:2:13");
  CheckTextRefused("[[variant]]\ncount = []\n", ErrorKind::kConfig, "empty list");
  CheckTextRefused("[[variant]]\nprofile = \"bst\"\n", ErrorKind::kConfig, "best");
  CheckTextRefused("[[variant]]\nset = {planer.exclude_free = true}\n", ErrorKind::kConfig,
                   "planer");
  CheckTextRefused("[[variant]]\nset = {seed = 4}\n", ErrorKind::kConfig, "give it at the top");
  CheckTextRefused("[[variant]]\nset = 4\n", ErrorKind::kConfig, "a table");
  CheckTextRefused("[[variant]]\ncount = 7\nset = {pile.count = 8}\n", ErrorKind::kConfig,
                   "given twice");
  CheckTextRefused("[[variant]]\n[[variant]]\n", ErrorKind::kConfig,
                   "two variants are called 'pvc_a x 7'");
  CheckTextRefused("variant = 3\n", ErrorKind::kConfig, "[[variant]]");
  CheckTextRefused("[[variant]]\nset = {pile.file = \"no.csv\"}\n", ErrorKind::kMissing, "no.csv");
  CheckTextRefused("[[variant]]\nset = {bin.mesh = \"no.stl\"}\n", ErrorKind::kMissing, "no.stl");
}

TEST_CASE("seeds of rounds are the variants' in common, differ and depend on the campaign's seed") {
  CHECK(RoundSeed(1, 0) == RoundSeed(1, 0));
  CHECK(RoundSeed(1, 0) != RoundSeed(1, 1));
  CHECK(RoundSeed(1, 1) != RoundSeed(2, 1));
  CHECK(RoundSeed(1, 0) != RoundSeed(2, 0));
  for (int round = 0; round < 100; ++round) {
    CHECK(RoundSeed(3, round) >= 0);
    CHECK(RoundSeed(3, round) <= 9007199254740991);
  }
}

TEST_CASE("the identity holds what rows depend on and nothing of what is kept") {
  const TemporaryFolder folder;
  const std::string text = "[[variant]]\npart = \"pvc_a\"\n";
  const auto identity = [&](const std::string& text, const std::string& version) {
    return IdentityOf(Load(folder, text), version).document;
  };
  const Json one = identity(text, "1");
  CHECK(identity("[keep]\nsample = 0.5\n" + text, "1") == one);
  CHECK_THAT(*FirstDifference(identity(text + "count = 8\n", "1"), one),
             Contains("variants.0.config.pile.count is 8 against 7"));
  CHECK_THAT(*FirstDifference(identity(text, "2"), one),
             Contains("program is \"2\" against \"1\""));
}

TEST_CASE("what a campaign is run for stands in its file, and is part of what it is") {
  const TemporaryFolder folder;
  const std::string variant = "[[variant]]\ncount = 2\n";
  CHECK(Load(folder, variant).purpose == "development");
  const std::string claim = "purpose = \"claim\"\nseed = 9040\n" + variant;
  CHECK(Load(folder, claim).purpose == "claim");
  CHECK(Load(folder, "seed = 9040\n" + variant, {"purpose=claim"}).purpose == "claim");
  const CampaignIdentity claimed = IdentityOf(Load(folder, claim), "1");
  CHECK(claimed.purpose == "claim");
  // It cannot be said afterwards of rounds that were run without it.
  const CampaignIdentity tried = IdentityOf(Load(folder, "seed = 9040\n" + variant), "1");
  CHECK_THAT(DifferenceOf(claimed, tried)->what,
             Contains("purpose is \"claim\" against \"development\""));
  Json before = claimed.document;
  before.erase("purpose");
  CHECK(IdentityFromJson(before, "campaign.json").purpose.empty());
  CheckTextRefused("purpose = \"claims\"\n" + variant, ErrorKind::kConfig, "C.toml:1:11: purpose");
  CheckTextRefused("purpose = \"claim\"\n" + variant, ErrorKind::kConfig,
                   "C.toml: purpose is 'claim' and seed is 1");
}

TEST_CASE("the sample is a share of the rounds, the same whoever asks") {
  Campaign campaign;
  campaign.keep.sample = 0.1;
  int sampled = 0;
  for (int round = 0; round < 2000; ++round) sampled += IsSampled(campaign, round) ? 1 : 0;
  CHECK(sampled == Approx(200).margin(60));  // Over four sigma.
  campaign.keep.sample = 0.0;
  CHECK_FALSE(IsSampled(campaign, 0));
  campaign.keep.sample = 1.0;
  CHECK(IsSampled(campaign, 0));
}

TEST_CASE("every key of a campaign file stands in the help and in the schema") {
  const Json schema = CampaignSchema();
  for (const char* key : {"seed", "rounds", "purpose", "keep", "variant"}) {
    INFO(key);
    CHECK(schema["properties"].contains(key));
  }
  for (const char* key : {"failures", "sample", "films"}) {
    CHECK(schema["properties"]["keep"]["properties"].contains(key));
    CHECK_THAT(CampaignKeysText(), Catch::Contains("  " + std::string(key) + " "));
  }
  const Json variant = schema["properties"]["variant"]["items"];
  for (const char* key : {"name", "part", "count", "profile", "set"}) {
    CHECK_THAT(variant["properties"][key]["description"].get<std::string>(), !Catch::Equals(""));
    CHECK_THAT(CampaignKeysText(), Catch::Contains("  " + std::string(key) + " "));
  }
  CHECK(variant["additionalProperties"] == false);
  CHECK_THAT(CampaignKeysText(), Catch::Contains("[keep]: ") && Catch::Contains("[[variant]]: ") &&
                                     Catch::Contains("default 0.01"));
}

}  // namespace tubetwin

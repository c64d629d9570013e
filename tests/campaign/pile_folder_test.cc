// A campaign whose rounds start from given piles.

#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign.h"
#include "twin/round/round_checkpoint.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("rounds of a campaign start from the piles of a folder, one each, by name") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "piles");
  SettleResult made = GeneratePile(LoadPart("pvc_a"), Bin(), 1, "dropped", 1, {});
  for (const char* name : {"b.json", "a.json"}) SavePile(made.pile, folder / "piles/" + name);
  WriteFileAtomically(folder / "piles/notes.txt", "no pile");
  const auto load = [&](const std::string& rounds) {
    WriteFileAtomically(folder / "c.toml",
                        "rounds = " + rounds + "\n[[variant]]\nset = {pile.file = \"piles\"}\n");
    return LoadCampaign(folder / "c.toml", {}, std::nullopt);
  };
  const Campaign campaign = load("2");
  CHECK(campaign.variants[0].tubes == 1);
  CHECK(PileFilesOf(campaign.variants[0].scenario) ==
        std::vector<std::string>{folder / "piles/a.json", folder / "piles/b.json"});
  CHECK_THROWS_WITH(load("3"), Contains("holds 2 piles (*.json) for 3 rounds"));
  const Json before = IdentityOf(campaign, "1").document;
  made.pile.seed = 2;
  SavePile(made.pile, folder / "piles/b.json");
  CHECK(IdentityOf(campaign, "1").document != before);  // Another folder is another campaign.
}

}  // namespace tubetwin

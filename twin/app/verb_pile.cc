#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "planner/cell_check/cell_check.h"
#include "twin/app/common.h"
#include "twin/app/input/file_advice.h"
#include "twin/render/pile_picture.h"
#include "twin/round/scenario_check.h"

namespace tubetwin {
namespace {

struct PileOptions {
  std::string file, part, bin, units, arrangement = "dropped";
  int count = 7;
};

Pile ReadPile(const PileOptions& options, const Common& common) {
  PileOverrides given = GivenPile(options.part, options.bin, LoadScenario({}, common), common);
  given.unit_m = MetresPer(options.units);
  return LoadGivenPile(options.file, given);
}

int Generate(const PileOptions& options, const Common& common) {
  const Part part = LoadPart(options.part);
  const Scenario scenario = LoadScenario({}, common);
  Bin bin = ScenarioBin(scenario, std::nullopt);
  if (!options.bin.empty()) bin.size_m = ParseBinSize(options.bin);
  RequirePossible({CheckFill(bin, part, options.count)});
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  // The same draw as `run` makes, so that its start can be made alone.
  const RoundPhysics physics = ScenarioPhysics(scenario, part);
  const SettleResult made =
      GeneratePile(part, bin, options.count, options.arrangement, seed, physics);
  if (made.status != SettleStatus::kSettled) {
    throw Error(ErrorKind::kBadData,
                "no settled pile came out of " + std::to_string(options.count) + " " + part.name +
                    ", " + options.arrangement + ": " + ToString(made.status) + ", " + made.reason +
                    "; allowed: what comes to rest in the bin (fewer tubes, a larger "
                    "bin)");
  }
  SavePile(made.pile, common.out);
  Say(common, std::to_string(made.pile.tubes.size()) + " tubes of " + part.name + " " +
                  ToString(made.status) + " after " + Number(made.simulated_s) +
                  " s of simulated time: " + common.out);
  return 0;
}

int Show(const PileOptions& options, const Common& common) {
  const Pile pile = ReadPile(options, common);
  const TubeScene scene = SceneOfPile(pile);
  if (common.json) {
    Json tubes = Json::array();
    for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
      const PerceivedTube& tube = scene.tubes[i];
      tubes.push_back(Json{{"id", tube.id},
                           {"class", ToString(tube.tube_class)},
                           {"length_m", tube.length_m},
                           {"mass_kg", pile.tubes[i].mass_kg},
                           {"over", tube.over},
                           {"under", tube.under}});
    }
    PrintJson(Json{{"part", pile.part.name},
                   {"bin", ToJson(pile.bin)},
                   {"seed", pile.seed},
                   {"settled", pile.settled},
                   {"tubes", tubes}});
  } else {
    Print("%zu tubes of %s, bin %s x %s x %s m, %s\n", pile.tubes.size(), pile.part.name.c_str(),
          Number(pile.bin.size_m[0]).c_str(), Number(pile.bin.size_m[1]).c_str(),
          Number(pile.bin.size_m[2]).c_str(), pile.settled ? "settled" : "not settled");
    Print("  id  class   length_m  under          over\n");
    for (const PerceivedTube& tube : scene.tubes) {
      std::vector<std::string> under, over;
      for (const int id : tube.under) under.push_back(std::to_string(id));
      for (const int id : tube.over) over.push_back(std::to_string(id));
      Print("%4d  %-6s  %8.3f  %-13s  %s\n", tube.id, ToString(tube.tube_class), tube.length_m,
            Join(under, " ").c_str(), Join(over, " ").c_str());
    }
  }
  if (!common.out.empty()) RenderPilePicture(pile, common.out);
  return 0;
}

/// The options of verbs that read a pile.
void AddReadOptions(CLI::App& verb, PileOptions& options) {
  verb.add_option("file", options.file, "pile.json, CSV or the public set's text")->required();
  verb.add_option("--part", options.part, "Part name or part file, in place of the pile's");
  verb.add_option("--bin", options.bin, "Inner size of the bin: long,short,wall in metres");
  verb.add_option("--units", options.units,
                  "Unit of CSV and text; default: what the header says, else metres")
      ->check(CLI::IsMember(LengthUnits()));
}

}  // namespace

void AddPileVerb(CLI::App& app, Common& common) {
  CLI::App* pile = app.add_subcommand("pile",
                                      "Example: tubetwin pile generate --part hose_b --count 7 "
                                      "--arrangement threaded --seed 3 --out "
                                      "p.json\n\nMakes, reads and describes piles.");
  pile->require_subcommand(1);

  auto made = std::make_shared<PileOptions>();
  CLI::App* generate = pile->add_subcommand(
      "generate", "Example: tubetwin pile generate --part pvc_a --count 7 --seed 1 --out p.json");
  generate->add_option("--part", made->part, "Part name or part file")->required();
  generate->add_option("--count", made->count, "Number of tubes")
      ->required()
      ->check(CLI::Range(1, 40));
  generate->add_option("--arrangement", made->arrangement, "How they are laid")
      ->check(CLI::IsMember({"dropped", "stirred", "threaded"}));
  generate->add_option("--bin", made->bin, "Inner size of the bin: long,short,wall in metres");
  AddCommonOptions(*generate, common,
                   BinKeysAnd({"seed", "cell.model", "physics.randomize", "physics.tube_friction",
                               "physics.bending_stiffness_Nm2", "physics.mass_scale"}),
                   "Pile file to write (pile.json)", true);
  generate->callback(
      [made, &common] { common.action = [made, &common] { return Generate(*made, common); }; });

  auto read = std::make_shared<PileOptions>();
  // Not `import`, which is a word of the language's modules.
  CLI::App* taken = pile->add_subcommand(
      "import", "Example: tubetwin pile import A5_2.csv --bin 0.80,0.60,0.09 --out p.json");
  AddReadOptions(*taken, *read);
  AddCommonOptions(*taken, common, PileKeysAnd({}), "Pile file to write (pile.json)", true);
  taken->callback([read, &common] {
    common.action = [read, &common] {
      SavePile(ReadPile(*read, common), common.out);
      return 0;
    };
  });

  auto shown = std::make_shared<PileOptions>();
  CLI::App* show = pile->add_subcommand(
      "show",
      "Example: tubetwin pile show p.json --out p.png\n\nPrints the tubes with their classes "
      "by truth; with --out also draws them.");
  AddReadOptions(*show, *shown);
  AddCommonOptions(*show, common, PileKeysAnd({}), "Picture to write (PNG)", false);
  show->callback(
      [shown, &common] { common.action = [shown, &common] { return Show(*shown, common); }; });
}

}  // namespace tubetwin

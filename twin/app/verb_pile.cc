#include <cstdio>

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
  std::string file, part = "pvc_a", bin, units, arrangement = "dropped";
  int count = 7;
};

PileOverrides Overrides(const PileOptions& options, bool part_given) {
  PileOverrides out;
  if (part_given) out.part = options.part;
  if (!options.bin.empty()) out.bin_size_m = ParseBinSize(options.bin);
  out.unit_m = MetresPer(options.units);
  return out;
}

int Generate(const PileOptions& options, const Common& common) {
  const Part part = LoadPart(options.part);
  Bin bin;
  if (!options.bin.empty()) bin.size_m = ParseBinSize(options.bin);
  RequirePossible({CheckFill(bin, part, options.count)});
  const Scenario scenario = LoadScenario({}, common);
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  // The same draw as `run` makes, so that its start can be made alone.
  const RoundPhysics physics = ScenarioPhysics(scenario, part);
  const SettleResult made =
      GeneratePile(part, bin, options.count, options.arrangement, seed, physics);
  if (made.status != SettleStatus::kSettled) {
    throw Error(ErrorKind::kInternal, std::string("no settled pile came out: ") +
                                          ToString(made.status) + ", " + made.reason);
  }
  SavePile(made.pile, common.out);
  Say(common, std::to_string(made.pile.tubes.size()) + " tubes of " + part.name + " " +
                  ToString(made.status) + " after " + Number(made.simulated_s) +
                  " s of simulated time: " + common.out);
  return 0;
}

int Show(const PileOptions& options, bool part_given, const Common& common) {
  const Pile pile = LoadGivenPile(options.file, Overrides(options, part_given));
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
    std::printf("%s\n", Json{{"part", pile.part.name},
                             {"bin", ToJson(pile.bin)},
                             {"seed", pile.seed},
                             {"settled", pile.settled},
                             {"tubes", tubes}}
                            .dump(2)
                            .c_str());
  } else {
    std::printf("%zu tubes of %s, bin %s x %s x %s m, %s\n", pile.tubes.size(),
                pile.part.name.c_str(), Number(pile.bin.size_m[0]).c_str(),
                Number(pile.bin.size_m[1]).c_str(), Number(pile.bin.size_m[2]).c_str(),
                pile.settled ? "settled" : "not settled");
    std::printf("  id  class   length_m  under          over\n");
    for (const PerceivedTube& tube : scene.tubes) {
      std::vector<std::string> under, over;
      for (const int id : tube.under) under.push_back(std::to_string(id));
      for (const int id : tube.over) over.push_back(std::to_string(id));
      std::printf("%4d  %-6s  %8.3f  %-13s  %s\n", tube.id, ToString(tube.tube_class),
                  tube.length_m, Join(under, " ").c_str(), Join(over, " ").c_str());
    }
  }
  if (!common.out.empty()) RenderPilePicture(pile, common.out);
  return 0;
}

/// The options of verbs that read a pile; returns --part.
CLI::Option* AddReadOptions(CLI::App& verb, PileOptions& options) {
  verb.add_option("file", options.file, "pile.json, CSV or the public set's text")->required();
  CLI::Option* part = verb.add_option("--part", options.part, "Part name or part file");
  verb.add_option("--bin", options.bin, "Inner size of the bin: long,short,wall in metres");
  verb.add_option("--units", options.units,
                  "Unit of CSV and text; default: what the header says, else metres")
      ->check(CLI::IsMember(LengthUnits()));
  return part;
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
  AddCommonOptions(*generate, common, "Pile file to write (pile.json)", true);
  generate->callback(
      [made, &common] { common.action = [made, &common] { return Generate(*made, common); }; });

  auto read = std::make_shared<PileOptions>();
  CLI::App* import = pile->add_subcommand(
      "import", "Example: tubetwin pile import A5_2.csv --bin 0.80,0.60,0.09 --out p.json");
  CLI::Option* import_part = AddReadOptions(*import, *read);
  AddCommonOptions(*import, common, "Pile file to write (pile.json)", true);
  import->callback([read, import_part, &common] {
    common.action = [read, import_part, &common] {
      SavePile(LoadGivenPile(read->file, Overrides(*read, import_part->count() > 0)), common.out);
  return 0;
};
}  // namespace tubetwin
);

auto shown = std::make_shared<PileOptions>();
CLI::App* show = pile->add_subcommand(
    "show",
    "Example: tubetwin pile show p.json --out p.png\n\nPrints the tubes with their classes "
    "by truth; with --out also draws them.");
CLI::Option* show_part = AddReadOptions(*show, *shown);
AddCommonOptions(*show, common, "Picture to write (PNG)", false);
show->callback([shown, show_part, &common] {
  common.action = [shown, show_part, &common] {
    return Show(*shown, show_part->count() > 0, common);
  };
});
}

}  // namespace tubetwin

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "models/files/model_schema.h"
#include "models/model_file.h"
#include "twin/app/common.h"
#include "twin/round/scenario_check.h"

namespace tubetwin {

namespace {

/// The table of what was judged on stdout; what is wrong ends with its exit code.
int CheckConfig(const std::vector<std::string>& files, const Common& common) {
  const Scenario scenario = LoadScenario(files, common);
  const std::vector<Finding> cell = CheckScenario(scenario);
  const std::vector<Finding> part = CheckScenarioPart(scenario);
  std::vector<Finding> findings = cell;
  findings.insert(findings.end(), part.begin(), part.end());
  if (common.json) {
    PrintJson(FindingsJson(findings));
  } else if (!common.quiet) {
    Print("%s", FindingsTable(findings).c_str());
  }
  RequirePossible(cell);
  RequirePossible(part, "the part", ErrorKind::kBadData);
  Say(common,
      WorstOf(findings) == Finding::Verdict::kOk ? "no problem found" : "possible, with doubts");
  return 0;
}

/// A shipped model file on stdout, or the names of all.
int ShowModel(const std::string& name) {
  std::vector<std::string> all;
  for (const char* folder : {"cells", "arms", "grippers", "wrists", "scanners"}) {
    const std::vector<std::string> names = ModelFileNames(folder);
    all.insert(all.end(), names.begin(), names.end());
    if (name.empty()) Print("%-9s %s\n", folder, Join(names).c_str());
    // ur10e is a cell and an arm: "arms/ur10e" says which.
    for (const std::string& known : names) {
      if (name != known && name != folder + ("/" + known)) continue;
      Print("%s", OpenModelFile(folder, known, folder).text.c_str());
      return 0;
    }
  }
  if (name.empty()) return 0;
  throw Error(ErrorKind::kMissing, "no shipped file is named '" + name + "'; nearest is '" +
                                       NearestName(name, all) + "'; known: " + Join(all));
}

}  // namespace

void AddConfigVerb(CLI::App& app, Common& common) {
  CLI::App* config = app.add_subcommand(
      "config",
      "Example: tubetwin config dump --set pile.count=10\n\nChecks and shows configuration.");
  config->require_subcommand(1);
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* check = config->add_subcommand("check", "Example: tubetwin config check my.toml");
  check->add_option("file", *files, "Scenario and cell files, later ones override");
  AddCommonOptions(*check, common, AllKeys(), "", false);
  check->callback([files, &common] {
    common.action = [files, &common] { return CheckConfig(*files, common); };
  });
  auto model = std::make_shared<std::string>();
  CLI::App* shown = config->add_subcommand(
      "model",
      "Example: tubetwin config model leao2020 > my_cell.toml\n\nPrints a shipped cell, arm, "
      "gripper, wrist or scanner file, to start from; without a name: which there are. Where a "
      "cell "
      "and an arm have one name, arms/NAME is the arm's.");
  shown->add_option("name", *model, "Name of a shipped file");
  AddCommonOptions(*shown, common, UsedKeys(), "", false);
  shown->callback([model, &common] { common.action = [model] { return ShowModel(*model); }; });
  auto dumped = std::make_shared<std::vector<std::string>>();
  CLI::App* dump = config->add_subcommand("dump",
                                          "Example: tubetwin config dump my.toml\n\nEvery key "
                                          "with its value and meaning, as TOML.");
  dump->add_option("file", *dumped, "Scenario and cell files, later ones override");
  AddCommonOptions(*dump, common, AllKeys(), "", false);
  dump->callback([dumped, &common] {
    common.action = [dumped, &common] {
      Scenario scenario = LoadScenario(*dumped, common);
      Print("%s", WriteToml([&](ConfigVisitor& v) { scenario.Visit(v); }, true).c_str());
      return 0;
    };
  });
  CLI::App* schema =
      config->add_subcommand("schema",
                             "Example: tubetwin config schema > schema.json\n\nJSON Schema of "
                             "scenario files; --of cell: of cell files, and so on.");
  auto kind = std::make_shared<std::string>();
  schema->add_option("--of", *kind, "Of a file that describes a cell, a device or a part")
      ->check(CLI::IsMember(ModelFileKinds()));
  AddCommonOptions(*schema, common, UsedKeys(), "", false);
  schema->callback([kind, &common] {
    common.action = [kind] {
      if (!kind->empty()) {
        Print("%s", ModelFileSchema(*kind).c_str());
        return 0;
      }
      Scenario scenario = ReadScenario(ConfigSource());
      Print("%s\n", WriteConfigSchema([&](ConfigVisitor& v) { scenario.Visit(v); }).c_str());
      return 0;
    };
  });
}

}  // namespace tubetwin

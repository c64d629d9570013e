#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <CLI/CLI.hpp>

#include "hw_bridge/cell/wall_clock.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "twin/app/common.h"
#include "twin/live/jog.h"
#include "twin/live/live_cell.h"

namespace tubetwin {
namespace {

struct JogVerb {
  std::string cell;
  JogOptions jog;
  bool yes = false;
};

/// A person at a terminal says "move", or whoever wrote --yes has said so.
void RequireWord(const JogVerb& verb, const std::string& address) {
  if (verb.yes) return;
  if (::isatty(STDIN_FILENO) != 1) {
    throw Error(ErrorKind::kUsage,
                "jog: nobody is at a terminal to say that the arm may move; allowed is a person "
                "there, or --yes from one who sees the arm; nothing was sent");
  }
  std::fprintf(stderr,
               "Joint %d of the arm at %s will turn by %s degrees; nothing looks for collisions. "
               "When nobody is near, type 'move': ",
               verb.jog.joint, address.c_str(), Number(verb.jog.degrees).c_str());
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "move") throw Error(ErrorKind::kInterrupted, "jog: not moved");
}

int RunJog(const JogVerb& verb, const Common& common) {
  const Scenario scenario = LoadScenario({verb.cell}, common);
  scenario.cell.ValidateOrThrow();
  RequireSoundCell(scenario, common);
  const CellConfig::Arm& role = scenario.cell.arm;
  if (!role.IsDevice()) {
    throw Error(ErrorKind::kConfig, "cell.arm.driver: is '" + role.driver +
                                        "', jog moves a device; allowed is a cell file with one");
  }
  RequireArmed(scenario);
  RequireWord(verb, role.Chosen().Address());
  WallClock clock(scenario.rate);
  const CellModel model = ScenarioModel(scenario);
  JogOptions options = verb.jog;
  options.stop_requested = StopOnSignals();
  const auto arm = role.Connect(ScenarioContext(scenario, model, clock, CellPurpose::kRun));
  const JointVector q = Jog(*arm, model.arm, clock, options);
  if (common.json) {
    Json joints = Json::array();
    for (const double angle : q) joints.push_back(Degrees(angle));
    std::printf("%s\n", Json{{"joints_deg", joints}}.dump(2).c_str());
    return 0;
  }
  std::printf("joints");
  for (const double angle : q) std::printf(" %.3f", Degrees(angle));
  std::printf(" degrees\n");
  return 0;
}

}  // namespace

void AddJogVerb(CLI::App& app, Common& common) {
  auto jog = std::make_shared<JogVerb>();
  CLI::App* verb = app.add_subcommand(
      "jog",
      "Example: tubetwin jog --cell cell.toml --joint 6 --degrees 1\n\nTurns one joint of an armed "
      "arm by up to one degree, at 1 degree/s: first contact. Asks first; looks for no collision.");
  verb->add_option("--cell", jog->cell, "Cell file (TOML)")->required();
  verb->add_option("--joint", jog->jog.joint, "1 (next to the base) to 6")->required();
  verb->add_option("--degrees", jog->jog.degrees, "-1 to 1")->capture_default_str();
  verb->add_flag("--yes", jog->yes, "Do not ask: whoever wrote it sees the arm");
  AddCommonOptions(*verb, common, "", false);
  verb->callback(
      [jog, &common] { common.action = [jog, &common] { return RunJog(*jog, common); }; });
}

}  // namespace tubetwin

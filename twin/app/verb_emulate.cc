#include <CLI/CLI.hpp>

#include "models/base/json.h"
#include "twin/app/common.h"
#include "twin/live/emulate.h"

namespace tubetwin {
namespace {

struct EmulateChoice {
  std::string scenario, listen = "127.0.0.1", faults;
  double rate = 0.0, for_s = 0.0;
  bool any_ports = false, gige = false;
};

int RunEmulate(const EmulateChoice& choice, const Common& common) {
  std::vector<std::string> files;
  if (!choice.scenario.empty()) files.push_back(choice.scenario);
  Scenario scenario = LoadScenario(files, common);
  if (choice.rate > 0.0) scenario.rate = choice.rate;
  EmulateOptions options;
  options.out_folder = common.out;
  options.listen = choice.listen;
  options.any_ports = choice.any_ports;
  options.gige = choice.gige;
  options.faults_file = choice.faults;
  options.for_s = choice.for_s;
  options.parallelism = common.parallelism();
  options.stop_requested = StopOnSignals();
  bool ready = false;
  options.progress = [&](const std::string& line) {
    if (!ready) Say(common, "listening; now: tubetwin run --cell " + line + " --out DIR");
    if (ready) Say(common, "fault: " + line);
    ready = true;
  };
  const EmulateResult result = Emulate(scenario, options);
  const double share = result.wall_s > 0.0 ? result.cell_s / result.wall_s : 0.0;
  if (common.json) {
    PrintJson(Json{{"cell_s", result.cell_s},
                   {"wall_s", result.wall_s},
                   {"rate", scenario.rate},
                   {"reached_rate", share},
                   {"overruns", result.overruns},
                   {"worst_lag_ms", 1e3 * result.worst_lag_s},
                   {"stretched_s", result.stretched_s},
                   {"faults", result.faults}});
  } else {
    Print(
        "%.1f s of the cell in %.1f s, %.2f times real time of %.2f asked; %d overruns, worst lag "
        "%.1f ms, clocks stretched by %.3f s; %d faults\n",
        result.cell_s, result.wall_s, share, scenario.rate, result.overruns,
        1e3 * result.worst_lag_s, result.stretched_s, result.faults);
  }
  return 0;
}

}  // namespace

void AddEmulateVerb(CLI::App& app, Common& common) {
  auto choice = std::make_shared<EmulateChoice>();
  CLI::App* verb = app.add_subcommand(
      "emulate",
      "Example: tubetwin emulate --seed 1 --out out/emulated\n"
      "   then: tubetwin run --cell out/emulated/cell.toml --out out/over_the_wire\n\n"
      "Serves the twin's devices on their wire protocols until it is stopped (SIGTERM, Ctrl-C).");
  verb->add_option("scenario", choice->scenario, "Scenario file (TOML)")
      ->type_name("SCENARIO.toml");
  verb->add_option("--listen", choice->listen, "Address of every port")->capture_default_str();
  verb->add_option("--rate", choice->rate, "Times real time, for all clocks")
      ->check(CLI::Range(0.01, 100.0));
  verb->add_flag("--any-ports", choice->any_ports,
                 "Free ports instead of the devices' own; cell.toml says which");
  verb->add_flag("--gige", choice->gige,
                 "The scanner on GigE Vision (UDP 3956, which is fixed) instead of a folder");
  verb->add_option("--faults", choice->faults, "Fault script (TOML)")->type_name("F.toml");
  verb->add_option("--for", choice->for_s, "Ends after so many seconds of the cell's time")
      ->check(CLI::Range(0.0, 1e7));
  AddCommonOptions(*verb, common, AllKeys(), "Folder for cell.toml, scans and the log of events",
                   true);
  verb->callback([choice, &common] {
    common.action = [choice, &common] { return RunEmulate(*choice, common); };
  });
}

}  // namespace tubetwin

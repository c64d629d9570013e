#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>

#include "hw_bridge/recording/replay_cell.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "twin/app/common.h"
#include "twin/app/dry_run_verb.h"
#include "twin/live/live_cell.h"
#include "twin/report/write_report.h"
#include "twin/round/result_files.h"
#include "twin/round/round.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

/// "placed>=7": a number of summary.json and what it must be.
struct Requirement {
  std::string text, key, relation;
  double value = 0.0;
};

Requirement ParseRequirement(const std::string& text) {
  for (const char* relation : {">=", "<=", "==", ">", "<"}) {
    const auto at = text.find(relation);
    if (at == std::string::npos) continue;
    Requirement out{text, text.substr(0, at), relation, 0.0};
    const std::string number = text.substr(at + out.relation.size());
    char* end = nullptr;
    out.value = std::strtod(number.c_str(), &end);
    if (!out.key.empty() && !number.empty() && *end == '\0') return out;
  }
  throw Error(ErrorKind::kUsage, "--require '" + text +
                                     "': KEY>=VALUE is needed, for example 'placed>=7' (also <= == "
                                     "> <; keys as in summary.json, first_attempt.k)");
}

bool Holds(const Requirement& wanted, const Json& summary) {
  const Json* node = &summary;
  std::string rest = wanted.key;
  while (!rest.empty()) {
    const auto dot = rest.find('.');
    const std::string name = rest.substr(0, dot);
    rest = dot == std::string::npos ? "" : rest.substr(dot + 1);
    if (!node->is_object() || !node->contains(name)) {
      std::vector<std::string> keys;
      if (node->is_object()) {
        for (const auto& [key, value] : node->items()) keys.push_back(key);
      }
      throw Error(ErrorKind::kUsage, "--require '" + wanted.text + "': summary.json has no '" +
                                         name + "'; it has " + Join(keys));
    }
    node = &(*node)[name];
  }
  const double found = node->is_boolean()  ? (node->get<bool>() ? 1.0 : 0.0)
                       : node->is_number() ? node->get<double>()
                                           : std::nan("");
  if (wanted.relation == ">=") return found >= wanted.value;
  if (wanted.relation == "<=") return found <= wanted.value;
  if (wanted.relation == "==") return found == wanted.value;
  if (wanted.relation == ">") return found > wanted.value;
  return found < wanted.value;
}

struct RunOptions {
  std::string scenario, pile, part, bin, cell, profile;
  std::vector<std::string> require;
  bool video = false, record = false, force = false, dry = false;
};

/// Asks whoever sits at the terminal; nobody there is no word.
Acknowledgement AskOperator(const std::string& what) {
  if (::isatty(STDIN_FILENO) != 1) return Acknowledgement::kEnd;
  std::fprintf(stderr,
               "\ntubetwin: %s\nWhen the cause is gone and nobody is near the arm, type 'go on'; "
               "anything else ends the round: ",
               ForTerminal(what).c_str());
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "go on" ? Acknowledgement::kGoOn : Acknowledgement::kEnd;
}

/// The round on whatever cell the scenario chooses.
/// A rehearsal tells its story, too.
RoundResult RunAnywhere(const RunOptions& run, const Scenario& scenario, RoundOptions& options,
                        std::string& story) {
  if (scenario.cell.IsTwin() && !run.dry) return RunRound(scenario, options);
  scenario.cell.ValidateOrThrow();
  options.acknowledge = AskOperator;
  if (scenario.cell.arm.IsReplay()) {
    const std::string& path = scenario.cell.recording;
    ReplayCell replay{CellRecording(path)};
    replay.cell().safety = ScenarioSafety(scenario);
    options.replay = &replay;
    const auto fail = [&](const std::string& why) {
      throw Error(ErrorKind::kBadData, path + ": " + why +
                                           "\nthis configuration or program does something else "
                                           "than the recorded one; see `tubetwin replay --verify`");
    };
    try {
      RoundResult result = RunCellRound(replay.cell(), scenario, options);
      if (replay.tally().difference) fail(ToString(*replay.tally().difference));
      return result;
    } catch (const ReplayOver& over) {
      fail(over.what());
    }
  }
  const auto confirm = [](const std::string& what) {
    return AskOperator(what) == Acknowledgement::kGoOn;
  };
  LiveCell live(scenario, run.dry ? CellPurpose::kLook : CellPurpose::kRun, options.parallelism,
                confirm);
  GiveWay();  // Perception and planning, to the threads that listen to the devices.
  if (!run.dry) {
    RoundResult result = RunCellRound(live.cell(), scenario, options);
    WriteJsonFile(live.Links(), (fs::path(options.out_folder) / "links.json").string());
    return result;
  }
  DryRun dry = RunDry(live.cell(), scenario, options);
  story = "dry run: " + DryRunText(dry.story) + "; " + dry.story.told;
  return std::move(dry.round);
}

Scenario RunScenario(const RunOptions& run, const Common& common) {
  std::vector<std::string> files;
  if (!run.scenario.empty()) files.push_back(run.scenario);
  if (!run.cell.empty()) files.push_back(run.cell);
  Scenario scenario = LoadScenario(files, common, run.profile);
  if (!run.pile.empty()) scenario.pile.file = run.pile;
  if (!run.part.empty()) scenario.pile.part = run.part;
  if (!run.bin.empty()) {
    const auto size = ParseBinSize(run.bin);
    scenario.bin.size_m.assign(size.begin(), size.end());
  }
  return scenario;
}

int Run(const RunOptions& run, const Common& common) {
  std::vector<Requirement> requirements;
  for (const std::string& text : run.require) requirements.push_back(ParseRequirement(text));
  RoundOptions options;
  const Scenario scenario = RunScenario(run, common);
  RequireSoundCell(scenario, common);
  if (run.video && (run.dry || !scenario.cell.IsTwin())) {
    throw Error(ErrorKind::kUsage,
                "--video: only a round whose whole cell is the twin's can be drawn; leave it out");
  }
  options.out_folder = common.out;
  options.parallelism = common.parallelism();
  options.video = run.video;
  options.record_cell = run.record;
  options.force = run.force;
  options.program_version = TUBETWIN_VERSION;
  options.write_report = [](const std::string& folder) {
    WriteRoundReport(folder, (fs::path(folder) / "report.html").string(),
                     /*computing_times=*/false);
  };
  ProgressLine progress(!common.quiet);
  options.progress = [&](const std::string& text) { progress.Show(text); };
  options.stop_requested = StopOnSignals();
  options.stop_at_once = StopAtOnceOnSignals;
  std::string story;
  const RoundResult result = RunAnywhere(run, scenario, options, story);

  const RoundSummary& summary = result.record.summary;
  const Json told = RoundSummaryJson(result.record);
  if (common.json) {
    PrintJson(told);
  } else if (!story.empty()) {
    Print("%s\n", story.c_str());
  } else {
    Print("placed %d of %d in %d attempts, first attempt %d of %d, end: %s (%s)\n", summary.placed,
          summary.tubes_start, summary.attempts, summary.first_attempt.k, summary.first_attempt.n,
          summary.EndName().c_str(), summary.end_detail.c_str());
  }
  if (result.faulted) {
    Complain("the round ended with a fault: " + summary.end_detail);
    return static_cast<int>(ErrorKind::kDevice);
  }
  if (result.interrupted && !run.dry) return static_cast<int>(ErrorKind::kInterrupted);
  int code = 0;
  for (const Requirement& wanted : requirements) {
    if (!Holds(wanted, told)) {
      Complain("requirement '" + wanted.text + "' does not hold");
      code = 1;
    }
  }
  return code;
}

}  // namespace

void AddRunVerb(CLI::App& app, Common& common) {
  auto run = std::make_shared<RunOptions>();
  CLI::App* verb = app.add_subcommand(
      "run",
      "Example: tubetwin run --pile A5_2.csv --bin 0.80,0.60,0.09 --seed 1 --out out/a5\n\n"
      "Empties one bin and writes the result folder. With neither scenario nor pile: 7 pvc_a, "
      "dropped.");
  verb->add_option("scenario", run->scenario, "Scenario file (TOML)")->type_name("SCENARIO.toml");
  verb->add_option("--pile", run->pile,
                   "Pile to start from: pile.json, CSV or the public set's text");
  verb->add_option("--part", run->part, "Part name or part file");
  verb->add_option("--bin", run->bin, "Inner size of the bin: long,short,wall in metres");
  verb->add_option("--cell", run->cell, "Cell file (TOML): which devices");
  verb->add_option("--profile", run->profile, "Pipeline profile")
      ->check(CLI::IsMember(PipelineProfiles()));
  verb->add_flag("--video", run->video, "Also draw video.mp4 and picture.png");
  verb->add_flag("--record", run->record,
                 "Also record what crosses the cell's border (cell.rec.zst), for `replay`");
  verb->add_option("--require", run->require,
                   "Exit with 1 unless 'KEY>=VALUE' of summary.json holds")
      ->allow_extra_args(false);
  verb->add_flag("--dry-run", run->dry,
                 "Scan from where the scanner is, plan and check one attempt, send nothing; says "
                 "what was seen, what would be done and how near it comes to anything");
  verb->add_flag("--force", run->force, "Replace the rows of another configuration");
  AddCommonOptions(*verb, common, AllKeys(), "Result folder", true);
  verb->callback([run, &common] { common.action = [run, &common] { return Run(*run, common); }; });
}

}  // namespace tubetwin

#include <cstdio>
#include <optional>

#include <CLI/CLI.hpp>

#include "hw_bridge/mcap/mcap_export.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "twin/app/common.h"
#include "twin/app/input/file_advice.h"
#include "twin/round/replay_round.h"

namespace tubetwin {
namespace {

struct ReplayVerb {
  std::string file;
  bool verify = false;
  std::string mcap;
  std::optional<double> from_s, to_s;
  int cloud_step = 2;
};

/// The recording for public readers: messages of each topic.
Json Export(const ReplayVerb& given) {
  McapOptions options;
  if (given.from_s) options.from = FromSeconds(*given.from_s);
  if (given.to_s) options.to = FromSeconds(*given.to_s);
  options.cloud_step = given.cloud_step;
  CellRecording recording(given.file);
  return ExportMcap(recording, given.mcap, options);
}

Json ResultJson(const ReplayResult& result) {
  const ReplayTally& tally = result.tally;
  Json json = {{"commands", tally.commands},
               {"reads", tally.reads},
               {"reads_not_recorded", tally.more_reads},
               {"reads_not_asked", tally.missing_reads},
               {"attempts", result.attempts},
               {"placed", result.placed},
               {"complete", result.complete},
               {"end_s", Seconds(result.end)},
               {"difference", nullptr}};
  if (const auto& d = tally.difference) {
    json["difference"] =
        Json{{"kind", d->kind},         {"time_s", Seconds(d->time)}, {"field", d->field},
             {"recorded", d->recorded}, {"asked", d->asked},          {"after", d->after},
             {"commands", d->command}};
  }
  return json;
}

void PrintResult(const ReplayResult& result) {
  const ReplayTally& tally = result.tally;
  Print("%d attempts, %d placed (believed); %llu commands and %llu reads agree", result.attempts,
        result.placed, static_cast<unsigned long long>(tally.commands),
        static_cast<unsigned long long>(tally.reads));
  if (tally.more_reads + tally.missing_reads > 0) {
    Print(" (%llu reads were not recorded, %llu recorded ones not asked for)",
          static_cast<unsigned long long>(tally.more_reads),
          static_cast<unsigned long long>(tally.missing_reads));
  }
  if (tally.difference) {
    Print("\nfirst difference %s\n", ToString(*tally.difference).c_str());
  } else if (!result.complete) {
    Print(", up to %.3f s, where the recording was cut short\n", Seconds(result.end));
  } else {
    Print(", to the end at %.3f s\n", Seconds(result.end));
  }
}

int ReplayGiven(const ReplayVerb& given, const Common& common) {
  Json exported = nullptr;
  if (!given.mcap.empty()) {
    exported = Export(given);
    if (!common.json) Print("%s: %s\n", given.mcap.c_str(), exported.dump().c_str());
    if (!given.verify) {
      if (common.json) PrintJson(Json{{"mcap", exported}});
      return 0;
    }
  } else if (given.from_s || given.to_s) {
    throw Error(ErrorKind::kUsage, "--from and --to choose what --mcap exports; it is not given");
  }
  ReplayOptions options;
  options.parallelism = common.parallelism();
  ProgressLine progress(!common.quiet && !common.verbose);
  options.progress = [&](const std::string& text) {
    if (common.verbose) {
      Say(common, text);
    } else {
      progress.Show(text);
    }
  };
  const ReplayResult result = ReplayRound(given.file, options);
  progress.Clear();
  if (common.json) {
    Json json = ResultJson(result);
    if (!exported.is_null()) json["mcap"] = exported;
    PrintJson(json);
  } else {
    PrintResult(result);
  }
  return given.verify && result.tally.difference ? 1 : 0;
}

/// The refusal of another file says which verb takes it.
int Replay(const ReplayVerb& given, const Common& common) {
  try {
    return ReplayGiven(given, common);
  } catch (const Error& error) {
    const std::string low = LowerCase(given.file);
    if (error.kind() != ErrorKind::kBadData || low.ends_with(".rec") || low.ends_with(".rec.zst")) {
      throw;
    }
    throw Error(error.kind(), error.what() + AdviceFor(given.file));
  }
}

}  // namespace

void AddReplayVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<ReplayVerb>();
  CLI::App* verb = app.add_subcommand(
      "replay",
      "Example: tubetwin replay out/first/cell.rec.zst --verify\n\n"
      "Runs the pipeline again on the recorded cell (run --record), up to the first thing that it "
      "does otherwise.");
  verb->add_option("recording", given->file, "cell.rec.zst of a result folder")->required();
  verb->add_flag("--verify", given->verify, "Exit with 1 when something differs");
  verb->add_option("--mcap", given->mcap,
                   "Export for public readers and viewers, in place of replaying unless --verify")
      ->type_name("FILE.mcap");
  verb->add_option("--from", given->from_s, "Export from this second of the cell's time on");
  verb->add_option("--to", given->to_s, "Export up to this second");
  verb->add_option("--cloud-step", given->cloud_step,
                   "Export every N-th row and column of clouds; 1: every point")
      ->check(CLI::Range(1, 100));
  AddCommonOptions(*verb, common, UsedKeys(), "", false);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return Replay(*given, common); }; });
}

}  // namespace tubetwin

#include <cstdio>

#include <CLI/CLI.hpp>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/json.h"
#include "twin/app/common.h"
#include "twin/campaign/replay_round.h"

namespace tubetwin {
namespace {

struct ReplayVerb {
  std::string file;
  bool verify = false;
};

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

void Print(const ReplayResult& result) {
  const ReplayTally& tally = result.tally;
  std::printf("%d attempts, %d placed (believed); %llu commands and %llu reads agree",
              result.attempts, result.placed, static_cast<unsigned long long>(tally.commands),
              static_cast<unsigned long long>(tally.reads));
  if (tally.more_reads + tally.missing_reads > 0) {
    std::printf(" (%llu reads were not recorded, %llu recorded ones not asked for)",
                static_cast<unsigned long long>(tally.more_reads),
                static_cast<unsigned long long>(tally.missing_reads));
  }
  if (tally.difference) {
    std::printf("\nfirst difference %s\n", ToString(*tally.difference).c_str());
  } else if (!result.complete) {
    std::printf(", up to %.3f s, where the recording was cut short\n", Seconds(result.end));
  } else {
    std::printf(", to the end at %.3f s\n", Seconds(result.end));
  }
}

int Replay(const ReplayVerb& given, const Common& common) {
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
    std::printf("%s\n", ResultJson(result).dump(2).c_str());
  } else {
    Print(result);
  }
  return given.verify && result.tally.difference ? 1 : 0;
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
  AddCommonOptions(*verb, common, "", false);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return Replay(*given, common); }; });
}

}  // namespace tubetwin

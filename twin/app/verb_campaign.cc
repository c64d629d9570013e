#include <cstdlib>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/app/campaign_progress.h"
#include "twin/app/common.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/campaign_keys.h"
#include "twin/campaign/campaign_round.h"
#include "twin/campaign/campaign_status.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/campaign/merge.h"
#include "twin/campaign/run_campaign.h"
#include "twin/report/write_report.h"
#include "twin/study/compare.h"

namespace tubetwin {
namespace {

struct CampaignOptions {
  std::string file, shard, limit_time;
  std::optional<int> shards;
  int jobs = 0;
  double grace_s = 20.0;
  std::vector<std::string> folders, kept;
  ReportHead head;
};

/// "90", "90s", "30m", "8h" in seconds.
double ParseDuration(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit(end);
  const double scale = unit.empty() || unit == "s" ? 1.0
                       : unit == "m"               ? 60.0
                       : unit == "h"               ? 3600.0
                                                   : 0.0;
  if (end == text.c_str() || scale == 0.0 || !(value > 0.0)) {
    throw Error(ErrorKind::kUsage,
                "--limit-time '" + text + "': a time is needed, for example 90s, 30m or 8h");
  }
  return value * scale;
}

/// Writes the merged result and tells its summary.
int MergeAndTell(const CampaignResult& result, const Common& common) {
  WriteMerged(result, common.out);
  const CampaignSummary summary = Summarize(result);
  Print("%s", common.json ? JsonText(ToJson(summary)).c_str()
                          : SummaryText(summary, ManifestOf(result)).c_str());
  return 0;
}

int RunVerb(const CampaignOptions& given, const Common& common) {
  CampaignRunOptions options;
  options.shard = ChooseShard(given.shard, given.shards,
                              [](const char* name) -> const char* { return std::getenv(name); });
  if (!given.limit_time.empty()) options.limit_s = ParseDuration(given.limit_time);
  const Campaign campaign = LoadCampaign(given.file, common.overrides, common.seed);
  for (const CampaignVariant& variant : campaign.variants) {
    RequireSoundCell(variant.scenario, common);
  }
  options.out_folder = common.out;
  options.jobs = given.jobs;
  options.grace_s = given.grace_s;
  if (const int code = RunCampaignWithProgress(campaign, options, common); code != 0) return code;
  if (options.shard.count > 1) return 0;
  // The whole campaign: no merge is needed.
  return MergeAndTell(ReadShards({common.out}), common);
}

int StatusVerb(const CampaignOptions& given, const Common& common) {
  const CampaignStatus status = ReadCampaignStatus(given.folders.front());
  Print("%s", common.json ? JsonText(ToJson(status)).c_str() : ToText(status).c_str());
  return 0;
}

int MergeVerb(const CampaignOptions& given, const Common& common) {
  return MergeAndTell(ReadShards(given.folders), common);
}

int ReportVerb(const CampaignOptions& given, const Common& common) {
  namespace fs = std::filesystem;
  const fs::path folder(given.folders.front());
  const std::string file = common.out.empty() ? (folder / "report.html").string() : common.out;
  // A folder of one round has no campaign.json, but a summary.
  const bool is_round =
      !fs::exists(folder / "campaign.json") && fs::exists(folder / "summary.json");
  const std::size_t bytes =
      is_round ? WriteRoundReport(folder.string(), file,
                                  /*computing_times=*/true, given.head)
               : WriteCampaignReport(folder.string(), given.kept, file, given.head);
  if (common.json) {
    PrintJson(Json{{"file", file}, {"bytes", bytes}});
  } else {
    Print("%s\n", file.c_str());
  }
  return 0;
}

int CompareVerb(const CampaignOptions& given, const Common& common) {
  std::vector<CampaignResult> results;
  for (const std::string& folder : given.folders) results.push_back(ReadCampaignResult(folder));
  const std::vector<VariantPair> pairs =
      results.size() == 1 ? PairVariantsWithin(results[0]) : PairVariants(results[0], results[1]);
  const Comparison comparison = CompareVariants(pairs);
  if (!common.out.empty()) WriteJsonFile(ToJson(comparison), common.out);
  Print("%s", common.json ? JsonText(ToJson(comparison)).c_str() : CompareText(comparison).c_str());
  return 0;
}

void AddRun(CLI::App& campaign, Common& common) {
  auto given = std::make_shared<CampaignOptions>();
  CLI::App* run = campaign.add_subcommand(
      "run",
      "Example: tubetwin campaign run C.toml --out out/c, where C.toml reads\n\n"
      "  seed = 1\n  rounds = 40\n  [[variant]]\n  part = \"pvc_a\"\n  count = 7\n"
      "  [[variant]]\n  part = \"hose_b\"\n  count = [7, 10]\n"
      "  set = {resolution.strategy = [\"plus45\", \"plus45_minus45\"]}\n\n"
      "Runs every round of every variant (a list makes a variant of each value; round r has the "
      "same seed in all variants), each in a process of its own. Killed at any moment it loses the "
      "rounds in "
      "hand; the same command goes on where it was. --set, --seed and --shard/--shards as said "
      "below; --threads is per round (default 1). A shard of several is merged with `campaign "
      "merge`; the whole campaign merges itself.");
  run->footer("Keys of the file (`tubetwin campaign schema` gives them as a JSON Schema):\n" +
              CampaignKeysText());
  run->add_option("file", given->file, "Campaign file (TOML)")->required()->type_name("C.toml");
  run->add_option("--jobs", given->jobs, "Rounds at a time; default: all cores")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  run->add_option("--shard", given->shard,
                  "Run rounds r with r mod n = i only; also from SLURM_ARRAY_TASK_ID/COUNT")
      ->type_name("I/N");
  run->add_option("--shards", given->shards,
                  "Number of shards when JOB_COMPLETION_INDEX (from 0) or PARALLEL_SEQ (from 1) "
                  "says which one")
      ->type_name("N");
  run->add_option("--limit-time", given->limit_time,
                  "Begin no round after that time (90s, 30m, 8h), then exit with 75")
      ->type_name("TIME");
  run->add_option("--grace", given->grace_s,
                  "Seconds that rounds in hand have to end after SIGTERM or SIGINT; default 20")
      ->check(CLI::Range(0.0, 86400.0))
      ->type_name("S");
  AddCommonOptions(*run, common, AllKeys(), "Folder of the campaign", true);
  run->callback(
      [given, &common] { common.action = [given, &common] { return RunVerb(*given, common); }; });
}

void AddStatus(CLI::App& campaign, Common& common) {
  auto seen = std::make_shared<CampaignOptions>();
  CLI::App* status = campaign.add_subcommand(
      "status",
      "Example: tubetwin campaign status out/c\n\n"
      "Rounds done, rate and time left, parts per hour of each variant so far.");
  status->add_option("folder", seen->folders, "Folder of the campaign")
      ->required()
      ->expected(1)
      ->type_name("DIR");
  AddCommonOptions(*status, common, UsedKeys(), "", false);
  status->callback(
      [seen, &common] { common.action = [seen, &common] { return StatusVerb(*seen, common); }; });
}

void AddMerge(CLI::App& campaign, Common& common) {
  auto merged = std::make_shared<CampaignOptions>();
  CLI::App* merge = campaign.add_subcommand(
      "merge",
      "Example: tubetwin campaign merge out/shard-* --out out/merged\n\n"
      "Makes one result of all shards of a campaign, in whatever folders and order: picks.jsonl, "
      "timings.jsonl, rounds.jsonl, summary.json. The bytes are those of one uninterrupted run. "
      "Missing and doubled rounds are errors.");
  merge->add_option("folders", merged->folders, "Folders with shards")
      ->required()
      ->type_name("DIR...");
  AddCommonOptions(*merge, common, UsedKeys(), "Folder of the result", true);
  merge->callback([merged, &common] {
    common.action = [merged, &common] { return MergeVerb(*merged, common); };
  });
}

void AddReport(CLI::App& campaign, Common& common) {
  auto page = std::make_shared<CampaignOptions>();
  CLI::App* report = campaign.add_subcommand(
      "report",
      "Example: tubetwin campaign report out/c --title \"Hoses, cell 3\" --customer \"ACME\"\n\n"
      "Makes one page of a campaign's folder, merged or not, or of a round's result folder: "
      "DIR/report.html, whole in itself. Unlike the page that `run` writes it tells computing "
      "times too. Its first sheet is for a customer: part, bin, cell, assumptions, parts per hour "
      "with their interval. Failed attempts that were kept are shown with picture, loads and a 3-D "
      "view.");
  report->add_option("folder", page->folders, "Folder of the campaign or round")
      ->required()
      ->expected(1)
      ->type_name("DIR");
  report
      ->add_option("--kept", page->kept,
                   "Shards' folders with failures and samples, when DIR was merged from them")
      ->type_name("DIR...");
  report->add_option("--title", page->head.title, "What stands over the page")->type_name("TEXT");
  report->add_option("--customer", page->head.customer, "Whom the page is for")->type_name("TEXT");
  AddCommonOptions(*report, common, UsedKeys(), "The page's file; default DIR/report.html", false);
  report->callback(
      [page, &common] { common.action = [page, &common] { return ReportVerb(*page, common); }; });
}

void AddCompare(CLI::App& campaign, Common& common) {
  auto pair = std::make_shared<CampaignOptions>();
  CLI::App* compare = campaign.add_subcommand(
      "compare",
      "Example: tubetwin campaign compare out/plus45 out/plus45_minus45\n\n"
      "Compares two campaigns of one seed variant by variant, or all variants within one, round by "
      "round with the same seed: exact McNemar tests with Holm's adjustment, differences with "
      "bootstrap intervals.");
  compare->add_option("folders", pair->folders, "One or two campaigns")
      ->required()
      ->expected(1, 2)
      ->type_name("A [B]");
  AddCommonOptions(*compare, common, UsedKeys(), "Also write the comparison as JSON", false);
  compare->callback(
      [pair, &common] { common.action = [pair, &common] { return CompareVerb(*pair, common); }; });
}

void AddSchema(CLI::App& campaign, Common& common) {
  CLI::App* schema =
      campaign.add_subcommand("schema",
                              "Example: tubetwin campaign schema > campaign.schema.json\n\n"
                              "JSON Schema of a campaign file; `tubetwin config schema` is that of "
                              "the scenario keys in set.");
  AddCommonOptions(*schema, common, UsedKeys(), "", false);
  schema->callback([&common] {
    common.action = [] {
      PrintJson(CampaignSchema());
      return 0;
    };
  });
}

}  // namespace

void AddCampaignVerb(CLI::App& app, Common& common) {
  CLI::App* campaign = app.add_subcommand(
      "campaign",
      "Example: tubetwin campaign run C.toml --out out/c\n\n"
      "Many rounds: on one machine or many, interrupted and resumed, merged and compared.");
  campaign->require_subcommand(1);
  AddRun(*campaign, common);
  AddStatus(*campaign, common);
  AddMerge(*campaign, common);
  AddReport(*campaign, common);
  AddCompare(*campaign, common);
  AddSchema(*campaign, common);
}

}  // namespace tubetwin

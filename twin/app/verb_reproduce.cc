#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/app/campaign_progress.h"
#include "twin/study/reproduction.h"

namespace tubetwin {
namespace {

struct ReproduceOptions {
  std::string paper;
  int rounds = 20, jobs = 0;
};

int RunVerb(const ReproduceOptions& given, const Common& common) {
  const std::filesystem::path folder(common.out);
  MakeFolder(common.out);
  const std::string file = (folder / "reproduce.toml").string();
  const std::string toml = ReproductionToml(common.seed.value_or(1), given.rounds);
  if (!std::filesystem::exists(file)) {
    WriteFileAtomically(file, toml);
  } else if (ReadFile(file) != toml) {
    throw Error(ErrorKind::kCannotCreate, common.out +
                                              " holds a reproduction with another seed or other "
                                              "rounds, or of an earlier version (see " +
                                              file + "): name another folder");
  }
  const Campaign campaign = LoadCampaign(file, common.overrides, std::nullopt);
  CampaignRunOptions options;
  options.out_folder = common.out;
  options.jobs = given.jobs;
  if (const int code = RunCampaignWithProgress(campaign, options, common); code != 0) return code;
  const CampaignResult result = ReadShards({common.out});
  WriteMerged(result, common.out);
  const Reproduction tables = ReproductionOf(result);
  const std::string text = ReproductionText(tables);
  WriteJsonFile(ToJson(tables), (folder / "tables.json").string());
  WriteFileAtomically((folder / "tables.md").string(), text);
  Print("%s", common.json ? JsonText(ToJson(tables)).c_str() : text.c_str());
  return 0;
}

}  // namespace

void AddReproduceVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<ReproduceOptions>();
  CLI::App* verb = app.add_subcommand(
      "reproduce",
      "Example: tubetwin reproduce leao2020 --out out/leao2020\n\n"
      "Repeats the experiment of the 2020 paper, 20 rounds of each of its two sets of tubes, in "
      "its "
      "profile with one scan from 0.80 m and with the same seeds in profile best with eight views; "
      "writes and prints its Tables 3 to 9 with both beside the paper (tables.md, tables.json). "
      "The folder is a campaign's (reproduce.toml): it resumes, and `campaign report` and "
      "`campaign "
      "compare` read it.");
  verb->add_option("paper", given->paper, "Which paper: leao2020")
      ->required()
      ->check(CLI::IsMember({"leao2020"}))
      ->type_name("PAPER");
  verb->add_option("--rounds", given->rounds, "Rounds of each set and profile; default 20")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
  verb->add_option("--jobs", given->jobs, "Rounds at a time; default: all cores")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  AddCommonOptions(*verb, common, AllKeys(), "Folder of the campaign and its tables", true);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return RunVerb(*given, common); }; });
}

}  // namespace tubetwin

#include "twin/campaign/campaign_round.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/random.h"
#include "twin/render/recording.h"
#include "twin/round/failure_picture.h"
#include "twin/round/round.h"
#include "twin/round/round_checkpoint.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr int kFilmStride = 2;  // Twice as fast as life, half as long to draw.

/// Frames [from, to) of a recording as a recording of their own.
Recording Cut(const Recording& whole, int from, int to) {
  Recording out = whole;
  const int count = static_cast<int>(whole.frames.size());
  out.frames.assign(whole.frames.begin() + std::clamp(from, 0, count),
                    whole.frames.begin() + std::clamp(to, 0, count));
  return out;
}

/// Draws films and pictures of a kept round, and its page anew with them.
std::string DrawFilms(const fs::path& folder, const std::vector<int>& failed_attempts,
                      const std::vector<AttemptRecord>& attempts, bool whole,
                      const CampaignRoundOptions& options) {
  const Recording recording = ReadRecording((folder / "recording.bin").string());
  try {
    for (const int attempt : failed_attempts) {
      const std::vector<int>& ends = recording.attempt_ends;
      const int from = attempt == 0 ? 0 : ends[attempt - 1];
      const Recording part = Cut(recording, from, ends[attempt]);
      if (part.frames.empty()) continue;
      RenderFilm(part, (folder / "failures" / FailureFolderName(attempt) / "film.mp4").string(),
                 kFilmStride, options.parallelism);
      DrawFailurePicture(recording, attempt, attempts[attempt], folder.string());
    }
    if (whole)
      RenderFilm(recording, (folder / "video.mp4").string(), kFilmStride, options.parallelism);
    if (options.write_report) options.write_report(folder.string());
  } catch (const Error& e) {
    return folder.string() + ": no film: " + e.what();
  }
  return "";
}

}  // namespace

std::string RoundFolderName(int variant, int round) {
  char name[64];
  std::snprintf(name, sizeof name, "variant-%02d-round-%06d", variant, round);
  return name;
}

std::optional<std::pair<int, int>> RoundOfFolderName(const std::string& name) {
  std::pair<int, int> out;
  for (const char* format : {"variant-%d-round-%d", "arm-%d-round-%d"}) {
    if (std::sscanf(name.c_str(), format, &out.first, &out.second) == 2) return out;
  }
  return std::nullopt;
}

int KeptFailures(const std::string& folder, const Shard& shard) {
  int kept = 0;
  std::error_code ignored;  // No folder: none is kept.
  for (const auto& entry : fs::directory_iterator(fs::path(folder) / "failures", ignored)) {
    const auto round = RoundOfFolderName(entry.path().filename().string());
    if (round && shard.Owns(round->second)) ++kept;
  }
  return kept;
}

bool IsSampled(const Campaign& campaign, int round) {
  RandomStream stream(static_cast<std::uint64_t>(campaign.seed), static_cast<std::uint64_t>(round),
                      "sample");
  return stream.Uniform() < campaign.keep.sample;
}

RoundOutput RunCampaignRound(const Campaign& campaign, const RoundTask& task,
                             const CampaignRoundOptions& options) {
  Scenario scenario = campaign.variants.at(static_cast<std::size_t>(task.variant)).scenario;
  scenario.seed = task.seed;
  const std::vector<std::string> piles = PileFilesOf(scenario);
  if (!piles.empty()) scenario.pile.file = piles.at(static_cast<std::size_t>(task.round));
  const bool sampled = IsSampled(campaign, task.round);
  const std::string name = RoundFolderName(task.variant, task.round);
  const fs::path out(options.out_folder);
  const fs::path work = out / "work" / name;
  std::error_code ignored;  // Left over from a killed process, or not there.
  fs::remove_all(work, ignored);

  RoundOptions round;
  round.out_folder = work.string();
  round.parallelism = options.parallelism;
  round.program_version = options.program_version;
  round.write_report = options.write_report;
  round.keep = sampled             ? RoundKeep::kAll
               : task.keep_failure ? RoundKeep::kFailures
                                   : RoundKeep::kRows;
  RoundResult result = RunRound(scenario, round);
  if (fs::exists(work / kRoundCheckpointFile)) {
    MakeFolder((out / "held").string());
    RenameDurably((work / kRoundCheckpointFile).string(),
                  (out / "held" / (name + ".pile.json")).string());
  }

  RoundOutput output;
  output.record = std::move(result.record);
  const std::vector<AttemptRecord>& attempts = output.record.attempts;
  std::vector<int> failed;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    if (attempts[i].success != true) failed.push_back(static_cast<int>(i));
  }
  const bool keep = sampled || (task.keep_failure && !failed.empty());
  if (!keep) {
    fs::remove_all(work, ignored);
    fs::remove(work.parent_path(), ignored);  // Only when it is empty.
    return output;
  }
  const fs::path kept =
      out / (failed.empty() || !task.keep_failure ? "samples" : "failures") / name;
  MakeFolder(kept.parent_path().string());
  fs::remove_all(kept, ignored);
  RenameDurably(work.string(), kept.string());
  fs::remove(work.parent_path(), ignored);
  if (campaign.keep.films) {
    if (!sampled && !task.keep_failure) failed.clear();
    output.afterwards = [kept, failed, attempts, sampled, options] {
      return DrawFilms(kept, failed, attempts, sampled, options);
    };
  }
  return output;
}

}  // namespace tubetwin

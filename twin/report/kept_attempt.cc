#include "twin/report/kept_attempt.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/render/recording.h"
#include "twin/report/scene_view.h"
#include "twin/report/text.h"
#include "twin/report/trace.h"
#include "twin/round/records/attempt_facts.h"
#include "twin/round/round.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr int kStride = 4;  // 7.5 poses per simulated second; between them the page interpolates.

std::string Joined(const std::string& link, const std::string& name) {
  return link.empty() ? name : link + "/" + name;
}

/// The frames of each attempt; empty when the recording does not tell.
std::vector<std::pair<int, int>> FramesOf(const Recording& recording) {
  std::vector<std::pair<int, int>> out;
  int from = 0;
  for (const int to : recording.attempt_ends) {
    out.emplace_back(from, to);
    from = to;
  }
  return out;
}

std::string TakePicture(const fs::path& folder, ShownLimits& limits) {
  for (const char* name : {"picture.jpg", "picture.png"}) {
    const fs::path file = folder / name;
    if (!fs::exists(file)) continue;
    const std::string text = Base64(ReadFile(file.string()));
    if (text.size() > limits.picture_bytes) continue;
    limits.picture_bytes -= text.size();
    return text;
  }
  return "";
}

/// What the recording says about frames [from, to) of an attempt.
void AddRecorded(const Recording& recording, std::pair<int, int> frames,
                 const AttemptRecord& attempt, ShownLimits& limits, ShownAttempt& shown) {
  const auto [from, to] = frames;
  if (to - from < 2) return;
  shown.trace_svg = ForceTraceSvg(
      recording, from, to,
      attempt.detection ? std::optional<double>(attempt.detection->at_s) : std::nullopt);
  const CellTrack track = TrackOf(recording, from, to, kStride);
  // As things lay when the plan was made: at the first frame of the look that it is made from.
  const Recording::Overlay* look = LookDuring(recording, from, to);
  int seen = from;
  while (look != nullptr && seen < to - 1 &&
         (recording.frames[seen].overlay < 0 ||
          &recording.overlays[recording.frames[seen].overlay] != look)) {
    ++seen;
  }
  shown.plan_svg = PlanViewSvg(recording, track, (seen - from) / kStride, look);
  Json scene = AttemptScene(recording, track, from, kStride);
  const std::size_t size = scene.dump().size();
  if (size > limits.scene_bytes) return;
  limits.scene_bytes -= size;
  shown.scene = std::move(scene);
}

}  // namespace

std::vector<ShownAttempt> ShownAttempts(const RoundRecord& record, const std::string& round_folder,
                                        const std::string& link, ShownKind kind,
                                        ShownLimits& limits) {
  const fs::path folder(round_folder);
  std::optional<Recording> recording;
  if (fs::exists(folder / "recording.bin")) {
    recording = ReadRecording((folder / "recording.bin").string());
  }
  const std::vector<std::pair<int, int>> frames =
      recording ? FramesOf(*recording) : std::vector<std::pair<int, int>>();
  const std::vector<AttemptFacts> facts = FactsOf(record).attempts;
  std::vector<int> order;
  for (const bool failed : {true, false}) {
    if (kind == (failed ? ShownKind::kSuccesses : ShownKind::kFailures)) continue;
    for (std::size_t i = 0; i < facts.size(); ++i) {
      if ((facts[i].failure != "") == failed) order.push_back(static_cast<int>(i));
    }
  }
  std::vector<ShownAttempt> out;
  for (const int i : order) {
    if (limits.attempts <= 0) break;
    --limits.attempts;
    const AttemptRecord& attempt = record.attempts[i];
    ShownAttempt shown;
    shown.row = i;
    shown.label = (link.empty() ? "" : NameOf(record) + ", ") + "attempt " + std::to_string(i + 1);
    shown.failure = facts[i].failure;
    shown.believed = ToString(attempt.outcome);
    shown.reason = attempt.reason;
    shown.folder = link;
    const std::string failure_folder = "failures/" + FailureFolderName(i);
    if (fs::exists(folder / failure_folder / "film.mp4")) {
      shown.film = Joined(link, failure_folder + "/film.mp4");
    } else if (fs::exists(folder / "video.mp4")) {
      shown.film = Joined(link, "video.mp4");
    }
    shown.picture = TakePicture(folder / failure_folder, limits);
    if (i < static_cast<int>(frames.size())) {
      AddRecorded(*recording, frames[i], attempt, limits, shown);
    }
    out.push_back(std::move(shown));
  }
  return out;
}

std::string RepeatCommand(const std::string& link) {
  std::string file = Joined(link, "config.resolved.toml");
  if (file.starts_with('-')) file = "./" + file;  // No option.
  std::string quoted;
  for (const char c : file) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  const bool plain = file.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/") ==
                     std::string::npos;
  return "tubetwin run " + (plain ? file : "'" + quoted + "'") + " --video --out again";
}

}  // namespace tubetwin

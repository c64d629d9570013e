#include "twin/round/round_recorder.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <utility>

#include "models/base/cloud/packed_cloud.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "twin/cell/truth.h"
#include "twin/render/picture_points.h"
#include "twin/round/replay_round.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

/// From the end of an attempt to the look at what came of it. The fingers let go before they go up,
/// which takes a second itself: a hose that lay on others rocks until about two seconds later.
constexpr TimeNs kUntilLook = std::chrono::seconds(1);

constexpr double kAroundGrasp_m = 0.05;

int PointsAround(const OrganizedCloud& view, const Vector3& p_N) {
  const Eigen::Vector3f p_S = (view.X_NS.inverse() * p_N).cast<float>();
  constexpr auto kReach = static_cast<float>(kAroundGrasp_m);
  return static_cast<int>(
      std::count_if(view.p_SP.begin(), view.p_SP.end(), [&](const Eigen::Vector3f& p) {
        return IsValid(p) && (p - p_S).squaredNorm() < kReach * kReach;
      }));
}

}  // namespace

std::vector<std::size_t> ViewsOfFailure(const std::vector<OrganizedCloud>& views,
                                        const AttemptRecord& attempt) {
  std::vector<std::size_t> all(views.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (!attempt.chosen || views.empty()) return all;
  std::vector<int> counts;
  for (const OrganizedCloud& view : views) {
    counts.push_back(PointsAround(view, attempt.chosen->p_NG));
  }
  return {
      static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin())};
}

RoundRecorder::RoundRecorder(RoundScorer scorer, const RoundOptions& options)
    : options_(options), scorer_(std::move(scorer)), attempt_began_(WallClock_s()) {}

void RoundRecorder::OnStep(const std::string& caption) {
  if (tape != nullptr) tape->Caption(caption);
  if (options_.replay != nullptr) options_.replay->Caption(caption);
  if (options_.progress) {
    options_.progress("attempt " + std::to_string(attempts.size() + 1) + ": " + caption);
  }
}

void RoundRecorder::OnAttemptEnd(const AttemptReport& report) {
  attempts.push_back(scorer_.Believed(report));
  if (tape != nullptr) tape->Result(BelievedAttempt(report));
  if (options_.replay != nullptr) options_.replay->Result(BelievedAttempt(report));
  const double now = WallClock_s();
  timings.push_back({report.attempt, report.compute_s, now - attempt_began_});
  attempt_began_ = now;
  if (!scorer_.sees_truth()) Conclude();
}

void RoundRecorder::OnRoundEnd(const RoundReport& report) {
  timings.push_back({kAfterLastAttempt, report.compute_s, WallClock_s() - attempt_began_});
}

void RoundRecorder::SaveRowsAtOnce() {
  const auto begin = [&](const char* name) {
    const std::string path = (fs::path(options_.out_folder) / name).string();
    WriteFileAtomically(path, "");  // Its name is on the disk, too.
    return OutputFile::Continue(path);
  };
  picks_.emplace(begin("picks.jsonl"));
  timings_file_.emplace(begin("timings.jsonl"));
}

void RoundRecorder::Conclude() {
  const AttemptRecord& last = attempts.back();
  if (picks_) {
    picks_->Append(ToJson(last, RowPlace()).dump() + "\n");
    timings_file_->Append(ToJson(timings.back(), RowPlace()).dump() + "\n");
  }
  const bool failed = !last.success.value_or(last.outcome == AttemptOutcome::kPlaced);
  if (options_.keep != RoundKeep::kRows && failed) SaveFailure();
}

bool RoundRecorder::AnyFailure() const {
  return std::any_of(attempts.begin(), attempts.end(),
                     [](const AttemptRecord& attempt) { return attempt.success != true; });
}

void RoundRecorder::SaveFailure() {
  const std::string name = FailureFolderName(static_cast<int>(attempts.size()) - 1);
  const std::vector<std::size_t> views = ViewsOfFailure(last_views_, attempts.back());
  const auto view_file = [](std::size_t i) { return "view_" + std::to_string(i) + ".pcd.zst"; };
  if (folder != nullptr) {
    std::vector<std::string> names = {"attempt.json", "state.pile.json", "picture.jpg", "film.mp4"};
    for (const std::size_t i : views) names.push_back(view_file(i));
    for (std::string& file : names) file = "failures/" + name + "/" + file;
    folder->Add(names);
  }
  const std::string to = (fs::path(options_.out_folder) / "failures" / name).string();
  WriteJsonFile(ToJson(attempts.back(), RowPlace()), to + "/attempt.json");
  OnFailure(to);
  for (const std::size_t i : views) {
    WritePackedPcd(last_views_[i], to + "/" + view_file(i));
  }
}

TwinRoundRecorder::TwinRoundRecorder(TwinCell& twin, const Pile& pile,
                                     const PlacementTolerance& tolerance,
                                     std::vector<Recording::Visual> visuals,
                                     const RoundOptions& options)
    : RoundRecorder(RoundScorer(twin, twin.cell().model.layout, static_cast<int>(pile.tubes.size()),
                                tolerance),
                    options),
      twin_(twin) {
  recording_.cell_xml = twin.ModelXml();
  recording_.bin = pile.bin;
  recording_.visuals = std::move(visuals);
  twin.SetFrameObserver([this] { AddFrame(); });
}

void TwinRoundRecorder::OnStep(const std::string& caption) {
  recording_.captions.push_back(caption);
  RoundRecorder::OnStep(caption);
}

void TwinRoundRecorder::OnScene(const TubeScene& scene, const PickPlan* plan) {
  RoundRecorder::OnScene(scene, plan);
  Recording::Overlay overlay;
  for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
    overlay.lines_N.push_back(scene.tubes[i].centerline_N);
    overlay.classes.push_back(static_cast<int>(scene.tubes[i].tube_class));
    if (plan != nullptr && scene.tubes[i].id == plan->target) overlay.target = static_cast<int>(i);
  }
  if (options_.keep != RoundKeep::kRows) {
    overlay.cloud_N = DownsampleForPicture(last_views_, recording_.bin);
  }
  recording_.overlays.push_back(std::move(overlay));
}

void TwinRoundRecorder::OnReference(const Wrench& reference_K) {
  reference_K_ = reference_K;
  tared_ = true;
}

void TwinRoundRecorder::OnAttemptEnd(const AttemptReport& report) {
  LookAtTruth();  // Of the attempt before, where two end within the same second.
  recording_.attempt_ends.push_back(static_cast<int>(recording_.frames.size()));
  RoundRecorder::OnAttemptEnd(report);
  recording_.overlays.push_back({});  // What was seen is stale now.
  look_ = Look{report, twin_.cell().clock.Now() + kUntilLook};
}

void TwinRoundRecorder::LookAtTruth() {
  if (!look_) return;
  scorer_.AddTruth(look_->report, attempts.back());
  look_.reset();
  Conclude();
}

void TwinRoundRecorder::Finish() {
  if (look_) twin_.cell().clock.AdvanceTo(look_->due);
  LookAtTruth();  // Unless a frame on the way was due.
}

void TwinRoundRecorder::OnFailure(const std::string& folder) {
  SavePile(Truth(twin_).CurrentPile(), folder + "/state.pile.json");
}

void TwinRoundRecorder::AddFrame() {
  Recording::Frame frame;
  for (const double q : twin_.Qpos()) frame.qpos.push_back(static_cast<float>(q));
  if (tared_) {
    const Wrench load = twin_.cell().wrist.Read().wrench_K - reference_K_;
    frame.force_N = static_cast<float>(load.force_N.z());
  }
  frame.overlay = static_cast<int>(recording_.overlays.size()) - 1;
  frame.caption = static_cast<int>(recording_.captions.size()) - 1;
  recording_.frames.push_back(std::move(frame));
  if (look_ && twin_.cell().clock.Now() >= look_->due) LookAtTruth();
}

}  // namespace tubetwin

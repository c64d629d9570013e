#include "twin/campaign/round.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/files.h"
#include "hw_bridge/base/json.h"
#include "hw_bridge/cell/cell_recorder.h"
#include "twin/campaign/failure_picture.h"
#include "twin/campaign/held_round.h"
#include "twin/campaign/replay_round.h"
#include "twin/campaign/report_round.h"
#include "twin/campaign/result_files.h"
#include "twin/campaign/scoring.h"
#include "twin/campaign/thinned_points.h"
#include "twin/cell/twin_cell.h"
#include "twin/render/recording.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

double WallNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Follows one round: rows by truth, recording, failures. Lives as long as the round.
class RoundRecorder : public CycleObserver {
 public:
  RoundRecorder(TwinCell& twin, const Pile& pile, std::vector<Recording::Visual> visuals,
                const RoundOptions& options)
      : twin_(twin), options_(options), scorer_(twin, static_cast<int>(pile.tubes.size())) {
    recording_.cell_xml = twin.ModelXml();
    recording_.bin = pile.bin;
    recording_.visuals = std::move(visuals);
    twin.SetFrameObserver([this] { AddFrame(); });
    attempt_began_ = WallNow();
  }

  void OnStep(const std::string& caption) override {
    recording_.captions.push_back(caption);
    if (tape != nullptr) tape->Caption(caption);
    if (options_.progress) {
      options_.progress("attempt " + std::to_string(rows.size() + 1) + ": " + caption);
    }
  }

  void OnScene(const TubeScene& scene, const PickPlan* plan) override {
    Recording::Overlay overlay;
    for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
      overlay.lines_N.push_back(scene.tubes[i].centerline_N);
      overlay.classes.push_back(static_cast<int>(scene.tubes[i].tube_class));
      if (plan != nullptr && scene.tubes[i].id == plan->target)
        overlay.target = static_cast<int>(i);
    }
    if (options_.keep != RoundKeep::kRows) {
      overlay.cloud_N = ThinnedPoints(last_views_, recording_.bin);
    }
    recording_.overlays.push_back(std::move(overlay));
  }

  void OnClouds(const std::vector<OrganizedCloud>& views) override { last_views_ = views; }
  void OnReference(const Wrench& reference_K) override {
    reference_K_ = reference_K;
    tared_ = true;
  }
  void OnDetection(const Detection&) override { scorer_.AtDetection(); }

  void OnSeveral(const HeldState& state) override { on_several(state, scorer_.State()); }

  void OnAttemptEnd(const AttemptReport& report) override {
    rows.push_back(scorer_.AttemptRow(report, 0));
    if (tape != nullptr) tape->Result(BelievedAttempt(report));
    const double now = WallNow();
    timings.push_back(RoundScorer::TimingRow(report, 0, now - attempt_began_));
    attempt_began_ = now;
    recording_.attempt_ends.push_back(static_cast<int>(recording_.frames.size()));
    if (options_.keep != RoundKeep::kRows && !rows.back()["success"].get<bool>()) SaveFailure();
    recording_.overlays.push_back({});  // What was seen is stale now.
  }

  Json Summary(const RoundReport& report) const {
    return scorer_.Summary(report, Seconds(twin_.cell().clock.Now()));
  }
  const Recording& recording() const { return recording_; }

  bool AnyFailure() const {
    return std::any_of(rows.begin(), rows.end(),
                       [](const Json& row) { return row["success"] != true; });
  }

  void Resume(const JsonView& scorer) { scorer_.Restore(scorer); }

  std::vector<Json> rows, timings;
  CellRecorder* tape = nullptr;  ///< Of the cell; null: it is not recorded.
  /// Told of the moment when several hang, with the scorer's state.
  std::function<void(const HeldState&, const Json&)> on_several;

 private:
  void AddFrame() {
    Recording::Frame frame;
    for (const double q : twin_.Qpos()) frame.qpos.push_back(static_cast<float>(q));
    if (tared_) {
      const Wrench load = twin_.cell().wrist.Read().wrench_K - reference_K_;
      frame.force_N = static_cast<float>(load.force_N.z());
    }
    frame.overlay = static_cast<int>(recording_.overlays.size()) - 1;
    frame.caption = static_cast<int>(recording_.captions.size()) - 1;
    recording_.frames.push_back(std::move(frame));
  }

  void SaveFailure() {
    const std::string name = FailureFolderName(static_cast<int>(rows.size()) - 1);
    const std::string folder = (fs::path(options_.out_folder) / "failures" / name).string();
    WriteJsonFile(rows.back(), folder + "/attempt.json");
    SavePile(Truth(twin_).CurrentPile(), folder + "/state.pile.json");
    for (std::size_t i = 0; i < last_views_.size(); ++i) {
      WritePcd(last_views_[i], folder + "/view_" + std::to_string(i) + ".pcd");
    }
  }

  TwinCell& twin_;
  const RoundOptions& options_;
  RoundScorer scorer_;
  Recording recording_;
  std::vector<OrganizedCloud> last_views_;
  Wrench reference_K_;
  bool tared_ = false;
  double attempt_began_ = 0.0;
};

Pile StartPile(const Scenario& scenario, const Pile& asked, const RoundPhysics& physics) {
  if (asked.settled && scenario.pile.file.empty()) return asked;
  const SettleResult settled = SettlePile(asked, physics);
  if (settled.status == SettleStatus::kDiverged) {
    throw Error(ErrorKind::kBadData,
                scenario.pile.file + ": the pile does not settle: " + settled.reason);
  }
  return settled.pile;  // Escaped tubes are part of the truth: they will not be placed.
}

/// The cell and the scorer of a stored round, as they were where it was stored.
void Resume(const HeldRound& held, TwinCell& twin, RoundRecorder& recorder) {
  const JsonView view = JsonView(held.document, held.file).Field("held");
  twin.Restore(view.Field("cell"));
  recorder.Resume(view.Field("scorer"));
}

/// Recording, film and report.
void WriteRecord(const RoundRecorder& recorder, const RoundOptions& options) {
  const fs::path out(options.out_folder);
  WriteRecording(recorder.recording(), (out / "recording.bin").string());
  if (options.video) {
    if (options.progress) options.progress("drawing the film");
    RenderPicture(recorder.recording(), 0, (out / "picture.png").string());
    RenderFilm(recorder.recording(), (out / "video.mp4").string(), 1, options.parallelism);
    for (std::size_t i = 0; i < recorder.rows.size(); ++i) {
      if (recorder.rows[i]["success"] == true) continue;
      DrawFailurePicture(recorder.recording(), static_cast<int>(i), recorder.rows[i],
                         options.out_folder);
    }
  }
  WriteRoundReport(options.out_folder, (out / "report.html").string(), /*timings=*/false);
}

}  // namespace

std::string FailureFolderName(int row) {
  char name[32];
  std::snprintf(name, sizeof name, "attempt_%03d", row + 1);
  return name;
}

RoundResult RunRound(const Scenario& given, const RoundOptions& options) {
  const double began = WallNow();
  Scenario scenario = given;
  const std::optional<HeldRound> held = ReadHeldRound(scenario, options.scenario_folder);
  if (held) scenario.seed = held->seed;
  const Pile asked = ScenarioPile(scenario, options.scenario_folder);
  const fs::path out(options.out_folder);
  // A given pile is archived, so that the resolved configuration runs wherever the folder is moved.
  const bool archive_pile = !scenario.pile.file.empty();
  if (archive_pile) scenario.pile.file = "given.pile.json";
  std::vector<Recording::Visual> visuals = ScenarioVisuals(scenario, options.scenario_folder);
  const std::vector<ArchivedFile> meshes = ArchiveMeshes(scenario, options.scenario_folder);
  const std::string resolved = ResolvedToml(scenario);
  ClaimResultFolder(options.out_folder, resolved, options.force);

  const RoundPhysics physics = ScenarioPhysics(scenario, asked.part);
  const Pile pile = held ? asked : StartPile(scenario, asked, physics);
  if (held) {
    WriteJsonFile(held->document, (out / "given.pile.json").string());
  } else if (archive_pile) {
    SavePile(asked, (out / "given.pile.json").string());
  }
  for (const ArchivedFile& mesh : meshes) {
    WriteFileAtomically((out / mesh.name).string(), ReadFile(mesh.from));
  }
  SavePile(pile, (out / "start.pile.json").string());

  TwinCellOptions cell_options;
  cell_options.physics = physics;
  cell_options.seed = static_cast<std::uint64_t>(scenario.seed);
  cell_options.scan = ScenarioScan(scenario, physics);
  cell_options.parallelism = options.parallelism;
  TwinCell twin(pile, cell_options);
  WriteFileAtomically((out / "cell.xml").string(), twin.ModelXml());
  WriteFileAtomically((out / "config.resolved.toml").string(), resolved);
  fs::remove_all(out / "failures");

  RoundRecorder recorder(twin, pile, std::move(visuals), options);
  fs::remove(out / kHeldRoundFile);
  recorder.on_several = [&](const HeldState& state, const Json& scorer) {
    twin.WakeAll();  // Whether it is stored or not: both go on alike.
    if (!scenario.cycle.end_at_several) return;
    SaveHeldRound(pile, scenario.seed, twin.State(), state, scorer,
                  (out / kHeldRoundFile).string());
  };
  PickCycleSetup setup = ScenarioCycle(scenario, asked.part, options.parallelism);
  setup.stop_requested = options.stop_requested;
  if (held) Resume(*held, twin, recorder);
  fs::remove(out / kCellRecordingFile);
  std::optional<CellRecorder> cell_recorder;
  if (options.record_cell) {
    cell_recorder.emplace(twin.cell(),
                          CellHeader(scenario, resolved, options.program_version, asked.part, held),
                          (out / kCellRecordingFile).string());
    recorder.tape = &*cell_recorder;
  }
  Cell& cell = cell_recorder ? cell_recorder->cell() : twin.cell();
  const RoundReport report = held ? FinishHeldAttempt(cell, setup, HeldCycle(*held), recorder)
                                  : RunPickCycle(cell, setup, recorder);
  if (cell_recorder) EndRecording(*cell_recorder, report);

  RoundResult result;
  result.interrupted = report.end == RoundEnd::kInterrupted;
  result.summary = recorder.Summary(report);
  WriteJsonLines(recorder.rows, (out / "picks.jsonl").string());
  WriteJsonLines(recorder.timings, (out / "timings.jsonl").string());
  WriteJsonFile(result.summary, (out / "summary.json").string());
  const double cycle_wall_s = WallNow() - began;
  if (options.keep == RoundKeep::kAll ||
      (options.keep == RoundKeep::kFailures && recorder.AnyFailure())) {
    WriteRecord(recorder, options);
  }
  WriteJsonFile(Manifest(scenario, resolved, options.program_version, options.parallelism.threads,
                         cycle_wall_s),
                (out / "manifest.json").string());
  result.rows = std::move(recorder.rows);
  result.timings = std::move(recorder.timings);
  return result;
}

}  // namespace tubetwin

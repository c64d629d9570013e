#include "twin/round/round.h"

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>

#include "hw_bridge/recording/cell_recorder.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "twin/render/gl/egl_context.h"
#include "twin/round/archive.h"
#include "twin/round/failure_picture.h"
#include "twin/round/folder/result_folder.h"
#include "twin/round/replay_round.h"
#include "twin/round/result_files.h"
#include "twin/round/round_checkpoint.h"
#include "twin/round/round_recorder.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

/// What is drawn or told of rows and may be made anew at any time.
constexpr const char* kNamedOnly[] = {"report.html", "video.mp4", "picture.png", "links.json",
                                      "dry_run.json"};

/// The cell and the scorer of a stored round, as they were where it was stored.
void Resume(const RoundCheckpoint& held, TwinCell& twin, TwinRoundRecorder& recorder) {
  twin.Restore(held.cell());
  recorder.Resume(held.scorer);
}

void Draw(const TwinRoundRecorder& recorder, const RoundOptions& options) {
  const fs::path out(options.out_folder);
  if (options.progress) options.progress("drawing the film");
  RenderPicture(recorder.recording(), 0, (out / "picture.png").string());
  RenderFilm(recorder.recording(), (out / "video.mp4").string(), 1, options.parallelism);
  for (std::size_t i = 0; i < recorder.attempts.size(); ++i) {
    if (recorder.attempts[i].success == true) continue;
    DrawFailurePicture(recorder.recording(), static_cast<int>(i), recorder.attempts[i],
                       options.out_folder);
  }
}

/// Recording, film and report. Gives back why there is no film: the rest is there all the same.
std::optional<Error> WriteRecord(const TwinRoundRecorder& recorder, const RoundOptions& options) {
  std::optional<Error> undrawn;
  WriteRecording(recorder.recording(), (fs::path(options.out_folder) / "recording.bin").string());
  try {
    if (options.video) Draw(recorder, options);
  } catch (const Error& error) {
    undrawn = error;
  }
  if (options.write_report) options.write_report(options.out_folder);
  return undrawn;
}

/// What a round's pipeline is made of; lives as long as the round.
struct Pipeline {
  const Scenario& scenario;
  const std::string& resolved_toml;
  const Part& part;
  const std::optional<RoundCheckpoint>& held;
  const RoundOptions& options;
  ResultFolder& folder;
};

/// Runs the pick cycle on `cell`, recorded if asked to, and writes configuration, rows, summary.
RoundResult RunPipeline(Cell& plain, const Pipeline& pipeline, RoundRecorder& recorder) {
  const RoundOptions& options = pipeline.options;
  const fs::path out(options.out_folder);
  WriteFileAtomically((out / "config.resolved.toml").string(), pipeline.resolved_toml);
  PickCycleSetup setup =
      ScenarioCycle(pipeline.scenario, plain.model, pipeline.part, options.parallelism);
  std::optional<CellRecorder> cell_recorder;
  setup.stop_requested = [&] {
    return (options.stop_requested && options.stop_requested()) ||
           (cell_recorder && cell_recorder->failure());
  };
  setup.acknowledge = options.acknowledge;
  if (options.record_cell) {
    cell_recorder.emplace(plain,
                          CellHeader(pipeline.scenario, pipeline.resolved_toml,
                                     options.program_version, pipeline.part, pipeline.held),
                          (out / kCellRecordingFile).string());
    recorder.tape = &*cell_recorder;
  }
  Cell& cell = cell_recorder ? cell_recorder->cell() : plain;
  cell.stop_at_once = options.stop_at_once;
  const RoundReport report = pipeline.held
                                 ? ResumeAttempt(cell, setup, pipeline.held->cycle, recorder)
                                 : RunPickCycle(cell, setup, recorder);
  std::optional<Error> unrecorded;
  try {
    if (cell_recorder) EndRecording(*cell_recorder, report);
  } catch (const Error& error) {
    unrecorded = error;  // The rows come first.
  }
  if (options.replay != nullptr) EndReplay(*options.replay, report);

  recorder.OnRoundEnd(report);
  const double sim_s = Seconds(plain.clock.Now());
  recorder.Finish();
  RoundResult result;
  result.interrupted = report.end == RoundEnd::kInterrupted;
  result.faulted = report.end == RoundEnd::kFault;
  result.record.seed = pipeline.scenario.seed;
  result.record.summary = recorder.Summary(report, sim_s);
  result.record.attempts = recorder.attempts;
  result.record.timings = recorder.timings;
  WriteRoundRecord(result.record, options.out_folder);
  if (unrecorded) throw Error(*unrecorded);
  return result;
}

/// Takes the folder for a round of this configuration.
std::unique_ptr<ResultFolder> ClaimForRound(const RoundOptions& options,
                                            const std::vector<ArchivedFile>& inputs,
                                            const std::string& resolved_toml) {
  ResultFolder::Claim claim{"run", {}, options.force};
  claim.names = {
      "config.resolved.toml", "given.pile.json", "start.pile.json", "cell.xml", "picks.jsonl",
      "timings.jsonl",        "summary.json",    "recording.bin",   "failures", kCellRecordingFile,
      kRoundCheckpointFile};
  claim.names.insert(claim.names.end(), std::begin(kNamedOnly), std::end(kNamedOnly));
  for (const ArchivedFile& input : inputs) claim.names.push_back(input.name);
  if (!options.force) RequireSameConfiguration(options.out_folder, resolved_toml);
  return std::make_unique<ResultFolder>(options.out_folder, claim);
}

/// What a real cell did before its program ended on the way is there once.
void RequireNoUnendedRows(const std::string& folder) {
  const fs::path rows = fs::path(folder) / "picks.jsonl";
  if (!fs::exists(rows) || fs::file_size(rows) == 0) return;
  if (fs::exists(fs::path(folder) / "summary.json")) return;
  throw Error(ErrorKind::kCannotCreate,
              rows.string() +
                  ": holds the attempts of a round that did not end, which nobody can "
                  "repeat; give another --out, or --force to replace them");
}

/// Removes what an earlier round left, but for what this one may have been read from.
void BeginRound(ResultFolder& folder, const std::vector<ArchivedFile>& inputs) {
  std::vector<std::string> replaced = {"given.pile.json", "config.resolved.toml"};
  for (const ArchivedFile& input : inputs) replaced.push_back(input.name);
  folder.Begin(replaced);
}

void WriteInputs(const std::vector<ArchivedFile>& inputs, const fs::path& out) {
  for (const ArchivedFile& input : inputs) {
    WriteFileAtomically((out / input.name).string(), input.text);
  }
}

void WriteManifest(const Pipeline& pipeline, double wall_s) {
  const RoundOptions& options = pipeline.options;
  Json manifest = Manifest(pipeline.scenario, pipeline.resolved_toml, options.program_version,
                           options.parallelism.threads, wall_s);
  pipeline.folder.End(std::move(manifest), {std::begin(kNamedOnly), std::end(kNamedOnly)});
}

}  // namespace

std::string FailureFolderName(int row) {
  char name[32];
  std::snprintf(name, sizeof name, "attempt_%03d", row + 1);
  return name;
}

RoundResult RunRound(const Scenario& given, const RoundOptions& options) {
  RequireTwin(given, "this round");
  if (options.video) EglContext();  // Whether there are images is known before the round.
  const double began = WallClock_s();
  Scenario scenario = given;
  const std::optional<RoundCheckpoint> held = ReadRoundCheckpoint(scenario);
  if (held) scenario.seed = held->seed;
  const Pile asked = ScenarioPile(scenario);
  const fs::path out(options.out_folder);
  // A given pile is archived, so that the resolved configuration runs wherever the folder is moved.
  const bool archive_pile = !scenario.pile.file.empty();
  std::vector<Recording::Visual> visuals = ScenarioVisuals(scenario);
  Scenario archived = scenario;
  if (archive_pile) archived.pile.file = "given.pile.json";
  const std::vector<ArchivedFile> inputs = ArchiveInputs(archived);
  const std::string resolved = ResolvedToml(archived);
  const auto folder = ClaimForRound(options, inputs, resolved);

  const RoundPhysics physics = ScenarioPhysics(scenario, asked.part);
  const Pile pile = held ? asked : StartPile(scenario, asked, physics);
  BeginRound(*folder, inputs);
  if (held) {
    WriteJsonFile(held->document, (out / "given.pile.json").string());
  } else if (archive_pile) {
    SavePile(asked, (out / "given.pile.json").string());
  }
  WriteInputs(inputs, out);
  SavePile(pile, (out / "start.pile.json").string());

  TwinCell twin(pile, ScenarioTwin(scenario, physics, options.parallelism));
  twin.cell().safety = ScenarioSafety(scenario);
  WriteFileAtomically((out / "cell.xml").string(), twin.ModelXml());

  TwinRoundRecorder recorder(twin, pile, scenario.success, std::move(visuals), options);
  recorder.folder = folder.get();
  recorder.on_several = [&](const AttemptCheckpoint& state, const ScorerState& scorer) {
    twin.WakeAll();  // Whether it is stored or not: both go on alike.
    if (!scenario.cycle.end_at_several) return;
    SaveRoundCheckpoint(pile, scenario.seed, twin.State(), state, scorer,
                        (out / kRoundCheckpointFile).string());
  };
  if (held) Resume(*held, twin, recorder);
  const Pipeline pipeline{scenario, resolved, asked.part, held, options, *folder};
  RoundResult result = RunPipeline(twin.cell(), pipeline, recorder);
  const double cycle_wall_s = WallClock_s() - began;
  std::optional<Error> undrawn;
  if (options.keep == RoundKeep::kAll ||
      (options.keep == RoundKeep::kFailures && recorder.AnyFailure())) {
    undrawn = WriteRecord(recorder, options);
  }
  WriteManifest(pipeline, cycle_wall_s);
  if (undrawn) throw Error(*undrawn);
  return result;
}

RoundResult RunCellRound(Cell& cell, const Scenario& scenario, const RoundOptions& options) {
  const double began = WallClock_s();
  const fs::path out(options.out_folder);
  const Part part = LoadPart(ScenarioPartName(scenario));
  Scenario archived = scenario;
  const std::vector<ArchivedFile> inputs = ArchiveInputs(archived);
  const std::string resolved = ResolvedToml(archived);
  const auto folder = ClaimForRound(options, inputs, resolved);
  if (!options.force) RequireNoUnendedRows(options.out_folder);
  BeginRound(*folder, inputs);
  WriteInputs(inputs, out);
  RoundRecorder recorder(RoundScorer(), options);
  recorder.folder = folder.get();
  recorder.SaveRowsAtOnce();
  const Pipeline pipeline{scenario, resolved, part, std::nullopt, options, *folder};
  RoundResult result = RunPipeline(cell, pipeline, recorder);
  const double cycle_wall_s = WallClock_s() - began;
  if (options.keep == RoundKeep::kAll && options.write_report) {
    options.write_report(options.out_folder);
  }
  WriteManifest(pipeline, cycle_wall_s);
  return result;
}

}  // namespace tubetwin

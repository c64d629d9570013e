#include "twin/round/round.h"

#include <cstdio>
#include <filesystem>

#include "hw_bridge/recording/cell_recorder.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "twin/round/archive.h"
#include "twin/round/failure_picture.h"
#include "twin/round/replay_round.h"
#include "twin/round/result_files.h"
#include "twin/round/round_checkpoint.h"
#include "twin/round/round_recorder.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

/// The cell and the scorer of a stored round, as they were where it was stored.
void Resume(const RoundCheckpoint& held, TwinCell& twin, TwinRoundRecorder& recorder) {
  twin.Restore(held.cell());
  recorder.Resume(held.scorer);
}

/// Recording, film and report.
void WriteRecord(const TwinRoundRecorder& recorder, const RoundOptions& options) {
  const fs::path out(options.out_folder);
  WriteRecording(recorder.recording(), (out / "recording.bin").string());
  if (options.video) {
    if (options.progress) options.progress("drawing the film");
    RenderPicture(recorder.recording(), 0, (out / "picture.png").string());
    RenderFilm(recorder.recording(), (out / "video.mp4").string(), 1, options.parallelism);
    for (std::size_t i = 0; i < recorder.attempts.size(); ++i) {
      if (recorder.attempts[i].success == true) continue;
      DrawFailurePicture(recorder.recording(), static_cast<int>(i), recorder.attempts[i],
                         options.out_folder);
    }
  }
  if (options.write_report) options.write_report(options.out_folder);
}

/// What a round's pipeline is made of; lives as long as the round.
struct Pipeline {
  const Scenario& scenario;
  const std::string& resolved_toml;
  const Part& part;
  const std::optional<RoundCheckpoint>& held;
  const RoundOptions& options;
};

/// Runs the pick cycle on `cell`, recorded if asked to, and writes configuration, rows, summary.
RoundResult RunPipeline(Cell& plain, const Pipeline& pipeline, RoundRecorder& recorder) {
  const RoundOptions& options = pipeline.options;
  const fs::path out(options.out_folder);
  WriteFileAtomically((out / "config.resolved.toml").string(), pipeline.resolved_toml);
  fs::remove_all(out / "failures");
  fs::remove(out / kCellRecordingFile);
  PickCycleSetup setup =
      ScenarioCycle(pipeline.scenario, plain.model, pipeline.part, options.parallelism);
  setup.stop_requested = options.stop_requested;
  setup.acknowledge = options.acknowledge;
  std::optional<CellRecorder> cell_recorder;
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
  if (cell_recorder) EndRecording(*cell_recorder, report);
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
  return result;
}

void WriteInputs(const std::vector<ArchivedFile>& inputs, const fs::path& out) {
  for (const ArchivedFile& input : inputs) {
    WriteFileAtomically((out / input.name).string(), input.text);
  }
}

void WriteManifest(const Pipeline& pipeline, double wall_s) {
  const RoundOptions& options = pipeline.options;
  WriteJsonFile(Manifest(pipeline.scenario, pipeline.resolved_toml, options.program_version,
                         options.parallelism.threads, wall_s),
                (fs::path(options.out_folder) / "manifest.json").string());
}

}  // namespace

std::string FailureFolderName(int row) {
  char name[32];
  std::snprintf(name, sizeof name, "attempt_%03d", row + 1);
  return name;
}

RoundResult RunRound(const Scenario& given, const RoundOptions& options) {
  RequireTwin(given, "this round");
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
  ClaimResultFolder(options.out_folder, resolved, options.force);

  const RoundPhysics physics = ScenarioPhysics(scenario, asked.part);
  const Pile pile = held ? asked : StartPile(scenario, asked, physics);
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

  TwinRoundRecorder recorder(twin, pile, std::move(visuals), options);
  fs::remove(out / kRoundCheckpointFile);
  recorder.on_several = [&](const AttemptCheckpoint& state, const ScorerState& scorer) {
    twin.WakeAll();  // Whether it is stored or not: both go on alike.
    if (!scenario.cycle.end_at_several) return;
    SaveRoundCheckpoint(pile, scenario.seed, twin.State(), state, scorer,
                        (out / kRoundCheckpointFile).string());
  };
  if (held) Resume(*held, twin, recorder);
  const Pipeline pipeline{scenario, resolved, asked.part, held, options};
  RoundResult result = RunPipeline(twin.cell(), pipeline, recorder);
  const double cycle_wall_s = WallClock_s() - began;
  if (options.keep == RoundKeep::kAll ||
      (options.keep == RoundKeep::kFailures && recorder.AnyFailure())) {
    WriteRecord(recorder, options);
  }
  WriteManifest(pipeline, cycle_wall_s);
  return result;
}

RoundResult RunCellRound(Cell& cell, const Scenario& scenario, const RoundOptions& options) {
  const double began = WallClock_s();
  const fs::path out(options.out_folder);
  const Part part = LoadPart(ScenarioPartName(scenario));
  Scenario archived = scenario;
  const std::vector<ArchivedFile> inputs = ArchiveInputs(archived);
  const std::string resolved = ResolvedToml(archived);
  ClaimResultFolder(options.out_folder, resolved, options.force);
  WriteInputs(inputs, out);
  // Of a round of the twin that was here: they would be taken for this one's.
  for (const char* name : {"start.pile.json", "cell.xml", "recording.bin", kRoundCheckpointFile}) {
    fs::remove(out / name);
  }
  RoundRecorder recorder(RoundScorer(), options);
  const Pipeline pipeline{scenario, resolved, part, std::nullopt, options};
  RoundResult result = RunPipeline(cell, pipeline, recorder);
  const double cycle_wall_s = WallClock_s() - began;
  if (options.keep == RoundKeep::kAll && options.write_report) {
    options.write_report(options.out_folder);
  }
  WriteManifest(pipeline, cycle_wall_s);
  return result;
}

}  // namespace tubetwin

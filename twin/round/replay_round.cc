#include "twin/round/replay_round.h"

#include <utility>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "scenes/engine/engine_error.h"

namespace tubetwin {
namespace {

Json Believed(const std::optional<Detection>& detection) {
  if (!detection) return nullptr;
  return Json{{"outcome", ToString(detection->outcome)},
              {"force_N", detection->force_N},
              {"torque_Nm", ToJson(detection->torque_Nm)},
              {"at_s", detection->at_s}};
}

std::string BelievedRound(const RoundReport& report) {
  return Json{{"end", ToString(report.end)},
              {"reason", report.reason},
              {"placed", report.placed_believed},
              {"unseen_m3", report.unseen_m3}}
      .dump();
}

/// Tells the replay what the pipeline says, and the caller how far it is.
class ReplayObserver : public CycleObserver {
 public:
  ReplayObserver(ReplayCell& replay, const ReplayOptions& options, ReplayResult& result)
      : replay_(replay), options_(options), result_(result) {}
  void OnStep(const std::string& caption) override {
    replay_.Caption(caption);
    if (options_.progress) options_.progress(caption);
  }
  void OnAttemptEnd(const AttemptReport& report) override {
    ++result_.attempts;
    if (report.outcome == AttemptOutcome::kPlaced) ++result_.placed;
    if (options_.progress) {
      options_.progress("attempt " + std::to_string(result_.attempts) + ": " +
                        ToString(report.outcome) +
                        (report.reason.empty() ? "" : ", " + report.reason));
    }
    replay_.Result(BelievedAttempt(report));
  }

 private:
  ReplayCell& replay_;
  const ReplayOptions& options_;
  ReplayResult& result_;
};

Scenario RecordedScenario(const CellRecordingHeader& header, const std::string& path) {
  try {
    ConfigSource source;
    source.AddText(header.config_toml, path + " (its configuration)");
    Scenario scenario = ReadScenario(source);
    scenario.seed = header.seed;
    return scenario;
  } catch (const Error& e) {
    throw Error(ErrorKind::kBadData, e.what());
  }
}

}  // namespace

CellRecordingHeader CellHeader(const Scenario& scenario, const std::string& resolved_toml,
                               const std::string& program_version, const Part& part,
                               const std::optional<RoundCheckpoint>& held) {
  CellRecordingHeader header;
  header.versions = {
      {"program", program_version}, {"mujoco", EngineVersion()}, {"compiler", __VERSION__}};
  header.seed = scenario.seed;
  header.config_toml = resolved_toml;
  header.fingerprint = Fingerprint(resolved_toml);
  header.part = part;
  if (held) {
    header.held = ToJson(held->cycle).dump();
  }
  return header;
}

std::string BelievedAttempt(const AttemptReport& report) {
  Json row;
  row["attempt"] = report.attempt;
  row["tubes_in_bin"] = report.tubes_in_bin;
  row["target"] = report.plan ? Json(report.plan->target) : Json(nullptr);
  row["motion"] = report.plan ? Json(report.plan->motion.name) : Json(nullptr);
  row["first_weighing"] = Believed(report.first_weighing);
  row["detection"] = Believed(report.detection);
  row["resolution_used"] = report.resolution_used;
  if (report.resolution_outcome) row["resolution_outcome"] = ToString(*report.resolution_outcome);
  row["outcome"] = ToString(report.outcome);
  row["reason"] = report.reason;
  return row.dump();
}

void EndRecording(CellRecorder& recorder, const RoundReport& report) {
  recorder.Result(BelievedRound(report));
  recorder.Finish(report.reason);
}

void EndReplay(ReplayCell& replay, const RoundReport& report) {
  replay.Result(BelievedRound(report));
  replay.Finish();
}

ReplayResult ReplayRound(const std::string& recording_path, const ReplayOptions& options) {
  ReplayResult result;
  CellRecording recording(recording_path);
  result.complete = recording.complete();
  result.end = recording.end_time();
  ReplayCell replay(std::move(recording));
  const CellRecordingHeader& header = replay.header();
  const Scenario scenario = RecordedScenario(header, recording_path);
  replay.cell().safety = ScenarioSafety(scenario);
  const PickCycleSetup setup =
      ScenarioCycle(scenario, header.model, header.part, options.parallelism);
  ReplayObserver observer(replay, options, result);
  try {
    RoundReport report;
    if (header.held.empty()) {
      report = RunPickCycle(replay.cell(), setup, observer);
    } else {
      const Json held = Json::parse(header.held, nullptr, false);
      report = ResumeAttempt(replay.cell(), setup,
                             AttemptCheckpointFromJson(JsonView(held, recording_path)), observer);
    }
    EndReplay(replay, report);
  } catch (const ReplayOver&) {
    // The tally says why.
  }
  result.tally = replay.tally();
  return result;
}

}  // namespace tubetwin

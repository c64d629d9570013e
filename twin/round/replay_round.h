#pragma once

#include <functional>
#include <optional>
#include <string>

#include "hw_bridge/recording/cell_recorder.h"
#include "hw_bridge/recording/replay_cell.h"
#include "models/base/parallel.h"
#include "planner/cycle/pick_cycle.h"
#include "twin/round/round_checkpoint.h"
#include "twin/round/scenario.h"

namespace tubetwin {

// Recording the cell of a round, and running the pipeline again on the recording. Nothing here
// sees truth: what is compared is what the pipeline commanded and believed.

/// The head of a round's cell recording. Layout and bin are the recorder's matter.
CellRecordingHeader CellHeader(const Scenario& scenario, const std::string& resolved_toml,
                               const std::string& program_version, const Part& part,
                               const std::optional<RoundCheckpoint>& held);

/// What the pipeline believes of an attempt, as a line of JSON without what a clock measured.
std::string BelievedAttempt(const AttemptReport& report);

/// Writes the end of the round into its recording.
void EndRecording(CellRecorder& recorder, const RoundReport& report);
/// Compares the end of the round with the recorded one. Throws ReplayOver.
void EndReplay(ReplayCell& replay, const RoundReport& report);

struct ReplayOptions {
  Parallelism parallelism = Parallelism::All();
  /// Hears the captions of the steps and what each attempt came to.
  std::function<void(const std::string&)> progress;
};

/// What a replayed round came to.
struct ReplayResult {
  ReplayTally tally;
  bool complete = false;         ///< The recording has its end; else it was cut short.
  TimeNs end{0};                 ///< Cell time up to which it was recorded.
  int attempts = 0, placed = 0;  ///< Believed, of the replay, up to where it ended.
};

/// Runs the pick cycle of this program with the recording's configuration on the recorded cell,
/// up to the first difference. Throws Error(kMissing | kBadData) for the file, and Error(kBadData)
/// when this program cannot read its configuration.
ReplayResult ReplayRound(const std::string& recording_path, const ReplayOptions& options);

}  // namespace tubetwin

#pragma once

#include <functional>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "hw_bridge/recording/replay_cell.h"
#include "models/base/parallel.h"
#include "planner/cycle/pick_cycle.h"
#include "twin/round/records/round_record.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// What a round leaves in its folder besides configuration, start, rows and summary.
enum class RoundKeep {
  kAll,       ///< Recording and report, state and clouds of failed attempts.
  kFailures,  ///< The same, but nothing when no attempt failed.
  kRows,      ///< Nothing.
};

struct RoundOptions {
  std::string out_folder;
  Parallelism parallelism = Parallelism::All();
  RoundKeep keep = RoundKeep::kAll;
  bool video = false;  ///< With kAll only.
  /// Also record what crosses the cell's border (kCellRecordingFile), for ReplayRound().
  bool record_cell = false;
  /// The cell of RunCellRound when it is a recorded one: it compares what the pipeline says, too.
  ReplayCell* replay = nullptr;
  bool force = false;  ///< Replace rows of another configuration.
  std::string program_version;
  std::function<void(const std::string&)>
      progress;                          ///< One line of where the round is; may be empty.
  std::function<bool()> stop_requested;  ///< Ends the round after the attempt under way.
  std::function<bool()> stop_at_once;    ///< Ends it where the arm is, on its path.
  /// Makes the page of the finished result folder; empty: there is none. Pages are made in a room
  /// above this one, so whoever starts a round hands it in.
  std::function<void(const std::string& folder)> write_report;
  /// Told of every look into the bin and the plan made from it, or null; may be empty.
  std::function<void(const TubeScene& scene, const PickPlan* plan)> on_scene;
  /// As PickCycleSetup's: an operator's word after a stop.
  std::function<Acknowledgement(const std::string&)> acknowledge;
};

/// What a round came to.
struct RoundResult {
  RoundRecord record;  ///< As in its folder.
  bool interrupted = false;
  bool faulted = false;  ///< A device ended it.
};

/// The stored moment that a round with cycle.end_at_several ends at; pile.file takes it.
inline constexpr const char* kRoundCheckpointFile = "held.pile.json";

/// What crossed the cell's border in a round, in its folder; recording.bin is what it looked like.
inline constexpr const char* kCellRecordingFile = "cell.rec.zst";

/// Folder of a failed attempt below failures/; `row` counts rows of picks.jsonl from 0.
std::string FailureFolderName(int row);

/// Runs one whole round in the twin, all of whose devices are the scenario's, and writes the result
/// folder (design.md 7): wires cell, cycle and evaluator, and alone scores by truth. Same scenario,
/// same bytes in every file but manifest.json, timings.jsonl and the film. Throws
/// Error(kCannotCreate) when the folder holds rows of another configuration, before anything is
/// written; Error(kConfig) for other devices; and what settling, devices and files throw.
RoundResult RunRound(const Scenario& scenario, const RoundOptions& options);

/// Runs one whole round on a cell whose truth nobody knows, whatever its devices are: same folder
/// without start.pile.json, cell.xml and pictures; what counts as placed is what the pipeline
/// believes (RoundScorer). The round ends with "fault" when a device fails. Throws as RunRound.
RoundResult RunCellRound(Cell& cell, const Scenario& scenario, const RoundOptions& options);

}  // namespace tubetwin

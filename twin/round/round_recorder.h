#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/recording/cell_recorder.h"
#include "models/base/disk/output_file.h"
#include "planner/cycle/pick_cycle.h"
#include "twin/cell/twin_cell.h"
#include "twin/render/recording.h"
#include "twin/round/folder/result_folder.h"
#include "twin/round/round.h"
#include "twin/round/scoring.h"

namespace tubetwin {

/// Which of the views that an attempt was planned from its failure keeps: the one that shows most
/// points within 5 cm of the grasp; all where there was no plan, since each may be why.
std::vector<std::size_t> ViewsOfFailure(const std::vector<OrganizedCloud>& views,
                                        const AttemptRecord& attempt);

/// Follows one round on any cell: records of attempts, the clouds of failed attempts. Lives as long
/// as the round.
class RoundRecorder : public CycleObserver {
 public:
  RoundRecorder(RoundScorer scorer, const RoundOptions& options);

  void OnStep(const std::string& caption) override;
  void OnClouds(const std::vector<OrganizedCloud>& views) override { last_views_ = views; }
  void OnScene(const TubeScene& scene, const PickPlan* plan) override {
    if (options_.on_scene) options_.on_scene(scene, plan);
  }
  void OnDetection(const Detection&) override { scorer_.AtDetection(); }
  void OnAttemptEnd(const AttemptReport& report) override;

  /// The cycle ended: keeps what it computed after the last attempt.
  void OnRoundEnd(const RoundReport& report);
  /// After the last attempt: completes its record, if need be by letting time pass.
  virtual void Finish() {}
  RoundSummary Summary(const RoundReport& report, double sim_s) const {
    return scorer_.Summary(report, attempts, sim_s);
  }
  bool AnyFailure() const;

  std::vector<AttemptRecord> attempts;
  std::vector<AttemptTiming> timings;
  CellRecorder* tape = nullptr;    ///< Of the cell; null: it is not recorded.
  ResultFolder* folder = nullptr;  ///< Hears what is kept of failures before it is written.

  /// From here on each row is saved as its attempt ends, in picks.jsonl and timings.jsonl of
  /// `folder`: what a real cell did cannot be repeated. Throws Error(kCannotCreate | kIo).
  void SaveRowsAtOnce();

 protected:
  /// An attempt failed; its row is the last. `folder` exists and holds attempt.json and clouds.
  virtual void OnFailure(const std::string& /*folder*/) {}
  /// The last record is complete: keeps what a failed attempt leaves.
  void Conclude();

  const RoundOptions& options_;
  RoundScorer scorer_;
  std::vector<OrganizedCloud> last_views_;

 private:
  void SaveFailure();
  double attempt_began_ = 0.0;
  std::optional<OutputFile> picks_, timings_file_;  ///< Nothing: rows are written at the end.
};

/// The same in the twin: rows by truth, and what the world looked like. Truth is looked at a while
/// after an attempt's end, when what it let go of has come to rest; the pipeline goes on meanwhile.
class TwinRoundRecorder : public RoundRecorder {
 public:
  TwinRoundRecorder(TwinCell& twin, const Pile& pile, const PlacementTolerance& tolerance,
                    std::vector<Recording::Visual> visuals, const RoundOptions& options);

  void OnStep(const std::string& caption) override;
  void OnScene(const TubeScene& scene, const PickPlan* plan) override;
  void OnReference(const Wrench& reference_K) override;
  void OnSeveral(const AttemptCheckpoint& state) override { on_several(state, scorer_.state()); }
  void OnAttemptEnd(const AttemptReport& report) override;
  void Finish() override;

  void Resume(const ScorerState& scorer) { scorer_.Restore(scorer); }
  const Recording& recording() const { return recording_; }

  /// Told of the moment when several hang, with the scorer's state.
  std::function<void(const AttemptCheckpoint&, const ScorerState&)> on_several;

 private:
  void OnFailure(const std::string& folder) override;
  void AddFrame();
  void LookAtTruth();

  TwinCell& twin_;
  Recording recording_;
  Wrench reference_K_;
  bool tared_ = false;
  struct Look {
    AttemptReport report;
    TimeNs due{0};
  };
  std::optional<Look> look_;  ///< Still to come, for the last record.
};

}  // namespace tubetwin

#pragma once

#include <string>

#include "planner/extraction/extraction_config.h"
#include "planner/grasp/grasp.h"
#include "planner/pick/nudge_config.h"

namespace tubetwin {

/// Which of several picks is taken, and how much is asked of the evaluator; keys of config table
/// [planner].
struct SearchConfig {
  double weight_confidence = 0.2;  ///< Not in the paper: doubt about the tube costs.
  double weight_release = 0.1;     ///< Not in the paper: setting fewer than three tubes free costs.
  double weight_extra = 3.0;       ///< Not in the paper: probability that another tube comes along.
  double min_length_share = 0.7;   ///< Tubes shorter than this share of the part come last.
  double min_confidence = 0.3;     ///< Tubes below come last.
  /// Not in the paper: more tubes are evaluated while another one comes along more often than this.
  double accept_extra = 0.15;
  /// So many tubes get the motions of the second tier, and after that those of the last, where
  /// nothing else promises to take a tube alone. 0: none, as in the paper.
  int separated = 7;
  /// Roll-outs for one choice among `budget_tubes` hoses end after so much simulated time, part of
  /// which is kept for samples of the best motions; fewer tubes get more in proportion, rigid ones
  /// `budget_rigid` times as much, as they are simulated as much faster.
  double max_simulated_s = 30.0;
  double budget_tubes = 7.0;
  double budget_rigid = 3.0;
  int samples = 5;          ///< Roll-outs of the best candidates; 1 is the paper's cost.
  int refined = 2;          ///< So many of the best candidates get all samples.
  int max_candidates = 12;  ///< Motions that are simulated before it is known whether one will do.
  int max_plans = 8;        ///< Ranked plans that are checked for the arm and returned.
  int plans_per_tube = 3;
  /// What a tube's class is counted by: "crossings" over it, or the "occluded_joints" of the
  /// leao2020 profile, whose strongly occluded tubes are not picked and whose escapes follow the
  /// joint.
  std::string classes = "crossings";
  bool exclude_free = false;  ///< Free tubes stay but may not be chosen.

  bool by_occluded_joints() const { return classes == "occluded_joints"; }
  void Visit(ConfigVisitor& v);
};

/// Config table [planner]: what its trades need, in one flat table.
struct PlannerConfig : ExtractionConfig, GraspConfig, SearchConfig, NudgeConfig {
  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "perception/scene/tube_scene.h"
#include "planner/grasp/detection.h"
#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// How an attempt ended, as the pipeline believes.
enum class AttemptOutcome { kPlaced, kPutBack, kNothingHeld, kDropped, kNoPlan, kFault };
const char* ToString(AttemptOutcome outcome);

/// A tube that was pushed to where it can be grasped, because none could be.
struct NudgeReport {
  int tube = 0;
  Vector3 direction_N = Vector3::Zero();  ///< Horizontal unit vector.
  double travel_m = 0.0;                  ///< Of the fingers while they were down, all strokes.
  bool contact = false;                   ///< The wrist felt the tube on the way down.
  double press_N = 0.0;                   ///< Largest load on the wrist once the fingers pressed.
  bool stopped = false;                   ///< The force limit ended it.
  std::string rejected;                   ///< Why a motion of it was not run; empty: all were.
};

/// One attempt to pick one tube: what was seen, decided, felt and done. Nothing in it comes from
/// truth.
struct AttemptReport {
  int attempt = 1;                          ///< Counts from 1 after each placed tube.
  int tubes_in_bin = 0;                     ///< Perceived.
  std::optional<PickPlan> plan;             ///< None: no plan was found.
  std::vector<Rejection> rejections;        ///< Why others were not taken.
  std::string reason;                       ///< Of the outcome, for people.
  std::vector<NudgeReport> nudges;          ///< Before the plan was found, or in vain.
  std::optional<Detection> first_weighing;  ///< After the 3 cm lift.
  std::optional<Detection> detection;       ///< The decision after the whole motion.
  bool resolution_used = false;
  std::string strategy = "none";  ///< Name of the resolution strategy that the round has.
  std::optional<HeldOutcome> resolution_outcome;
  AttemptOutcome outcome = AttemptOutcome::kNoPlan;
  /// Where the tube was meant to lie: its centre and direction on the tray, frame T.
  std::optional<Vector3> slot_centre_T;
  struct SimTime {
    double scan = 0, move = 0, weigh = 0, settle = 0;
    double total() const { return scan + move + weigh + settle; }
  } sim_s;  ///< Simulated seconds.
  /// The same time by what it was for, in the order of a pick. Every moment from the attempt's
  /// begin to its end belongs to exactly one phase, so that total() is how long it took.
  struct Phases {
    double look = 0;     ///< Scans, and from view to view.
    double reach = 0;    ///< To over the grasp and down to it.
    double close = 0;    ///< The fingers.
    double lift = 0;     ///< The extraction motion.
    double weigh = 0;    ///< Every wait for the load, tare included.
    double carry = 0;    ///< To over the slot of the tray.
    double place = 0;    ///< Down onto the tray and letting go.
    double back = 0;     ///< Up from the tray; and to the first view, which the next attempt tells.
    double recover = 0;  ///< Nudging, separating in the air, putting back.
    double total() const;
  } phases_s;  ///< Simulated seconds.
  struct ComputeTime {
    double modelling = 0, planning = 0, evaluator = 0, total = 0;
  } compute_s;  ///< Wall seconds; never in picks.jsonl.
};

/// A phase and what files call it.
struct NamedPhase {
  const char* name;
  double AttemptReport::Phases::*phase;
};
/// All phases in the order of a pick.
const std::array<NamedPhase, 9>& AttemptPhases();
/// {look, reach, close, lift, weigh, carry, place, return, recover}, as in picks.jsonl. Reading
/// throws Error(kBadData).
Json ToJson(const AttemptReport::Phases& phases_s);
AttemptReport::Phases PhasesFromJson(const JsonView& view);

/// Why a round ended.
enum class RoundEnd { kEmpty, kNoPlan, kAttemptLimit, kFault, kInterrupted, kStored };
const char* ToString(RoundEnd end);

/// As in picks.jsonl.
Json ToJson(const NudgeReport& nudge);
NudgeReport NudgeReportFromJson(const JsonView& view);

struct RoundReport {
  RoundEnd end = RoundEnd::kEmpty;
  std::string reason;
  int placed_believed = 0;
  double unseen_m3 = 0.0;  ///< Of the last look.
  /// Of what came after the last attempt: the look that found nothing to do. Wall seconds.
  AttemptReport::ComputeTime compute_s;
};

}  // namespace tubetwin

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/step_timer.h"
#include "planner/cycle/pick_cycle.h"
#include "planner/grasp/gripper_boxes.h"
#include "planner/grasp/held_part.h"
#include "planner/motion/path_builder.h"
#include "planner/motion/path_executor.h"

namespace tubetwin {

/// Closed fingers with less between them hold nothing.
inline constexpr double kNothingOpening_m = 0.004;

/// What the steps of one round share. One per RunPickCycle; all steps run on the caller's thread.
struct CycleContext {
  CycleContext(Cell& the_cell, const PickCycleSetup& the_setup, CycleObserver& the_observer)
      : cell(the_cell),
        setup(the_setup),
        observer(the_observer),
        executor(the_cell),
        gripper(MakeGripperGeometry(the_cell.model)),
        strategy(setup.strategy ? *setup.strategy
                                : ResolutionStrategyOf(setup.resolution.strategy)),
        motions(setup.motions ? *setup.motions : ExtractionMotionsOf(setup.planner)) {}

  Cell& cell;
  const PickCycleSetup& setup;
  CycleObserver& observer;
  PathExecutor executor;
  GripperGeometry gripper;
  ResolutionStrategy strategy;
  std::vector<ExtractionMotion> motions;
  AttemptReport report;                     ///< Of the running attempt.
  Wrench reference_K;                       ///< Tare with empty fingers, tool vertical.
  std::optional<Wrench> first_reference_K;  ///< The round's first.
  TimeNs attempt_began{0};
  HeldPart held;                   ///< How far what the fingers hold sags and how slowly it swings.
  std::vector<Polyline> placed_T;  ///< Tubes on the tray, as they were laid.

  /// Adds the simulated time that passes during its life to one class of the report.
  class Timed {
   public:
    Timed(CycleContext& context, double AttemptReport::SimTime::*which)
        : context_(context), which_(which), began_(context.cell.clock.Now()) {}
    ~Timed() { context_.report.sim_s.*which_ += Seconds(context_.cell.clock.Now() - began_); }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

   private:
    CycleContext& context_;
    double AttemptReport::SimTime::*which_;
    TimeNs began_;
  };

  using Phase = double AttemptReport::Phases::*;
  /// From now on time counts as `phase` of the attempt. Returns the phase until now.
  Phase Enter(Phase phase);
  /// A new attempt begins now, with an empty report, looking.
  void BeginPhases();
  /// During its life time counts as `phase`, behind it as before.
  class During {
   public:
    During(CycleContext& context, Phase phase) : context_(context), outer_(context.Enter(phase)) {}
    ~During() { context_.Enter(outer_); }
    During(const During&) = delete;
    During& operator=(const During&) = delete;

   private:
    CycleContext& context_;
    Phase outer_;
  };

  /// From now on the fingers hold a part that lies so in frame E, or nothing.
  void Hold(const Polyline& line_E) { held = HeldPartOf(line_E, setup.part); }
  /// What was held was let go: nothing is carried and nothing weighs on the arm.
  void Released();
  /// Of the pads, to let go of one tube and no more.
  double ReleaseOpening() const;
  /// For the paths of what is held.
  PathBuilder Path() const { return PathBuilder(setup.cycle, held.period_s); }
  /// Runs one stage of a path; its time counts as motion.
  StepOutcome Run(const CheckedPath& path, int stage);
  /// Checks a path and runs it; its time counts as motion.
  StepOutcome CheckAndRun(const PickPath& path);

 private:
  Phase phase_ = &AttemptReport::Phases::look;
  TimeNs phase_began_{0};
};

}  // namespace tubetwin

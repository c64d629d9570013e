#pragma once

#include "models/base/config/config.h"
#include "models/base/parallel.h"
#include "planner/grasp/gripper_boxes.h"
#include "planner/pick/evaluation.h"

namespace tubetwin {

/// Config table [evaluator]: the pipeline's own nominal physics, never the twin's draw.
struct EvaluatorConfig {
  double timestep_s = 0.005;
  double tolerance = 1e-4;     ///< At which the contact solver ends (mjOption.tolerance).
  double hand_force_N = 30.0;  ///< Of the hand on each axis; more than that is a jam.
  double jam_s = 0.2;          ///< Saturated for longer: jammed.
  double hold_s = 0.3;         ///< After the motion, before the displacement is taken.
  /// A roll-out that has displaced the others by more ends: far more than what one takes for good.
  double give_up_m = 0.5;
  double max_sim_s = 30.0;  ///< Longest motion that is accepted.
  /// Samples after the first: one sigma of each perceived tube's position error, per axis.
  double pose_error_m = 0.0007;
  void Visit(ConfigVisitor& v);
};

struct EvaluatorOptions {
  Parallelism parallelism;
  EvaluatorConfig config;
  GripperGeometry gripper;  ///< What the hand's fingers and body fill.
};

/// Roll-outs in MuJoCo of the perceived tubes (Leão et al. 2020, section 3.3.2, with a
/// force-limited hand instead of prescribed positions): 5 ms, discrete integrator, elliptic cone,
/// impratio 10, the solver's tolerance 1e-4 once the scene has settled. Rigid parts are capsule
/// chains, hoses two-hinge chains that rest in the perceived shape. The scene settles once per
/// sample, loses its speed and is kept; every roll-out starts from there. A hand on three
/// force-limited slides and three hinges is welded to the link that is gripped and follows the
/// waypoints at the motion's speed, with ramps of 0.15 s. It has the closed fingers and the
/// gripper's body, vertical and across the tube, which push other tubes.
///
/// A sample's displacement is the sum over the other tubes' centres of mass, each less what it
/// creeps without any motion. The first sample is nominal; later ones draw friction, stiffness and
/// position errors from the request's seed. displacement_m is the samples' mean, extra_probability
/// the share of samples in which another tube ends over the rim (3 cm up at least) or off the bin,
/// cost = displacement + 1 m * extra_probability (samples = 1: displacement alone, as in the paper)
/// + 1 m when jammed, + 10 m when diverged. Status: diverged when any sample did, jammed when half
/// of them or more did, pruned when the swept volumes of tube and fingers touch no other tube.
///
/// A roll-out ends early on a jam; when all others are at rest and the lifted tube is a radius over
/// them or only rises from there on with none of them over it, where a tube that it carries up
/// without slipping (1 cm/s, for 0.15 s) counts as part of it and is measured where it would
/// arrive; or, unless the motion is a tip, when the displacement exceeds give_up_m, the request's
/// for this candidate or the configuration's if that is less: a lower bound then, another tube over
/// the rim just then came along. Tubes that lie still sleep until touched. `full`: none of the
/// pruning and shortening. sim_s and wall_s are sums over the samples' roll-outs.
///
/// Settled scenes of the last pile are kept for the next question about it.
/// The function may be called from several threads at once; results do not depend on the thread
/// count nor on the order of candidates. Throws Error(kBadData) for a tube that is not in the
/// scene, a motion without waypoints, longer than max_sim_s, not finite or turned by more than 80
/// degrees about N's y axis, a place outside the tube; LogicError for grasp_at_m of another size.
EvaluateFunction MakeEvaluator(const EvaluatorOptions& options);

}  // namespace tubetwin

#pragma once

#include <array>

#include "models/base/config/config.h"
#include "models/base/frames.h"
#include "models/base/random.h"
#include "models/part.h"

namespace tubetwin {

/// Ranges that a round's physics is drawn from (config table [physics]). Tube friction and bending
/// stiffness come from the part unless given here.
struct PhysicsRanges {
  bool randomize = true;                   ///< false: nominal values for everything.
  std::vector<double> tube_friction = {};  ///< Empty: the part's range.
  std::vector<double> bending_stiffness_Nm2 = {};
  std::array<double, 2> pad_friction = {0.6, 1.0};
  std::array<double, 2> pad_torsion_m = {0.003, 0.005};
  std::array<double, 2> mass_scale = {0.9, 1.1};
  std::array<double, 2> depth_noise_scale = {1.0, 2.0};
  double wrench_noise_counts = 1.0;
  double wrench_bias_walk_N = 0.1;   ///< Over ten minutes, one sigma.
  double wrench_cross_talk = 0.01;   ///< Share of full scale.
  double hand_eye_error_m = 0.0003;  ///< One sigma per axis.
  double hand_eye_error_deg = 0.05;
  void Visit(ConfigVisitor& v);
};

/// One round's draw. The twin has it; the pipeline never sees it.
struct RoundPhysics {
  double tube_friction = 0.3;
  double bending_stiffness_Nm2 = 0.15;
  double pad_friction = 0.8;
  double pad_torsion_m = 0.004;
  double mass_scale = 1.0;
  double depth_noise_scale = 1.0;
  double wrench_noise_counts = 1.0;
  double wrench_bias_walk_N = 0.1;
  double wrench_cross_talk = 0.01;
  RigidTransform X_SbelievedS =
      RigidTransform::Identity();  ///< Hand-eye error: true S in believed S.
};

/// Nominal values of the part, no noise in the hand-eye pose.
RoundPhysics NominalPhysics(const Part& part);

/// Uniform draws, in a fixed order, from `stream`. Throws Error(kConfig) for a range that is no
/// [from, to].
RoundPhysics DrawPhysics(const PhysicsRanges& ranges, const Part& part, RandomStream stream);

}  // namespace tubetwin

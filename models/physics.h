#pragma once

#include <array>
#include <optional>
#include <vector>

#include "models/base/config/config.h"
#include "models/base/frames.h"
#include "models/base/random.h"
#include "models/part.h"

namespace tubetwin {

/// How far the tubes of one batch differ from each other: each tube's value is its round's times
/// one plus a uniform draw within +- these shares.
struct SpecimenSpread {
  double mass = 0.02, radius = 0.004, length = 0.004;
  double stiffness = 0.10, friction = 0.05, loss = 0.10;
  void Visit(ConfigVisitor& v);
};

/// One tube's factors against its round's values.
struct Specimen {
  double mass = 1.0, radius = 1.0, length = 1.0;
  double stiffness = 1.0, friction = 1.0, loss = 1.0;
};

/// Ranges that a round's physics is drawn from (config table [physics]). Friction of tubes on each
/// other, on the bin and on the tray are drawn apart. What is left empty comes from the part.
struct PhysicsRanges {
  bool randomize = true;                   ///< false: nominal values for everything.
  std::vector<double> tube_friction = {};  ///< Tube on tube.
  std::vector<double> bin_friction = {};   ///< Tube on the bin's floor and walls.
  std::vector<double> tray_friction = {};  ///< Tube on the tray and what else stands in the cell.
  std::vector<double> bending_stiffness_Nm2 = {};
  std::vector<double> loss_factor = {};
  std::array<double, 2> pad_friction = {0.6, 1.0};
  std::array<double, 2> pad_torsion_m = {0.0005, 0.0015};
  std::array<double, 2> mass_scale = {0.9, 1.1};
  std::array<double, 2> depth_noise_scale = {1.0, 2.0};
  double wrench_noise_counts = 1.0;
  double wrench_bias_walk_N = 0.1;   ///< Over ten minutes, one sigma.
  double wrench_cross_talk = 0.01;   ///< Share of full scale.
  double hand_eye_error_m = 0.0003;  ///< One sigma per axis.
  double hand_eye_error_deg = 0.05;
  SpecimenSpread specimen;
  void Visit(ConfigVisitor& v);
};

/// One round's draw. The twin has it; the pipeline never sees it.
struct RoundPhysics {
  double tube_friction = 0.3, bin_friction = 0.3, tray_friction = 0.3;
  double bending_stiffness_Nm2 = 0.15;
  double loss_factor = 0.15;
  double pad_friction = 0.8;
  double pad_torsion_m = 0.001;
  double mass_scale = 1.0;
  double depth_noise_scale = 1.0;
  double wrench_noise_counts = 1.0;
  double wrench_bias_walk_N = 0.1;
  double wrench_cross_talk = 0.01;
  RigidTransform X_SbelievedS =
      RigidTransform::Identity();  ///< Hand-eye error: true S in believed S.
  SpecimenSpread specimen{0, 0, 0, 0, 0, 0};
  std::optional<RandomStream> specimens;  ///< Of the tubes' own draws; nothing: all are alike.

  /// The tube of this number; the same for every caller of one round.
  Specimen SpecimenOf(int tube_id) const;
};

/// Nominal values of the part, no noise in the hand-eye pose.
RoundPhysics NominalPhysics(const Part& part);

/// Uniform draws, in a fixed order, from `stream`. Throws Error(kConfig) for a range that is no
/// [from, to].
RoundPhysics DrawPhysics(const PhysicsRanges& ranges, const Part& part, RandomStream stream);

}  // namespace tubetwin

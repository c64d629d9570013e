#include "models/physics.h"

#include <string>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

template <class Range>
double Draw(RandomStream& stream, const Range& range, const char* key) {
  if (range.size() != 2) {
    throw Error(ErrorKind::kConfig, std::string("physics.") + key + " has " +
                                        std::to_string(range.size()) +
                                        " numbers; allowed: none or two, from and to");
  }
  if (range[0] > range[1]) {
    throw Error(ErrorKind::kConfig, std::string("physics.") + key + " is [" + Number(range[0]) +
                                        ", " + Number(range[1]) +
                                        "]; the first number must not be above the second");
  }
  return stream.Uniform(range[0], range[1]);
}

const std::vector<double>& Given(const std::vector<double>& range,
                                 const std::vector<double>& part) {
  return range.empty() ? part : range;
}

}  // namespace

void SpecimenSpread::Visit(ConfigVisitor& v) {
  v.Field("mass", "tubes differ by up to this share of the mass", mass, {0.0, 0.5});
  v.Field("radius", "of the radius", radius, {0.0, 0.1});
  v.Field("length", "of the length", length, {0.0, 0.1});
  v.Field("stiffness", "of the bending stiffness", stiffness, {0.0, 0.9});
  v.Field("friction", "of the friction, tube on tube", friction, {0.0, 0.9});
  v.Field("loss", "of the loss factor", loss, {0.0, 0.9});
}

void PhysicsRanges::Visit(ConfigVisitor& v) {
  v.Field("randomize", "draw within the ranges each round; false takes nominal values", randomize);
  v.Field("tube_friction", "tube on tube, from and to; empty: the part's range", tube_friction, 0,
          {0.01, 3.0});
  v.Field("bin_friction", "tube on the bin, from and to; empty: the part's range", bin_friction, 0,
          {0.01, 3.0});
  v.Field("tray_friction", "tube on the tray, from and to; empty: the part's range", tray_friction,
          0, {0.01, 3.0});
  v.Field("bending_stiffness_Nm2", "from and to; empty: the part's range", bending_stiffness_Nm2, 0,
          {0.005, 50.0});
  v.Field("loss_factor", "of hoses, from and to; empty: the part's range", loss_factor, 0,
          {0.0, 2.0});
  v.Field("pad_friction", "pad on tube, from and to", pad_friction, {0.05, 3.0});
  v.Field("pad_torsion_m", "torsional friction of a pad, from and to", pad_torsion_m, {0.0, 0.02});
  v.Field("mass_scale", "mass of tubes against the part's, from and to", mass_scale, {0.5, 2.0});
  v.Field("depth_noise_scale", "scanner noise against nominal, from and to", depth_noise_scale,
          {0.0, 10.0});
  v.Field("wrench_noise_counts", "noise of force and torque in counts, one sigma",
          wrench_noise_counts, {0.0, 100.0});
  v.Field("wrench_bias_walk_N", "drift of the force sensor over ten minutes, one sigma",
          wrench_bias_walk_N, {0.0, 10.0});
  v.Field("wrench_cross_talk", "cross-talk between sensor axes, share of full scale",
          wrench_cross_talk, {0.0, 0.1});
  v.Field("hand_eye_error_m", "error of the scanner's place on the flange per axis, one sigma",
          hand_eye_error_m, {0.0, 0.02});
  v.Field("hand_eye_error_deg", "error of the scanner's attitude per axis, one sigma",
          hand_eye_error_deg, {0.0, 5.0});
  v.Section("specimen", "how far tubes of one batch differ", specimen);
}

RoundPhysics NominalPhysics(const Part& part) {
  RoundPhysics physics;
  physics.tube_friction = physics.bin_friction = physics.tray_friction = part.friction;
  physics.bending_stiffness_Nm2 = part.bending_stiffness_Nm2;
  physics.loss_factor = part.loss_factor;
  return physics;
}

RoundPhysics DrawPhysics(const PhysicsRanges& ranges, const Part& part, RandomStream stream) {
  RoundPhysics physics = NominalPhysics(part);
  physics.wrench_noise_counts = ranges.wrench_noise_counts;
  physics.wrench_bias_walk_N = ranges.wrench_bias_walk_N;
  physics.wrench_cross_talk = ranges.wrench_cross_talk;
  if (!ranges.randomize) return physics;
  // The order of these lines is part of every published seed.
  physics.tube_friction =
      Draw(stream, Given(ranges.tube_friction, part.friction_range), "tube_friction");
  physics.bending_stiffness_Nm2 =
      Draw(stream, Given(ranges.bending_stiffness_Nm2, part.bending_stiffness_range_Nm2),
           "bending_stiffness_Nm2");
  physics.pad_friction = Draw(stream, ranges.pad_friction, "pad_friction");
  physics.pad_torsion_m = Draw(stream, ranges.pad_torsion_m, "pad_torsion_m");
  physics.mass_scale = Draw(stream, ranges.mass_scale, "mass_scale");
  physics.depth_noise_scale = Draw(stream, ranges.depth_noise_scale, "depth_noise_scale");
  Vector3 shift_m, turn_deg;
  for (int k = 0; k < 3; ++k) shift_m[k] = stream.Normal(0.0, ranges.hand_eye_error_m);
  for (int k = 0; k < 3; ++k) turn_deg[k] = stream.Normal(0.0, ranges.hand_eye_error_deg);
  physics.X_SbelievedS = MakeTransform(
      RotZ(Radians(turn_deg.z())) * RotY(Radians(turn_deg.y())) * RotX(Radians(turn_deg.x())),
      shift_m);
  physics.bin_friction =
      Draw(stream, Given(ranges.bin_friction, part.friction_range), "bin_friction");
  physics.tray_friction =
      Draw(stream, Given(ranges.tray_friction, part.friction_range), "tray_friction");
  physics.loss_factor =
      Draw(stream, Given(ranges.loss_factor, part.loss_factor_range), "loss_factor");
  physics.specimen = ranges.specimen;
  physics.specimens = stream.Fork("specimens");
  return physics;
}

Specimen RoundPhysics::SpecimenOf(int tube_id) const {
  Specimen out;
  if (!specimens) return out;
  RandomStream stream = specimens->Fork("tube", static_cast<std::uint64_t>(tube_id));
  const auto factor = [&stream](double share) { return 1.0 + stream.Uniform(-share, share); };
  // The order of these lines is part of every published seed.
  out.mass = factor(specimen.mass);
  out.radius = factor(specimen.radius);
  out.length = factor(specimen.length);
  out.stiffness = factor(specimen.stiffness);
  out.friction = factor(specimen.friction);
  out.loss = factor(specimen.loss);
  return out;
}

}  // namespace tubetwin

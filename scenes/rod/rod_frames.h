#pragma once

#include <array>
#include <vector>

#include "models/base/polyline.h"

namespace tubetwin {

/// Stiffness of an elastic rod of equal section, N m^2.
struct RodStiffness {
  double bending_Nm2 = 0.15;  ///< EI.
  double torsion_Nm2 = 0.10;  ///< GJ.
};

/// GJ of a round tube or bar of a material that keeps its volume (Poisson's ratio 1/2): the polar
/// second moment of area is twice the axial one and G = E / 3, so GJ = EI / 1.5.
double TorsionalStiffness(double bending_Nm2);

/// Lowest bending frequency of a straight uniform rod with free ends, rad/s: (4.7300)^2 / L^2 times
/// the root of EI over mass per length (Euler and Bernoulli).
double FirstFreeBending(double bending_Nm2, double mass_kg, double length_m);

/// Frames of a hose's links, z along each: as it lies now, and without load.
struct RodFrames {
  std::vector<Matrix3> current, rest;
};

/// How the material of a rod lies that has the axis `current` and without load the axis `rest` (as
/// many nodes, any pose): which way each link is turned about its own axis is not seen from the
/// axes, so it is the one of least elastic energy of bending and twist. Preconditions: three nodes
/// or more, no two neighbours in one place.
RodFrames LeastEnergyFrames(const Polyline& current, const Polyline& rest,
                            const RodStiffness& stiffness);

/// The joint between two links: two bends and a twist.
struct RodJoint {
  /// In the child's frame: x, y bend, z twists. z is the mean direction of both links, so that
  /// torsion acts along the axis of the bent rod and not along one of its chords.
  Matrix3 axes = Matrix3::Identity();
  std::array<double, 3> rest_rad = {0, 0,
                                    0};  ///< Where the springs are at rest; 0: as it lies now.
};
RodJoint JointBetween(const Matrix3& R_ParentChild, const Matrix3& rest_R_ParentChild);

}  // namespace tubetwin

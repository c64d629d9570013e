#pragma once

#include <vector>

#include "perception/leao2020/cylinders.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// An ordered list of cylinders, the paper's virtual tube.
struct LeaoTube {
  std::vector<int> ends;  ///< Entry end of each cylinder: 2 * cylinder + end.
  double length_m = 0.0;  ///< Cylinders and joints.
};

/// How far apart two cylinders' ends are.
struct LeaoJoint {
  double distance_m = 0.0;
  /// Turn from the one axis to the chord plus turn from the chord to the other axis. From axis to
  /// axis where the chord has no direction: endpoints nearer than a radius, or the second one
  /// behind the first but within a radius of its axis (bends, where neighbouring cylinders
  /// overlap).
  double angle_deg = 0.0;
};
LeaoJoint MeasureJoint(const LeaoCylinder& a, int end_a, const LeaoCylinder& b, int end_b,
                       double radius_m);

/// The paper's visibility condition: in the depth image, halfway between both endpoints, some pixel
/// of a small window is nearer than the deeper endpoint, so that something may hide the joint. With
/// several views at least one must say so, and none may see a gap there.
bool IsGapHidden(const std::vector<ViewImage>& views, const Vector3& p_NA, const Vector3& p_NB,
                 double window_m);

/// Greedy joining (section 3.1): pairs of endpoints in the order of cost, joined when they belong
/// to distinct tubes and are still free, within the limits of distance and angle, the gap is
/// hidden, and the whole is no longer than `longest_m`. Tubes in the order of their first cylinder.
std::vector<LeaoTube> JoinCylinders(const std::vector<LeaoCylinder>& cylinders,
                                    const std::vector<ViewImage>& views, double radius_m,
                                    double longest_m, const Leao2020Config& config);

/// Joints whose cylinders come from different segments: the paper's occlusions.
int CountOccludedJoints(const LeaoTube& tube, const std::vector<LeaoCylinder>& cylinders);

}  // namespace tubetwin

// Closed form for arms whose last three axes meet in one point W, and whose axes 2 and 3 are
// parallel: shoulder offsets and forearm offset of any size, axes in any sense.
//
// W does not move with joints 4 to 6, so the pose gives it. Its distance along axis 2 from axis 1
// does not change with joints 2 and 3: that leaves two angles of joint 1. Then axes 2 and 3 are two
// links in a plane (two elbows), and the wrist turns what is left of the rotation (two ways).
// The equations are those of Paden and Kahan's subproblems (Murray, Li, Sastry: A Mathematical
// Introduction to Robotic Manipulation, 1994, 3.2).

#include <cmath>

#include "models/arm/inverse/geometry.h"
#include "models/arm/inverse/inverse_method.h"

namespace tubetwin {
namespace {

Vector3 WristCentre(const ArmModel& arm) { return RequireMeeting(arm, {4, 5, 6}); }

void CheckSphericalWrist(const ArmModel& arm) {
  RequireParallel(arm, 2, 3);
  RequireNotParallel(arm, 1, 2);
  WristCentre(arm);
}

/// Joints 4 to 6 for R_36, appended to q1 to q3.
void AppendWrists(const ArmModel& arm, const JointVector& q, const Matrix3& R_36,
                  std::vector<JointVector>& out) {
  const Vector3 &a4 = arm.joints[3].axis, &a5 = arm.joints[4].axis, &a6 = arm.joints[5].axis;
  // How far axis 6 leans from axis 4 is joint 5's alone.
  const double along = a4.dot(a5) * a5.dot(a6);
  for (const double q5 :
       SolveCosSin(a4.dot(a6) - along, a4.dot(a5.cross(a6)), a4.dot(R_36 * a6) - along)) {
    const Matrix3 R_5 = Eigen::AngleAxisd(q5, a5).toRotationMatrix();
    JointVector full = q;
    // Where axes 4 and 6 are in line their sum counts: joint 4 stays at zero.
    full[3] = AngleAbout(a4, R_5 * a6, R_36 * a6);
    full[4] = q5;
    const Matrix3 R_4 = Eigen::AngleAxisd(full[3], a4).toRotationMatrix();
    const Matrix3 R_45 = R_4 * R_5;
    const Matrix3 R_6 = R_45.transpose() * R_36;
    const Vector3 side = a6.unitOrthogonal();
    full[5] = AngleAbout(a6, side, R_6 * side);
    out.push_back(full);
  }
}

std::vector<JointVector> SolveSphericalWrist(const ArmModel& arm, const RigidTransform& X_BF) {
  const auto P = OriginsAtZero(arm);
  const Vector3 W = WristCentre(arm);
  const Vector3 &a1 = arm.joints[0].axis, &u = arm.joints[1].axis, &a3 = arm.joints[2].axis;
  const double sense3 = std::copysign(1.0, u.dot(a3));
  const RigidTransform X_B6 = X_BF * arm.X_6F.inverse();
  const Vector3 v = X_B6 * (W - P[6]) - P[1];

  std::vector<JointVector> out;
  const Vector3 v_across = v - a1 * a1.dot(v);
  const double c = u.dot(W - P[1]) - u.dot(a1) * a1.dot(v);
  const TwoLinks links{u, P[3] - P[2], W - P[3]};
  for (const double q1 : SolveCosSin(u.dot(v_across), -u.dot(a1.cross(v)), c)) {
    const Matrix3 R_1 = Eigen::AngleAxisd(q1, a1).toRotationMatrix();
    for (const auto& [q2, turn3] : links.Reach(R_1.transpose() * v - (P[2] - P[1]))) {
      JointVector q = JointVector::Zero();
      q.head<3>() << q1, q2, sense3 * turn3;
      const Matrix3 R_3 = R_1 * Eigen::AngleAxisd(q2 + turn3, u).toRotationMatrix();
      AppendWrists(arm, q, R_3.transpose() * X_B6.linear(), out);
    }
  }
  return out;
}

}  // namespace

InverseMethod SphericalWristInverse() {
  return {"spherical_wrist", CheckSphericalWrist, SolveSphericalWrist, false};
}

}  // namespace tubetwin

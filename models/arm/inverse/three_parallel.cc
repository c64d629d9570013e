// Closed form for arms whose axes 2, 3 and 4 are parallel and whose axes 5 and 6 meet in a point W
// (Universal Robots and arms like them).
//
// W does not move with joints 5 and 6 and keeps its distance along axis 2 from axis 1 whatever
// joints 2 to 4 do: that leaves two angles of joint 1. How far axis 6 leans from axis 2 is then
// joint 5's alone (two angles), joint 6 follows, and what is left is a turn about axis 2 and two
// links in a plane (two elbows).
// The equations are those of Paden and Kahan's subproblems (Murray, Li, Sastry: A Mathematical
// Introduction to Robotic Manipulation, 1994, 3.2).

#include <cmath>

#include "models/arm/inverse/geometry.h"
#include "models/arm/inverse/inverse_method.h"

namespace tubetwin {
namespace {

void CheckThreeParallel(const ArmModel& arm) {
  RequireParallel(arm, 2, 3);
  RequireParallel(arm, 3, 4);
  RequireNotParallel(arm, 1, 2);
  RequireNotParallel(arm, 4, 5);
  RequireMeeting(arm, {5, 6});
}

/// Joints 2 to 4 for a turn about u and a place of axis 4 in link 1 (from axis 2), added to q.
void AppendPlanar(const ArmModel& arm, const JointVector& q, double turn, const Vector3& v,
                  std::vector<JointVector>& out) {
  const auto P = OriginsAtZero(arm);
  const Vector3& u = arm.joints[1].axis;
  for (const auto& [q2, turn3] : TwoLinks{u, P[3] - P[2], P[4] - P[3]}.Reach(v)) {
    JointVector full = q;
    full[1] = q2;
    full[2] = std::copysign(1.0, u.dot(arm.joints[2].axis)) * turn3;
    full[3] = std::copysign(1.0, u.dot(arm.joints[3].axis)) * (turn - q2 - turn3);
    out.push_back(full);
  }
}

std::vector<JointVector> SolveThreeParallel(const ArmModel& arm, const RigidTransform& X_BF) {
  const auto P = OriginsAtZero(arm);
  const Vector3 W = RequireMeeting(arm, {5, 6});
  const Vector3 &a1 = arm.joints[0].axis, &u = arm.joints[1].axis;
  const Vector3 &a5 = arm.joints[4].axis, &a6 = arm.joints[5].axis;
  const RigidTransform X_B6 = X_BF * arm.X_6F.inverse();
  const Vector3 v = X_B6 * (W - P[6]) - P[1];

  std::vector<JointVector> out;
  const Vector3 v_across = v - a1 * a1.dot(v);
  const double c = u.dot(W - P[1]) - u.dot(a1) * a1.dot(v);
  const double along = u.dot(a5) * a5.dot(a6);
  for (const double q1 : SolveCosSin(u.dot(v_across), -u.dot(a1.cross(v)), c)) {
    const Matrix3 R_1 = Eigen::AngleAxisd(q1, a1).toRotationMatrix();
    const Matrix3 R_16 = R_1.transpose() * X_B6.linear();
    const Vector3 p_16 = R_1.transpose() * (X_B6.translation() - P[1]);
    for (const double q5 :
         SolveCosSin(u.dot(a6) - along, u.dot(a5.cross(a6)), u.dot(R_16 * a6) - along)) {
      const Matrix3 R_5 = Eigen::AngleAxisd(q5, a5).toRotationMatrix();
      JointVector q = JointVector::Zero();
      q[0] = q1;
      q[4] = q5;
      // Where axis 6 is parallel to axis 2 only their sum counts: joint 6 stays at zero.
      q[5] = AngleAbout(a6, R_16.transpose() * u, R_5.transpose() * u);
      const Matrix3 R_6 = Eigen::AngleAxisd(q[5], a6).toRotationMatrix();
      const Matrix3 R_turn = R_16 * (R_5 * R_6).transpose();
      const Vector3 side = u.unitOrthogonal();
      const double turn = AngleAbout(u, side, R_turn * side);
      const Vector3 p_14 = p_16 - R_turn * (P[5] - P[4] + R_5 * (P[6] - P[5]));
      AppendPlanar(arm, q, turn, p_14 - (P[2] - P[1]), out);
    }
  }
  return out;
}

}  // namespace

InverseMethod ThreeParallelInverse() {
  return {"three_parallel", CheckThreeParallel, SolveThreeParallel, false};
}

}  // namespace tubetwin

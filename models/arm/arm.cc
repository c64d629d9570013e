#include "models/arm/arm.h"

#include <cmath>

namespace tubetwin {
namespace {

/// Lever that turns an angular speed into a linear one for the manipulability figure.
constexpr double kAngularScale_m = 0.5;

}  // namespace

std::array<RigidTransform, kNumJoints + 1> LinkPoses(const ArmModel& arm, const JointVector& q) {
  std::array<RigidTransform, kNumJoints + 1> X_BL;
  X_BL[0] = RigidTransform::Identity();
  for (int i = 0; i < kNumJoints; ++i) {
    const ArmModel::Joint& joint = arm.joints[i];
    const Matrix3 R_joint = Eigen::AngleAxisd(q[i], joint.axis).toRotationMatrix();
    X_BL[i + 1].linear() = X_BL[i].linear() * R_joint;
    X_BL[i + 1].translation() = X_BL[i] * joint.origin_in_parent_m;
    X_BL[i + 1].makeAffine();
  }
  return X_BL;
}

RigidTransform FlangePose(const ArmModel& arm, const JointVector& q) {
  return LinkPoses(arm, q)[kNumJoints] * arm.X_6F;
}

JacobianMatrix Jacobian(const ArmModel& arm, const JointVector& q, const RigidTransform& X_FE) {
  const auto X_BL = LinkPoses(arm, q);
  const Vector3 p_BE = X_BL[kNumJoints] * (arm.X_6F * X_FE.translation());
  JacobianMatrix J;
  for (int i = 0; i < kNumJoints; ++i) {
    // A joint's axis is the same in its parent and its child.
    const Vector3 axis_B = X_BL[i + 1].linear() * arm.joints[i].axis;
    J.block<3, 1>(0, i) = axis_B.cross(p_BE - X_BL[i + 1].translation());
    J.block<3, 1>(3, i) = axis_B;
  }
  return J;
}

double Manipulability(const ArmModel& arm, const JointVector& q, const RigidTransform& X_FE) {
  JacobianMatrix J = Jacobian(arm, q, X_FE);
  J.bottomRows<3>() *= kAngularScale_m;
  const JacobianMatrix JJt = J * J.transpose();
  const Eigen::SelfAdjointEigenSolver<JacobianMatrix> eigen(JJt, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[0]));
}

}  // namespace tubetwin

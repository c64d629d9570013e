#include "models/arm/inverse/pose_steps.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {

double WrapToPi(double angle) {
  const double wrapped = std::remainder(angle, 2 * kPi);
  return wrapped <= -kPi ? wrapped + 2 * kPi : wrapped;
}

double PoseError(const RigidTransform& X_BF, const RigidTransform& X_BGoal) {
  const double turn = (X_BF.linear() - X_BGoal.linear()).norm();
  return std::max(turn, (X_BF.translation() - X_BGoal.translation()).norm());
}

double LargestDifference(const JointVector& a, const JointVector& b) {
  double largest = 0.0;
  for (int i = 0; i < kNumJoints; ++i) {
    largest = std::max(largest, std::abs(WrapToPi(a[i] - b[i])));
  }
  return largest;
}

std::optional<JointVector> PolishJoints(const ArmModel& arm, const RigidTransform& X_BF,
                                        JointVector q, int iterations) {
  for (int i = 0; i <= iterations; ++i) {
    const RigidTransform X_BNow = FlangePose(arm, q);
    if (PoseError(X_BNow, X_BF) < 0.1 * kPoseTolerance) return q;
    if (i == iterations) break;
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = X_BF.translation() - X_BNow.translation();
    const Eigen::AngleAxisd turn(Matrix3(X_BF.linear() * X_BNow.linear().transpose()));
    error.tail<3>() = turn.angle() * turn.axis();
    // A trace of damping keeps the step finite at a singular pose.
    const JacobianMatrix J = Jacobian(arm, q, RigidTransform::Identity());
    const JacobianMatrix damped = J * J.transpose() + 1e-12 * JacobianMatrix::Identity();
    const JointVector step = J.transpose() * damped.ldlt().solve(error);
    if (!step.allFinite() || step.cwiseAbs().maxCoeff() > kNewtonReach_rad) return std::nullopt;
    q += step;
  }
  return std::nullopt;
}

}  // namespace tubetwin

#include "planner/motion/joint_path.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr double kStep_m = 0.005;
constexpr double kStep_rad = kPi / 180.0;

int PiecesFor(double length_m, double angle_rad) {
  const double pieces = std::max({1.0, length_m / kStep_m, angle_rad / kStep_rad});
  return static_cast<int>(std::ceil(pieces - 1e-9));
}

}  // namespace

LinePath::LinePath(const ArmModel& arm, const RigidTransform& X_FE,
                   const RigidTransform& X_BE_start, const Vector3& move_B,
                   const Vector3& rotation_B)
    : arm_(arm), X_FE_(X_FE), X_BE_start_(X_BE_start), move_B_(move_B), rotation_B_(rotation_B) {}

int LinePath::Pieces() const { return PiecesFor(move_B_.norm(), rotation_B_.norm()); }

JointPath::Place LinePath::At(double u, const JointVector& q_near) const {
  const double angle = rotation_B_.norm();
  Matrix3 R_turn = Matrix3::Identity();
  if (angle > 0.0) R_turn = Eigen::AngleAxisd(u * angle, rotation_B_ / angle).toRotationMatrix();
  const RigidTransform X_BE =
      MakeTransform(R_turn * X_BE_start_.linear(), X_BE_start_.translation() + u * move_B_);
  const auto inverse = InverseNear(arm_, X_BE * X_FE_.inverse(), q_near, 0.0);
  Place place;
  place.status = inverse.status;
  if (inverse.status != InverseNearResult::Status::kFound) return place;
  PathPoint& p = place.point;
  p.q = inverse.q;
  // J dq = V with V constant along the path, hence J ddq = -(dJ/du) dq.
  const Eigen::PartialPivLU<JacobianMatrix> J(Jacobian(arm_, p.q, X_FE_));
  Eigen::Matrix<double, 6, 1> V;
  V << move_B_, rotation_B_;
  p.dq = J.solve(V);
  const double largest = p.dq.cwiseAbs().maxCoeff();
  if (largest > 0.0) {
    const double step = 1e-5 / largest;
    const JacobianMatrix dJ =
        (Jacobian(arm_, p.q + step * p.dq, X_FE_) - Jacobian(arm_, p.q - step * p.dq, X_FE_)) /
        (2 * step);
    p.ddq = J.solve(-(dJ * p.dq));
  }
  return place;
}

StraightJointPath::StraightJointPath(const ArmModel& arm, const RigidTransform& X_FE,
                                     const JointVector& q_start, const JointVector& q_goal)
    : q_start_(q_start), move_(q_goal - q_start) {
  constexpr int kSamples = 32;
  double length_m = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    const JointVector q = q_start_ + static_cast<double>(i) / kSamples * move_;
    const double step_m = (Jacobian(arm, q, X_FE).topRows<3>() * move_).norm();
    largest_step_m_ = std::max(largest_step_m_, step_m);
    length_m += step_m / (kSamples + 1);
  }
  pieces_ = PiecesFor(length_m, move_.cwiseAbs().maxCoeff());
}

JointPath::Place StraightJointPath::At(double u, const JointVector&) const {
  Place place;
  place.point.q = q_start_ + u * move_;
  place.point.dq = move_;
  return place;
}

}  // namespace tubetwin

#pragma once

#include "models/arm/arm.h"
#include "planner/motion/time_law.h"

namespace tubetwin {

/// Joints at one place of a path and their first two derivatives by the path parameter.
struct PathPoint {
  JointVector q = JointVector::Zero(), dq = JointVector::Zero(), ddq = JointVector::Zero();
};

/// A path of the arm over a parameter u from 0 to 1. Immutable.
class JointPath {
 public:
  virtual ~JointPath() = default;

  /// At `u`, on the branch of `q_near` (a point of the path close by). `status` other than kFound:
  /// the point means nothing.
  struct Place {
    InverseNearResult::Status status = InverseNearResult::Status::kFound;
    PathPoint point;
  };
  virtual Place At(double u, const JointVector& q_near) const = 0;

  /// Pieces that checks cut the path into: E moves at most 5 mm and turns at most 1 degree each.
  virtual int Pieces() const = 0;

  /// Whether E follows a prescribed line, so that a singular pose matters.
  virtual bool Cartesian() const = 0;
};

/// E along a straight line while the tool turns evenly about a fixed axis.
class LinePath : public JointPath {
 public:
  /// `rotation_B`: axis times angle, rad, from start to end. `arm` must outlive this.
  LinePath(const ArmModel& arm, const RigidTransform& X_FE, const RigidTransform& X_BE_start,
           const Vector3& move_B, const Vector3& rotation_B);

  Place At(double u, const JointVector& q_near) const override;
  int Pieces() const override;
  bool Cartesian() const override { return true; }

 private:
  const ArmModel& arm_;
  RigidTransform X_FE_, X_BE_start_;
  Vector3 move_B_, rotation_B_;
};

/// All joints along a straight line in joint space.
class StraightJointPath : public JointPath {
 public:
  /// `arm` must outlive this.
  StraightJointPath(const ArmModel& arm, const RigidTransform& X_FE, const JointVector& q_start,
                    const JointVector& q_goal);

  Place At(double u, const JointVector& q_near) const override;
  int Pieces() const override { return pieces_; }
  bool Cartesian() const override { return false; }
  /// Largest speed of E per unit of u, metres.
  double LargestStepOfE() const { return largest_step_m_; }

 private:
  JointVector q_start_, move_;
  double largest_step_m_ = 0.0;
  int pieces_ = 1;
};

}  // namespace tubetwin

#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/base/frames.h"
#include "models/base/joint.h"
#include "models/model_file.h"
#include "models/shape.h"

namespace tubetwin {

/// Kinematics, limits and masses of the arm, read from models/arm/hc10.toml (embedded at build
/// time).
struct ArmModel {
  struct Joint {
    std::string name;
    Vector3 origin_in_parent_m = Vector3::Zero();  ///< Frames are parallel at zero.
    Vector3 axis = Vector3::UnitZ();
    double lower_rad = 0, upper_rad = 0;
    double max_speed_rad_s = 0;
    double max_effort_Nm = 0;
    double max_acceleration_rad_s2 = 0;
    double max_jerk_rad_s3 = 0;
    double armature_kgm2 = 0, damping_Nms = 0, friction_Nm = 0;  ///< Drive, for the twin.
  };
  struct Link {  ///< 0 is the base, i the link that joint i moves.
    std::string name;
    double mass_kg = 0;
    Vector3 centre_of_mass_m = Vector3::Zero();
    Matrix3 inertia_kgm2 = Matrix3::Zero();  ///< About the centre of mass, link axes.
  };
  std::array<Joint, kNumJoints> joints;
  std::array<Link, kNumJoints + 1> links;
  /// Flange in the last link: z out of the flange.
  RigidTransform X_6F = RigidTransform::Identity();
};

/// Of an arm file, shipped or a user's own. Throws Error(kConfig) with file:line:column.
ArmModel ReadArm(const ModelFile& file);

/// What hangs on base and links.
std::vector<Shape> ArmShapes(const ArmModel& arm);

/// X_BF. Thread safe like everything here.
RigidTransform FlangePose(const ArmModel& arm, const JointVector& q);

/// Poses of base and links 1..6 in B.
std::array<RigidTransform, kNumJoints + 1> LinkPoses(const ArmModel& arm, const JointVector& q);

using JacobianMatrix = Eigen::Matrix<double, 6, 6>;
/// Spatial velocity (linear of E's origin, then angular), in B, per joint speed.
JacobianMatrix Jacobian(const ArmModel& arm, const JointVector& q, const RigidTransform& X_FE);

/// Smallest singular value of the Jacobian with angular rows scaled by 0.5 m: good above 0.1, slow
/// below 0.05, refused below 0.02.
double Manipulability(const ArmModel& arm, const JointVector& q, const RigidTransform& X_FE);

/// All joint vectors that put the flange at X_BF, up to 16, joint limits ignored except that q3 is
/// wrapped into its range and all others into (-pi, pi]; sorted lexicographically, no duplicates.
/// Every one is checked by forward kinematics to 1e-9 m. Empty when out of reach.
/// Method: degree-8 polynomial in exp(i psi), psi: phase of axis 5 about 6 (see arm_inverse.cc).
std::vector<JointVector> InverseAll(const ArmModel& arm, const RigidTransform& X_BF);

/// The solution nearest to `q_near` (largest joint difference, each wrapped where the limits allow)
/// within the limits less `margin_rad`; refined by Newton steps from q_near when that already
/// converges. Nothing when none is within the limits.
struct InverseNearResult {
  enum class Status { kFound, kUnreachable, kOutsideLimits } status = Status::kUnreachable;
  JointVector q = JointVector::Zero();
};
InverseNearResult InverseNear(const ArmModel& arm, const RigidTransform& X_BF,
                              const JointVector& q_near, double margin_rad = 0.035);

/// The working family: front, elbow up, q4 near 0; for the pose of a (nearly) vertical tool. q6 is
/// wrapped nearest to `q6_near_rad`.
InverseNearResult InverseWorking(const ArmModel& arm, const RigidTransform& X_BF,
                                 double q6_near_rad = 0.0);

}  // namespace tubetwin

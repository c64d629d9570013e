#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/base/frames.h"
#include "models/base/joint.h"
#include "models/model_file.h"
#include "models/shape.h"

namespace tubetwin {

/// Which of the solutions of a pose an arm works in: the family of one posture.
struct WorkingFamily {
  /// A posture of the family, tool pointing down, joint 1 at rest.
  JointVector q = JointVector::Zero();
  /// How far each joint of a solution for a vertical tool may be from q. Joint 1 follows the
  /// target: what counts of it is the direction from axis 1 to link 4, seen from link 1 (forearm in
  /// front or behind). Half a turn allows any.
  JointVector within_rad = JointVector::Constant(kPi);
  /// Among those the smallest sum of weight times difference is taken.
  JointVector weight = JointVector::Zero();
};

/// Kinematics, limits, masses and shapes of an arm: what an arm file says (models/arm/README.md).
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
  std::string name;                 ///< Of the product: "HC10".
  std::string controller = "none";  ///< Whose protocol it speaks: "motoros", or "none".
  std::string inverse;  ///< How its inverse kinematics is computed: one of InverseNames().
  std::array<Joint, kNumJoints> joints;
  std::array<Link, kNumJoints + 1> links;
  /// Flange in the last link: z out of the flange.
  RigidTransform X_6F = RigidTransform::Identity();
  std::vector<Shape> shapes;
  /// Bodies of this arm that can meet: everything else the joints hold apart, or they are
  /// neighbours. 0 base, 1 to 6 links, 7 whatever hangs on the flange; the outer one first.
  std::vector<std::array<int, 2>> self_pairs;
  WorkingFamily working;
};

/// Of an arm file, shipped or a user's own. Format: models/arm/README.md. Throws Error(kConfig)
/// with file:line:column for a bad file: a figure missing or impossible (limits out of order,
/// masses that are not positive, inertias that no body has, axes that are no directions), or a
/// geometry that the named inverse kinematics does not solve.
ArmModel ReadArm(const ModelFile& file);

/// A shipped arm by name, or an arm file when `name_or_path` ends in ".toml". Throws
/// Error(kMissing) naming the nearest arm, and as ReadArm does.
ArmModel LoadArm(const std::string& name_or_path);

/// Names of the arms that ship with the program, sorted.
std::vector<std::string> ArmNames();

/// Ways to compute inverse kinematics, the values of ArmModel::inverse.
std::vector<std::string> InverseNames();

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

/// All joint vectors that put the flange at X_BF, each once, sorted lexicographically. Joint limits
/// are ignored, but every joint is brought into (-pi, pi], or a full turn further where only that
/// is within its limits. Every one is checked by forward kinematics to 1e-9 m. Empty when out of
/// reach. Where a singular pose has a continuum of solutions, members of it stand for it. Computed
/// by the method that the arm names (models/arm/inverse). Throws Error(kConfig) when there is no
/// such method or the arm's geometry is not of its kind.
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

/// The solution of the arm's working family (ArmModel::working): chosen for the tool upright or
/// upside down, whichever is nearer, and followed from there to the tool as it leans. Joint 6 is
/// turned nearest to `q6_near_rad`.
InverseNearResult InverseWorking(const ArmModel& arm, const RigidTransform& X_BF,
                                 double q6_near_rad = 0.0);

}  // namespace tubetwin

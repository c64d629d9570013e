#pragma once

#include <array>

#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace tubetwin {

// Monogram notation: X_AB is the pose of frame B in frame A, p_AP the position of point P in A,
// R_AB the rotation. Products read like dominoes: X_AC = X_AB * X_BC.
//
//   B  robot base (z up, x forward)        F  flange (z out of the flange)
//   K  force/torque sensor's tool face     E  centre between the gripper's pads (z out of the tool)
//   S  scanner camera (x right, y down, z forward)
//   N  bin (origin at the centre of the floor, z up, x along the long side)
//   T  tray (origin at the centre of its surface, z up)
//   G  grasp (E at the moment of closing)  W  world of the physics engine, identical to B

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
/// Pose of one frame in another: rotation and translation, metres.
using RigidTransform = Eigen::Isometry3d;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kGravity = 9.81;  ///< m/s^2, everywhere in the project.

inline double Radians(double angle_deg) { return angle_deg * kPi / 180.0; }
inline double Degrees(double angle_rad) { return angle_rad * 180.0 / kPi; }

/// X_AB from a rotation R_AB and the position p_AB of B's origin.
inline RigidTransform MakeTransform(const Matrix3& R_AB, const Vector3& p_AB) {
  RigidTransform X_AB = RigidTransform::Identity();
  X_AB.linear() = R_AB;
  X_AB.translation() = p_AB;
  return X_AB;
}
inline RigidTransform Translation(const Vector3& p_AB) {
  return MakeTransform(Matrix3::Identity(), p_AB);
}
inline RigidTransform Translation(double x, double y, double z) {
  return Translation(Vector3(x, y, z));
}
inline Matrix3 RotX(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vector3::UnitX()).toRotationMatrix();
}
inline Matrix3 RotY(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vector3::UnitY()).toRotationMatrix();
}
inline Matrix3 RotZ(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vector3::UnitZ()).toRotationMatrix();
}

// Quaternion order: w x y z in files and in MuJoCo; Eigen stores x y z w. Only these two functions
// convert.
inline std::array<double, 4> QuaternionWxyz(const Matrix3& R_AB) {
  const Eigen::Quaterniond q(R_AB);
  return {q.w(), q.x(), q.y(), q.z()};
}
/// Normalises; the caller has checked that the norm is not zero.
inline Matrix3 RotationFromWxyz(double w, double x, double y, double z) {
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

}  // namespace tubetwin

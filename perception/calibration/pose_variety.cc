// A shift of the scanner along an axis that the flange never leaves looks like a shift of the bin:
// the flange must turn about two axes.
#include "perception/calibration/pose_variety.h"

#include <array>
#include <cmath>
#include <cstdio>

#include <Eigen/Eigenvalues>

namespace tubetwin::calibration_internal {
namespace {

/// Root mean square of the turns between pairs of poses about an axis.
const double kLeastFirst_rad = Radians(5.0), kLeastSecond_rad = Radians(3.0);

/// "z" where an axis is nearly one of F's, else its components.
std::string AxisText(const Vector3& axis) {
  static constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) > 0.97) return kNames[static_cast<std::size_t>(i)];
  }
  char text[80];
  std::snprintf(text, sizeof text, "(%.2f, %.2f, %.2f)", axis.x(), axis.y(), axis.z());
  return text;
}

}  // namespace

std::string WhatPosesLack(const std::vector<Matrix3>& R_BF) {
  Matrix3 spread = Matrix3::Zero();
  double pairs = 0.0;
  for (std::size_t i = 0; i < R_BF.size(); ++i) {
    for (std::size_t j = i + 1; j < R_BF.size(); ++j) {
      const Eigen::AngleAxisd turn(R_BF[i].transpose() * R_BF[j]);
      const Vector3 v_F = turn.angle() * turn.axis();
      spread += v_F * v_F.transpose();
      pairs += 1.0;
    }
  }
  const std::string count = std::to_string(R_BF.size());
  if (R_BF.size() < 3) {
    return "there are " + count +
           " views, at least 3 are needed, better 8: turn the flange about "
           "its z axis by 30 degrees and more and tilt it by 10 to 20 degrees in between";
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(spread / pairs);
  const auto turned_rad = [&](int i) { return std::sqrt(std::max(0.0, axes.eigenvalues()[i])); };
  if (turned_rad(2) < kLeastFirst_rad) {
    return "the flange is turned alike in all " + count +
           " views, so that a shift of the scanner "
           "looks like one of the bin: add views with the flange turned about its z axis by 30 "
           "degrees and more, and others tilted by 10 to 20 degrees";
  }
  if (turned_rad(1) < kLeastSecond_rad) {
    const std::string axis = AxisText(axes.eigenvectors().col(2));
    return "in the " + count + " views the flange is turned about its axis " + axis +
           " alone, so that a shift of the scanner along it looks like one of the bin: add views " +
           (axis == "z" ? "tilted by 10 to 20 degrees, to two sides"
                        : "with the flange turned about its z axis by 30 degrees and more");
  }
  return {};
}

}  // namespace tubetwin::calibration_internal

#pragma once

#include <array>
#include <functional>
#include <string>

#include "models/base/config/config.h"
#include "models/base/frames.h"

namespace tubetwin {

/// A box, capsule, cylinder or sphere that hangs on a body of the cell: for the clearance check,
/// the twin's contacts and its pictures.
struct Shape {
  enum class Kind { kBox, kCapsule, kCylinder, kSphere } kind = Kind::kBox;
  std::string name;
  int link = 0;  ///< 0 base, 1..6 links, 7 flange (tool, scanner).
  RigidTransform X_LinkShape = RigidTransform::Identity();
  /// Box: half sizes; capsule, cylinder: radius, half length of the straight part (along z);
  /// sphere: radius.
  Vector3 size_m = Vector3::Zero();
  bool scanner = false;
};

/// Shape::link of what hangs on the flange.
inline constexpr int kFlangeBody = 7;

/// Half sizes of the box around a shape, in its own axes.
Vector3 HalfExtent(const Shape& shape);

/// The pose of x y z and a quaternion w x y z, which ConfigVisitor::Pose has checked.
template <class Numbers>
RigidTransform PoseOfNumbers(const Numbers& xyz_wxyz) {
  const auto& x = xyz_wxyz;
  return MakeTransform(RotationFromWxyz(x[3], x[4], x[5], x[6]), Vector3(x[0], x[1], x[2]));
}

/// About x, then y, then z of the fixed frame: URDF's rpy.
Matrix3 RotationFromRpy(const std::array<double, 3>& rpy_deg);

/// A `[[shape]]` table of a model file: name, kind, origin_m, rpy_deg, and size_m, radius_m or
/// length_m as the kind takes them; `more` lists further keys. Its link is left 0. Throws
/// Error(kConfig) with file:line:column.
Shape ReadShape(const ConfigSource& source, const std::function<void(ConfigVisitor&)>& more = {});

}  // namespace tubetwin

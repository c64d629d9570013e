// The arm's own shapes and its tools as boxes, capsules, cylinders and spheres: used by the
// clearance check, the twin's contacts and its pictures.

#include "models/clearance.h"
#include "models/scanner_spec.h"

namespace tubetwin {
namespace {

using Shape = ClearanceChecker::Shape;
using Kind = Shape::Kind;

constexpr int kFlange = 7;
constexpr double kSensorRadius_m = 0.0377;  // ATI Gamma, diameter 75.4 mm
/// Gripper without its fingers, from the sensor's tool face: a round base, then the chassis that
/// carries the cranks. Their pivots lie 55 and 61 mm over the face; that the chassis ends 70 mm
/// over it is assumed (closed fingers then reach 93 mm beyond it, more than the bin's walls are
/// high).
constexpr double kBaseRadius_m = 0.0375;
constexpr double kBaseHeight_m = 0.050;
constexpr double kChassisHeight_m = 0.070;
constexpr double kChassisHalfWidth_m = 0.024;    // along the pads' width
constexpr double kChassisHalfClosing_m = 0.040;  // along the closing direction
constexpr double kBracketHalf_m = 0.005;

Shape Cylinder(const char* name, int link, const RigidTransform& X, double radius, double length) {
  return {Kind::kCylinder, name, link, X, Vector3(radius, 0.5 * length, 0), false};
}
Shape Box(const char* name, int link, const RigidTransform& X, const Vector3& half, bool scanner) {
  return {Kind::kBox, name, link, X, half, scanner};
}

Kind KindOf(ArmShape::Kind kind) {
  switch (kind) {
    case ArmShape::Kind::kBox:
      return Kind::kBox;
    case ArmShape::Kind::kCapsule:
      return Kind::kCapsule;
    case ArmShape::Kind::kCylinder:
      return Kind::kCylinder;
    case ArmShape::Kind::kSphere:
      break;
  }
  return Kind::kSphere;
}

void AddLinks(std::vector<Shape>& shapes, const ArmModel& arm) {
  for (const ArmShape& s : arm.shapes) {
    shapes.push_back({KindOf(s.kind), s.name, s.link, s.X_LinkShape, s.size_m, false});
  }
}

void AddTools(std::vector<Shape>& shapes, const CellLayout& layout) {
  const double sensor_m = layout.X_FK.translation().z();
  shapes.push_back(Cylinder("force sensor", kFlange, Translation(0, 0, 0.5 * sensor_m),
                            kSensorRadius_m, sensor_m));
  shapes.push_back(Cylinder("gripper base", kFlange,
                            layout.X_FK * Translation(0, 0, 0.5 * kBaseHeight_m), kBaseRadius_m,
                            kBaseHeight_m));
  const double chassis_half_m = 0.5 * (kChassisHeight_m - kBaseHeight_m);
  shapes.push_back(Box("gripper chassis", kFlange,
                       layout.X_FK * Translation(0, 0, kBaseHeight_m + chassis_half_m),
                       Vector3(kChassisHalfWidth_m, kChassisHalfClosing_m, chassis_half_m), false));
  // Camera and projector look out of the housing's front, which stands askew in S.
  const ScannerSpec spec;
  const Vector3 housing_half(0.5 * spec.housing_x_m, 0.5 * spec.housing_y_m,
                             0.5 * spec.housing_z_m);
  shapes.push_back(Box("scanner", kFlange,
                       layout.X_FS * HousingPose(spec) * Translation(0, 0, -housing_half.z()),
                       housing_half, true));
  // A plate under the flange carries it: from the tool's axis to the near side of the housing.
  const Vector3 p_FS = layout.X_FS.translation();
  const double reach_m = p_FS.y() - housing_half.y();
  shapes.push_back(Box("scanner bracket", kFlange, Translation(0, 0.5 * reach_m, kBracketHalf_m),
                       Vector3(0.035, 0.5 * reach_m, kBracketHalf_m), true));
}

}  // namespace

std::vector<Shape> ClearanceChecker::ArmShapes(const ArmModel& arm, const CellLayout& layout) {
  std::vector<Shape> shapes;
  AddLinks(shapes, arm);
  AddTools(shapes, layout);
  return shapes;
}

}  // namespace tubetwin

// The arm as boxes, capsules, cylinders and spheres: close to the vendor's meshes
// (their bounding boxes and centroids were measured), used by the clearance check, the twin's
// contacts and its pictures.

#include "models/arm/arm.h"

namespace tubetwin {
namespace {

using Kind = Shape::Kind;

Shape Capsule(const char* name, int link, const RigidTransform& X, double radius, double length) {
  return {Kind::kCapsule, name, link, X, Vector3(radius, 0.5 * length, 0), false};
}
Shape Cylinder(const char* name, int link, const RigidTransform& X, double radius, double length) {
  return {Kind::kCylinder, name, link, X, Vector3(radius, 0.5 * length, 0), false};
}
Shape Sphere(const char* name, int link, const RigidTransform& X, double radius) {
  return {Kind::kSphere, name, link, X, Vector3(radius, 0, 0), false};
}
void AddLinks(std::vector<Shape>& shapes, const ArmModel& arm) {
  const double upper_m = arm.joints[2].origin_in_parent_m.z();
  const RigidTransform X_disc = MakeTransform(RotX(kPi / 2), Vector3(0, -0.1995, 0));
  shapes.push_back(Cylinder("base", 0, Translation(0, 0, 0.0835), 0.115, 0.167));
  shapes.push_back(Sphere("shoulder", 1, RigidTransform::Identity(), 0.115));
  shapes.push_back(
      Capsule("upper arm", 2, Translation(0, -0.19, 0.5 * upper_m), 0.090, upper_m - 0.02));
  shapes.push_back(Cylinder("upper arm's lower end", 2, X_disc, 0.081, 0.203));
  shapes.push_back(
      Cylinder("upper arm's upper end", 2, Translation(0, 0, upper_m) * X_disc, 0.081, 0.203));
  shapes.push_back(Sphere("elbow", 3, RigidTransform::Identity(), 0.105));
  shapes.push_back(Capsule("forearm", 4, Translation(0, 0, 0.180), 0.062, 0.360));
  shapes.push_back(Capsule("wrist", 5, Translation(0, -0.016, 0.035), 0.080, 0.110));
  shapes.push_back(Cylinder("flange", 6, Translation(0, 0, -0.1115), 0.051, 0.037));
}

}  // namespace

std::vector<Shape> ArmShapes(const ArmModel& arm) {
  std::vector<Shape> shapes;
  AddLinks(shapes, arm);
  return shapes;
}

}  // namespace tubetwin

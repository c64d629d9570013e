#include "twin/cell/arm_body.h"

#include <algorithm>
#include <array>

#include "scenes/engine/mj_handles.h"
#include "scenes/engine/surface.h"
#include "twin/cell/contact_bits.h"

namespace tubetwin {
namespace {

/// Links below this one stay out of contact: shoulder and upper arm turn above the plate.
constexpr int kFirstLinkInContact = 3;
/// Of a tube on painted metal: an assumption.
constexpr double kHousingFriction = 0.3;

void SetInertial(mjsBody& body, double mass_kg, const Vector3& centre_m, const Matrix3& inertia) {
  body.explicitinertial = 1;
  body.mass = mass_kg;
  for (int k = 0; k < 3; ++k) body.ipos[k] = centre_m[k];
  const double full[6] = {inertia(0, 0), inertia(1, 1), inertia(2, 2),
                          inertia(0, 1), inertia(0, 2), inertia(1, 2)};
  std::copy(full, full + 6, body.fullinertia);
}

/// Inertia of a solid box about its centre.
Matrix3 BoxInertia(double mass_kg, const Vector3& size_m) {
  const Vector3 s = size_m.cwiseProduct(size_m);
  return (mass_kg / 12.0) *
         Vector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal().toDenseMatrix();
}

mjtGeom GeomType(Shape::Kind kind) {
  switch (kind) {
    case Shape::Kind::kBox:
      return mjGEOM_BOX;
    case Shape::Kind::kCapsule:
      return mjGEOM_CAPSULE;
    case Shape::Kind::kCylinder:
      return mjGEOM_CYLINDER;
    case Shape::Kind::kSphere:
      break;
  }
  return mjGEOM_SPHERE;
}

/// Adds one shape; X_BodyShape is its pose in the body's frame.
void AddShape(mjsBody& body, const Shape& shape, const RigidTransform& X_BodyShape, int contype) {
  mjsGeom* geom = mjs_addGeom(&body, nullptr);
  SetName(geom->element, "arm_" + shape.name);
  geom->type = GeomType(shape.kind);
  SetPose(X_BodyShape, geom->pos, geom->quat);
  for (int k = 0; k < 3; ++k) geom->size[k] = shape.size_m[k];
  geom->mass = 0.0;
  geom->contype = contype;
  geom->conaffinity = contype == 0 ? 0 : static_cast<int>(kTubeBit);
  SetSurface(*geom, kHousingFriction, 1, kContactTime_s);
  const std::array<float, 4> rgba = shape.scanner ? std::array<float, 4>{0.10f, 0.10f, 0.11f, 1.0f}
                                    : shape.link == kFlangeBody
                                        ? std::array<float, 4>{0.30f, 0.31f, 0.33f, 1.0f}
                                        : std::array<float, 4>{0.24f, 0.42f, 0.66f, 1.0f};
  std::copy(rgba.begin(), rgba.end(), geom->rgba);
}

mjsBody& AddLink(mjSpec& spec, mjsBody& parent, const ArmModel& arm, int joint_index) {
  const ArmModel::Joint& model = arm.joints[joint_index];
  const ArmModel::Link& link = arm.links[joint_index + 1];
  mjsBody* body = mjs_addBody(&parent, nullptr);
  SetName(body->element, "arm_link" + std::to_string(joint_index + 1));
  for (int k = 0; k < 3; ++k) body->pos[k] = model.origin_in_parent_m[k];
  SetInertial(*body, link.mass_kg, link.centre_of_mass_m, link.inertia_kgm2);

  mjsJoint* joint = mjs_addJoint(body, nullptr);
  SetName(joint->element, ArmJointName(joint_index));
  joint->type = mjJNT_HINGE;
  for (int k = 0; k < 3; ++k) joint->axis[k] = model.axis[k];
  joint->limited = mjLIMITED_TRUE;
  joint->range[0] = model.lower_rad;
  joint->range[1] = model.upper_rad;
  joint->armature = model.armature_kgm2;
  joint->damping[0] = model.damping_Nms;
  joint->frictionloss = model.friction_Nm;

  mjsActuator* motor = mjs_addActuator(&spec, nullptr);
  SetName(motor->element, ArmJointName(joint_index));
  mjs_setToMotor(motor);
  motor->trntype = mjTRN_JOINT;
  mjs_setString(motor->target, ArmJointName(joint_index).c_str());
  motor->forcelimited = mjLIMITED_TRUE;
  motor->forcerange[0] = -model.max_effort_Nm;
  motor->forcerange[1] = model.max_effort_Nm;
  return *body;
}

/// A body without joint on the flange: pose X_6Body.
mjsBody& AddFixed(mjsBody& link6, const std::string& name, const RigidTransform& X_6Body) {
  mjsBody* body = mjs_addBody(&link6, nullptr);
  SetName(body->element, name);
  SetPose(X_6Body, body->pos, body->quat);
  return *body;
}

/// Above the sensor's tool face, so not weighed.
void AddScanner(mjsBody& link6, const CellModel& model) {
  const ScannerSpec& spec = model.scanner;
  mjsBody& scanner =
      AddFixed(link6, "scanner", model.arm.X_6F * model.layout.X_FS * HousingPose(spec));
  SetInertial(scanner, spec.mass_kg, Vector3(0, 0, spec.mass_centre_m),
              BoxInertia(spec.mass_kg, spec.inertia_box_m));
}

void AddWristSensor(mjSpec& spec, mjsBody& tool) {
  mjsSite* site = mjs_addSite(&tool, nullptr);
  SetName(site->element, kWristSite);
  site->group = 5;
  const std::pair<const char*, mjtSensor> kinds[2] = {{kWristForce, mjSENS_FORCE},
                                                      {kWristTorque, mjSENS_TORQUE}};
  for (const auto& [name, type] : kinds) {
    mjsSensor* sensor = mjs_addSensor(&spec);
    SetName(sensor->element, name);
    sensor->type = type;
    sensor->objtype = mjOBJ_SITE;
    mjs_setString(sensor->objname, kWristSite);
  }
}

}  // namespace

std::string ArmJointName(int joint) { return "arm_joint" + std::to_string(joint + 1); }

mjsBody& AddArm(mjSpec& spec, const CellModel& model) {
  const ArmModel& arm = model.arm;
  const CellLayout& layout = model.layout;
  std::array<mjsBody*, kNumJoints + 1> links{};
  links[0] = mjs_addBody(mjs_findBody(&spec, "world"), nullptr);
  SetName(links[0]->element, "arm_base");
  for (int i = 0; i < kNumJoints; ++i) links[i + 1] = &AddLink(spec, *links[i], arm, i);
  mjsBody& link6 = *links[kNumJoints];

  const RigidTransform X_6K = arm.X_6F * layout.X_FK;
  const double sensor_height_m = layout.X_FK.translation().z();
  mjsBody& sensor =
      AddFixed(link6, "wrist_sensor", arm.X_6F * Translation(0, 0, 0.5 * sensor_height_m));
  const double side_m = model.wrist.inertia_side_m;
  SetInertial(sensor, model.wrist.mass_kg, Vector3::Zero(),
              BoxInertia(model.wrist.mass_kg, Vector3(side_m, side_m, sensor_height_m)));
  if (layout.scanner_mount == CellLayout::ScannerMount::kFlange) AddScanner(link6, model);
  mjsBody& tool = AddFixed(link6, "tool", X_6K);
  AddWristSensor(spec, tool);

  for (const Shape& shape : MovingShapes(model)) {
    if (shape.link < kFlangeBody) {
      AddShape(*links[shape.link], shape, shape.X_LinkShape,
               shape.link >= kFirstLinkInContact ? kArmBit : 0);
      continue;
    }
    // What lies beyond the sensor's tool face hangs on the sensor.
    const bool below = !shape.scanner && shape.X_LinkShape.translation().z() > sensor_height_m;
    if (below) {
      AddShape(tool, shape, layout.X_FK.inverse() * shape.X_LinkShape, kGripperBit);
    } else {
      AddShape(link6, shape, arm.X_6F * shape.X_LinkShape, kArmBit);
    }
  }
  return tool;
}

}  // namespace tubetwin

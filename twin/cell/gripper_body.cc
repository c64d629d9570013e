#include "twin/cell/gripper_body.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "models/base/error.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/engine/surface.h"
#include "twin/cell/contact_bits.h"

namespace tubetwin {
namespace {

constexpr double kCarriageMass_kg = 0.05;
constexpr double kLinkMass_kg = 0.02;

constexpr double kPadHalfThickness_m = 0.003;
/// What lies beside a pad's middle half is this much lower.
constexpr double kPadStep_m = 0.001;
/// Of a tube on bare aluminium: an assumption.
constexpr double kFingerFriction = 0.3;

void SetInertial(mjsBody& body, double mass_kg, const Vector3& centre_m, double ixx, double iyy,
                 double izz) {
  body.explicitinertial = 1;
  body.mass = mass_kg;
  const double inertia[3] = {ixx, iyy, izz};
  for (int k = 0; k < 3; ++k) {
    body.ipos[k] = centre_m[k];
    body.inertia[k] = inertia[k];
  }
}

mjsJoint& AddSlide(mjsBody& body, const char* name, const Vector3& axis, double upper_m) {
  mjsJoint* joint = mjs_addJoint(&body, nullptr);
  SetName(joint->element, name);
  joint->type = mjJNT_SLIDE;
  for (int k = 0; k < 3; ++k) joint->axis[k] = axis[k];
  joint->limited = mjLIMITED_TRUE;
  joint->range[0] = 0.0;
  joint->range[1] = upper_m;
  joint->solref_limit[0] = 0.005;
  return *joint;
}

/// A geom of a pad: priority 2, so that its friction and stiffness win over the tube's, and over
/// the bin's where a pad touches that.
void AddPadBox(mjsBody& finger, const std::string& name, const Vector3& centre,
               const Vector3& half_m, const RoundPhysics& physics) {
  mjsGeom* pad = mjs_addGeom(&finger, nullptr);
  SetName(pad->element, name);
  pad->type = mjGEOM_BOX;
  for (int k = 0; k < 3; ++k) pad->pos[k] = centre[k];
  for (int k = 0; k < 3; ++k) pad->size[k] = half_m[k];
  pad->mass = 0.0;
  SetSurface(*pad, physics.pad_friction, 2, kContactTime_s);
  pad->friction[1] = physics.pad_torsion_m;
  pad->solimp[0] = 0.999;
  pad->solimp[1] = 0.9999;
  pad->contype = kGripperBit;
  pad->conaffinity = kTubeBit;
  const float rgba[4] = {0.15f, 0.15f, 0.16f, 1.0f};
  std::copy(rgba, rgba + 4, pad->rgba);
}

/// A pad of half width a that grips a tube along a line of even pressure resists its pivoting with
/// mu N a / 2. The engine has two points of contact, at the edges of a box, with half of the force
/// each: at +- a / 2 they resist as the line does. So the box that grips is half as wide as the
/// pad; what lies beside it is lower by a step, for tubes that come across. `side` +1 at +y.
void AddPad(mjsBody& finger, double side, const std::string& name, const GripperSpec& gripper,
            const RoundPhysics& physics) {
  const double half_width_m = 0.5 * gripper.pad_width_m, half_height_m = 0.5 * gripper.pad_height_m;
  AddPadBox(finger, name, Vector3::Zero(), {0.5 * half_width_m, kPadHalfThickness_m, half_height_m},
            physics);
  AddPadBox(finger, name + "_rim", Vector3(0, 0.5 * side * kPadStep_m, 0),
            {half_width_m, kPadHalfThickness_m - 0.5 * kPadStep_m, half_height_m}, physics);
}

/// Without mass: its body has that.
void LookLikeFinger(mjsGeom& geom) {
  geom.mass = 0.0;
  SetSurface(geom, kFingerFriction, 1, kContactTime_s);
  geom.contype = kGripperBit;
  geom.conaffinity = kTubeBit;
  const float rgba[4] = {0.25f, 0.25f, 0.27f, 1.0f};
  std::copy(rgba, rgba + 4, geom.rgba);
}

/// One finger; `side` +1 at +y, -1 at -y. Origin: centre of its pad.
void AddFinger(mjsBody& carriage, double side, const char* joint_name, const char* pad_name,
               const GripperSpec& gripper, const RoundPhysics& physics) {
  mjsBody* finger = mjs_addBody(&carriage, nullptr);
  SetName(finger->element, std::string(joint_name) + "_body");
  finger->pos[1] = side * (0.5 * gripper.stroke_m + kPadHalfThickness_m);
  SetInertial(*finger, gripper.finger_mass_kg, Vector3(0, 0, -0.03), 5e-5, 5e-5, 5e-5);
  mjsJoint& slide = AddSlide(*finger, joint_name, Vector3(0, -side, 0), 0.5 * gripper.stroke_m);
  slide.armature = 0.1;
  slide.damping[0] = 2.0;
  AddPad(*finger, side, pad_name, gripper, physics);

  mjsGeom* bar = mjs_addGeom(finger, nullptr);
  SetName(bar->element, std::string(joint_name) + "_bar");
  bar->type = mjGEOM_BOX;
  const double half_thickness_m = 0.5 * (gripper.finger_thickness_m - 2 * kPadHalfThickness_m);
  bar->size[0] = 0.5 * gripper.pad_width_m;
  bar->size[1] = half_thickness_m;
  bar->size[2] = 0.5 * gripper.finger_length_m;
  bar->pos[1] = side * (kPadHalfThickness_m + half_thickness_m);
  bar->pos[2] = 0.5 * gripper.pad_height_m - 0.5 * gripper.finger_length_m;
  LookLikeFinger(*bar);
}

void AddCoupling(mjSpec& spec, const char* name, const char* follower, const char* leader,
                 const std::array<double, 5>& c) {
  mjsEquality* equality = mjs_addEquality(&spec, nullptr);
  SetName(equality->element, name);
  equality->type = mjEQ_JOINT;
  equality->objtype = mjOBJ_JOINT;
  mjs_setString(equality->name1, follower);
  mjs_setString(equality->name2, leader);
  std::copy(c.begin(), c.end(), equality->data);
  equality->solref[0] = 0.002;
  equality->solref[1] = 1.0;
  equality->solimp[0] = 0.95;
  equality->solimp[1] = 0.999;
  equality->solimp[2] = 0.001;
}

/// A fixed tendon with coefficients (1, 1): each pad gets the whole force of the actuator.
void AddGripActuator(mjSpec& spec, double force_N) {
  mjsTendon* tendon = mjs_addTendon(&spec, nullptr);
  SetName(tendon->element, kGripActuator);
  mjs_wrapJoint(tendon, kFingerLeftJoint, 1.0);
  mjs_wrapJoint(tendon, kFingerRightJoint, 1.0);
  mjsActuator* grip = mjs_addActuator(&spec, nullptr);
  SetName(grip->element, kGripActuator);
  double damping[1] = {kGripDamping_Ns_m};
  const char* refused = mjs_setToPosition(grip, kGripStiffness_N_m, damping, nullptr, nullptr, 0);
  TT_CHECK(refused == nullptr || refused[0] == '\0');
  grip->trntype = mjTRN_TENDON;
  mjs_setString(grip->target, kGripActuator);
  grip->forcelimited = mjLIMITED_TRUE;
  grip->forcerange[0] = -force_N;
  grip->forcerange[1] = force_N;
}

/// What follows the fingers, less its value when they are open, as a polynomial of one finger's
/// travel.
AdvancePolynomial FitToTravel(const GripperSpec& spec,
                              const std::function<double(double opening_m)>& value) {
  constexpr int kSamples = 86;
  // Sizes known at compile time would be unrolled, for most of a minute of compiling.
  Eigen::Matrix<double, Eigen::Dynamic, 4> A(kSamples, 4);
  Eigen::VectorXd advance(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    // The unknowns are scaled by the half stroke; metres to the fourth are tiny.
    const double u = static_cast<double>(i) / (kSamples - 1);
    A.row(i) << u, u * u, u * u * u, u * u * u * u;
    advance[i] = value(spec.stroke_m * (1.0 - u)) - value(spec.stroke_m);
  }
  const Eigen::Vector4d scaled = A.colPivHouseholderQr().solve(advance);
  AdvancePolynomial fit;
  fit.largest_error_m = (A * scaled - advance).cwiseAbs().maxCoeff();
  double scale = 1.0;
  for (int k = 1; k <= 4; ++k) {
    scale *= 0.5 * spec.stroke_m;
    fit.c[k] = scaled[k - 1] / scale;
  }
  return fit;
}

/// A bar of the linkage of the finger at side +1 (+y) or -1: it goes where the table says, moved by
/// what couples it to the finger, so that it pushes as fast as it moves.
void AddLink(mjSpec& spec, mjsBody& tool, const GripperSpec& gripper, const GripperSpec::Link& link,
             const RigidTransform& X_KE, int side) {
  const std::string name = link.shape.name + (side > 0 ? " +y" : " -y");
  const RigidTransform X_EOpen = LinkPose(link, gripper.stroke_m, side);
  mjsBody* body = mjs_addBody(&tool, nullptr);
  SetName(body->element, name);
  SetPose(X_KE * X_EOpen, body->pos, body->quat);
  SetInertial(*body, kLinkMass_kg, Vector3::Zero(), 2e-5, 2e-5, 2e-5);
  const char* leader = side > 0 ? kFingerLeftJoint : kFingerRightJoint;
  const auto couple = [&](const char* suffix, mjtJoint type, const Vector3& axis_E,
                          const std::function<double(double)>& value) {
    const std::string joint_name = name + suffix;
    mjsJoint& joint =
        AddSlide(*body, joint_name.c_str(), X_EOpen.linear().transpose() * axis_E, 1.0);
    joint.type = type;
    joint.limited = mjLIMITED_FALSE;  // The coupling holds it.
    joint.armature = type == mjJNT_HINGE ? 1e-3 : 0.05;
    AddCoupling(spec, joint_name.c_str(), joint_name.c_str(), leader,
                FitToTravel(gripper, value).c);
  };
  const auto at = [&link, side](double opening_m) { return LinkPose(link, opening_m, side); };
  couple(" aside", mjJNT_SLIDE, Vector3::UnitY(),
         [&](double o) { return at(o).translation().y(); });
  couple(" out", mjJNT_SLIDE, Vector3::UnitZ(), [&](double o) { return at(o).translation().z(); });
  couple(" turn", mjJNT_HINGE, side * Vector3::UnitX(), [&](double o) {
    const Matrix3 R = LinkPose(link, o, +1).linear();
    return std::atan2(R(2, 1), R(1, 1));
  });

  mjsGeom* geom = mjs_addGeom(body, nullptr);
  SetName(geom->element, name);
  geom->type = link.shape.kind == Shape::Kind::kBox ? mjGEOM_BOX : mjGEOM_CAPSULE;
  for (int k = 0; k < 3; ++k) geom->size[k] = link.shape.size_m[k];
  LookLikeFinger(*geom);
}

}  // namespace

AdvancePolynomial FitTipAdvance(const GripperSpec& spec) {
  return FitToTravel(spec, [&](double opening_m) { return TipAdvance(spec, opening_m); });
}

void AddGripper(mjSpec& spec, mjsBody& tool, const CellModel& model, const RoundPhysics& physics) {
  const GripperSpec& gripper = model.gripper;
  const CellLayout& layout = model.layout;
  // Masses below the sensor sum to those of gripper and coupling.
  const double links_kg = 2 * kLinkMass_kg * static_cast<double>(gripper.links.size());
  const double palm_kg = gripper.mass_kg + gripper.coupling_mass_kg - 2 * gripper.finger_mass_kg -
                         kCarriageMass_kg - links_kg;
  SetInertial(tool, palm_kg, Vector3(0, 0, gripper.palm_centre_m), 2e-3, 2e-3, 1e-3);

  mjsBody* carriage = mjs_addBody(&tool, nullptr);
  SetName(carriage->element, kCarriageJoint + std::string("_body"));
  const RigidTransform X_KE = layout.X_FK.inverse() * layout.X_FE;
  SetPose(X_KE * Translation(0, 0, -PadRetreat(gripper, gripper.stroke_m)), carriage->pos,
          carriage->quat);
  SetInertial(*carriage, kCarriageMass_kg, Vector3(0, 0, -0.06), 2e-5, 2e-5, 2e-5);
  mjsJoint& slide = AddSlide(*carriage, kCarriageJoint, Vector3::UnitZ(), 1.0);
  slide.limited = mjLIMITED_FALSE;  // The coupling holds it.

  AddFinger(*carriage, +1.0, kFingerLeftJoint, kPadLeftGeom, gripper, physics);
  AddFinger(*carriage, -1.0, kFingerRightJoint, kPadRightGeom, gripper, physics);
  AddCoupling(spec, "fingers_move_together", kFingerLeftJoint, kFingerRightJoint, {0, 1, 0, 0, 0});
  AddCoupling(spec, "tips_advance", kCarriageJoint, kFingerLeftJoint, FitTipAdvance(gripper).c);
  for (const GripperSpec::Link& link : gripper.links) {
    AddLink(spec, tool, gripper, link, X_KE, +1);
    AddLink(spec, tool, gripper, link, X_KE, -1);
  }
  AddGripActuator(spec, gripper.min_force_N);
}

}  // namespace tubetwin

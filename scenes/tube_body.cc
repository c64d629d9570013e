#include "scenes/tube_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/engine/surface.h"
#include "scenes/rod/rod_frames.h"

namespace tubetwin {
namespace {

constexpr double kArmature_kgm2 = 1e-6;  // Steadies the light links; slows bending by 2 %.
// Losses of a rolling tube, N m s/rad: without them a bent tube on two supports swings about its
// own axis for minutes. As large as 0.2 mm of rolling friction at 5 rad/s; on anything but rolling
// (other axes, falling) its time constant is beyond 50 s.
constexpr double kRollingLoss = 2e-5;
// Share of m r^2 about the own axis: thin-walled tube 1, hose with half-radius bore 5/8.
constexpr double kRigidAxial = 1.0, kHoseAxial = 0.625;

// Inertia of a straight piece of tube about its middle, axes of the piece along `direction`.
Matrix3 PieceInertia(double mass_kg, double length_m, double radius_m, double axial_factor,
                     const Vector3& direction) {
  const double axial = axial_factor * mass_kg * radius_m * radius_m;
  const double across = 0.5 * axial + mass_kg * length_m * length_m / 12.0;
  const Matrix3 along = direction * direction.transpose();
  return axial * along + across * (Matrix3::Identity() - along);
}

void SetMass(mjsBody* body, double mass_kg, const Vector3& centre, const Vector3& inertia) {
  body->explicitinertial = true;
  body->mass = mass_kg;
  for (int k = 0; k < 3; ++k) {
    body->ipos[k] = centre[k];
    body->inertia[k] = inertia[k];
  }
}

void AddFree(mjsBody* body, const std::string& name) {
  mjsJoint* joint = mjs_addFreeJoint(body);
  SetName(joint->element, name);
  joint->damping[0] = kRollingLoss;
}

void AddHinge(mjsBody* body, const std::string& name, const Vector3& axis, double stiffness,
              double damping_time_s, double rest_rad) {
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  SetName(joint->element, name);
  joint->type = mjJNT_HINGE;
  for (int k = 0; k < 3; ++k) joint->axis[k] = axis[k];
  joint->stiffness[0] = stiffness;
  joint->damping[0] = damping_time_s * stiffness;
  joint->armature = kArmature_kgm2;
  joint->springref = rest_rad;
}

}  // namespace

// What the links of a hose under construction share. World axes.
struct TubeBody::HoseChain {
  int root = 0;
  Vector3 root_origin = Vector3::Zero();  // First node of the root link.
  double kg_per_m = 0.0;
  double damping_time_s = 0.0;  // Joint damping over stiffness.
  RodFrames frames;
  std::vector<double> lengths_m;
  std::vector<std::array<double, 2>> solid_m;  // Of each link, from its first node; none: empty.
  std::vector<mjsBody*> bodies;
};

TubeBodyOptions MakeTubeBodyOptions(const Part& part, const RoundPhysics& physics,
                                    const RigidTransform& X_WN, int tube_id) {
  const Specimen specimen = physics.SpecimenOf(tube_id);
  TubeBodyOptions options;
  options.X_WN = X_WN;
  options.hose = part.is_hose();
  options.mass_scale = physics.mass_scale;
  options.friction = physics.tube_friction * specimen.friction;
  options.bending_stiffness_Nm2 = physics.bending_stiffness_Nm2 * specimen.stiffness;
  options.loss_factor = physics.loss_factor * specimen.loss;
  if (part.colour_rgb.size() == 3) {
    std::copy(part.colour_rgb.begin(), part.colour_rgb.end(), options.colour_rgb.begin());
  }
  return options;
}

TubeBody::TubeBody(mjSpec& spec, const std::string& name, const PileTube& tube,
                   const TubeBodyOptions& options)
    : name_(name), tube_(tube), options_(options) {
  TT_CHECK(tube.centerline_N.size() >= (options.hose ? 3u : 2u));
  if (options.hose) {
    BuildHose(spec);
  } else {
    BuildRigid(spec);
  }
}

void TubeBody::AddCapsule(mjsBody* body, int index, const Vector3& from, const Vector3& to) {
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom_names_.push_back(name_ + "_g" + std::to_string(index));
  SetName(geom->element, geom_names_.back());
  geom->type = mjGEOM_CAPSULE;
  geom->size[0] = tube_.radius_m;
  for (int k = 0; k < 3; ++k) {
    geom->fromto[k] = from[k];
    geom->fromto[3 + k] = to[k];
    geom->rgba[k] = static_cast<float>(options_.colour_rgb[k]);
  }
  geom->rgba[3] = 1.0f;
  geom->mass = 0.0;  // The body's inertia is given; capsules overlap at the nodes.
  SetSurface(*geom, options_.friction, 0, options_.contact_time_s);
  geom->friction[1] = options_.torsion_m;
}

void TubeBody::BuildRigid(mjSpec& spec) {
  const Polyline line = Transformed(options_.X_WN, tube_.centerline_N);
  const double mass_kg = tube_.mass_kg * options_.mass_scale;
  const double total_m = Length(line);
  const Vector3 centre = CurveCentre(line);
  Matrix3 inertia = Matrix3::Zero();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector3 piece = line[i + 1] - line[i];
    const double length_m = piece.norm();
    const double piece_kg = mass_kg * length_m / total_m;
    const Vector3 d = 0.5 * (line[i] + line[i + 1]) - centre;
    inertia += PieceInertia(piece_kg, length_m, tube_.radius_m, kRigidAxial, piece / length_m);
    inertia += piece_kg * (d.squaredNorm() * Matrix3::Identity() - d * d.transpose());
  }
  // Principal axes as the body's frame: the engine has a shorter path for such bodies.
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(inertia);
  Matrix3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  const RigidTransform X_WBody = MakeTransform(axes, centre);

  mjsBody* body = mjs_addBody(mjs_findBody(&spec, "world"), nullptr);
  SetName(body->element, name_);
  body_names_ = {name_};
  SetPose(X_WBody, body->pos, body->quat);
  AddFree(body, name_ + "_free");
  SetMass(body, mass_kg, Vector3::Zero(), solver.eigenvalues());
  for (const Vector3& node : Transformed(X_WBody.inverse(), line)) nodes_.push_back({0, node});
  for (const AxisPiece& solid : PiecesWithin(line, tube_.radius_m)) {
    AddCapsule(body, static_cast<int>(solid.piece), X_WBody.inverse() * solid.from,
               X_WBody.inverse() * solid.to);
  }
}

void TubeBody::AddLink(mjSpec& spec, HoseChain& chain, int i, int parent) {
  const bool forward = i >= chain.root;
  mjsBody* body =
      mjs_addBody(parent < 0 ? mjs_findBody(&spec, "world") : chain.bodies[parent], nullptr);
  chain.bodies[i] = body;
  SetName(body->element, body_names_[i]);
  const double length_m = chain.lengths_m[i];
  if (parent < 0) {
    SetPose(MakeTransform(chain.frames.current[i], chain.root_origin), body->pos, body->quat);
    AddFree(body, name_ + "_free");
  } else {
    const Matrix3 R_PC = chain.frames.current[parent].transpose() * chain.frames.current[i];
    const double parent_m = chain.lengths_m[parent];
    const double z = forward ? parent_m : (parent < chain.root ? -parent_m : 0.0);
    SetPose(MakeTransform(R_PC, Vector3(0, 0, z)), body->pos, body->quat);
    const double joint_m = 0.5 * (length_m + parent_m), EI = options_.bending_stiffness_Nm2;
    const std::array<double, 3> stiffness = {EI / joint_m, EI / joint_m,
                                             TorsionalStiffness(EI) / joint_m};
    const RodJoint joint =
        JointBetween(R_PC, chain.frames.rest[parent].transpose() * chain.frames.rest[i]);
    const char* suffix[3] = {"_x", "_y", "_z"};
    for (int k = 0; k < 3; ++k) {
      AddHinge(body, body_names_[i] + suffix[k], joint.axes.col(k), stiffness[k],
               chain.damping_time_s, joint.rest_rad[k]);
    }
  }
  const Vector3 near = Vector3::Zero(), far(0, 0, forward ? length_m : -length_m);
  const double mass_kg = chain.kg_per_m * length_m;
  SetMass(body, mass_kg, 0.5 * far,
          PieceInertia(mass_kg, length_m, tube_.radius_m, kHoseAxial, Vector3::UnitZ()).diagonal());
  // The frame's z runs along the tube, from the link's own first node or up to its last one.
  const double origin_m = forward ? 0.0 : length_m;
  if (const auto& [from_m, to_m] = chain.solid_m[i]; from_m < to_m) {
    AddCapsule(body, i, Vector3(0, 0, from_m - origin_m), Vector3(0, 0, to_m - origin_m));
  }
  if (parent < 0) nodes_[i] = {i, near};
  nodes_[forward ? i + 1 : i] = {i, far};
}

void TubeBody::BuildHose(mjSpec& spec) {
  const Polyline line = Transformed(options_.X_WN, tube_.centerline_N);
  const Polyline& rest = tube_.rest_centerline_N ? *tube_.rest_centerline_N : line;
  TT_CHECK(rest.size() == line.size());
  const int links = static_cast<int>(line.size()) - 1, root = links / 2;
  HoseChain chain;
  chain.root = root;
  chain.root_origin = line[root];
  chain.kg_per_m = tube_.mass_kg * options_.mass_scale / Length(line);
  const double EI = options_.bending_stiffness_Nm2, mass_kg = tube_.mass_kg * options_.mass_scale;
  chain.frames = LeastEnergyFrames(line, rest, {EI, TorsionalStiffness(EI)});
  // Implicit steps damp on their own, by omega times half a step: the joints do the rest.
  chain.damping_time_s =
      std::max(0.0, options_.loss_factor / FirstFreeBending(EI, mass_kg, Length(line)) -
                        spec.option.timestep);
  chain.bodies.resize(links);
  for (int i = 0; i < links; ++i) {
    chain.lengths_m.push_back((line[i + 1] - line[i]).norm());
    body_names_.push_back(name_ + "_" + std::to_string(i));
  }
  nodes_.resize(line.size());
  chain.solid_m.assign(links, {0.0, 0.0});
  for (const AxisPiece& solid : PiecesWithin(line, tube_.radius_m)) {
    chain.solid_m[solid.piece] = {(solid.from - line[solid.piece]).norm(),
                                  (solid.to - line[solid.piece]).norm()};
  }
  AddLink(spec, chain, root, -1);
  for (int i = root + 1; i < links; ++i) AddLink(spec, chain, i, i - 1);
  for (int i = root - 1; i >= 0; --i) AddLink(spec, chain, i, i + 1);
  // Neighbours of neighbours would touch at a normal bend when links are short.
  for (int i = 0; i + 2 < links; ++i) {
    if (chain.lengths_m[i + 1] > 3.0 * tube_.radius_m) continue;
    mjsExclude* exclude = mjs_addExclude(&spec);
    SetString(exclude->bodyname1, body_names_[i]);
    SetString(exclude->bodyname2, body_names_[i + 2]);
  }
}

void TubeBody::Bind(const mjModel& model) {
  bodies_.clear();
  geoms_.clear();
  for (const std::string& name : body_names_) bodies_.push_back(IdOf(model, mjOBJ_BODY, name));
  for (const std::string& name : geom_names_) geoms_.push_back(IdOf(model, mjOBJ_GEOM, name));
}

Polyline TubeBody::Centerline_W(const mjData& data) const {
  TT_CHECK(!bodies_.empty());
  Polyline line;
  for (const Attachment& node : nodes_) {
    line.push_back(BodyPose(data, bodies_[node.link]) * node.p_Body);
  }
  return line;
}

Polyline TubeBody::Centerline_N(const mjData& data) const {
  return Transformed(options_.X_WN.inverse(), Centerline_W(data));
}

PileTube TubeBody::Current(const mjData& data) const {
  PileTube tube = tube_;
  tube.centerline_N = Centerline_N(data);
  return tube;
}

Vector3 TubeBody::CentreOfMass_W(const mjModel& model, const mjData& data) const {
  TT_CHECK(!bodies_.empty());
  Vector3 sum = Vector3::Zero();
  double mass_kg = 0.0;
  for (const int body : bodies_) {
    sum += model.body_mass[body] * Vector3(data.xipos + 3 * body);
    mass_kg += model.body_mass[body];
  }
  return sum / mass_kg;
}

double TubeBody::MaxSpeed(const mjModel& model, const mjData& data, const Vector3& v_W) const {
  TT_CHECK(!bodies_.empty());
  double fastest = 0.0;
  for (const Attachment& node : nodes_) {
    mjtNum velocity[6];  // Rotation, then translation of the body's frame origin, world axes.
    mj_objectVelocity(&model, &data, mjOBJ_XBODY, bodies_[node.link], velocity, 0);
    const Vector3 arm = BodyPose(data, bodies_[node.link]).linear() * node.p_Body;
    const Vector3 speed = Vector3(velocity + 3) + Vector3(velocity).cross(arm) - v_W;
    // A number that is not one must not pass for rest.
    if (!(speed.norm() <= fastest)) fastest = speed.norm();
    if (!std::isfinite(fastest)) return std::numeric_limits<double>::infinity();
  }
  return fastest;
}

TubeBody::Attachment TubeBody::AttachmentAt(double arc_length_m) const {
  const Polyline& line = tube_.centerline_N;
  const std::vector<double> at = ArcLengths(line);
  const double s = std::clamp(arc_length_m, 0.0, at.back());
  std::size_t i = 0;
  while (i + 2 < at.size() && at[i + 1] < s) ++i;
  const double share = (s - at[i]) / (at[i + 1] - at[i]);
  if (!options_.hose) {
    return {0, nodes_[i].p_Body + share * (nodes_[i + 1].p_Body - nodes_[i].p_Body)};
  }
  const int link = static_cast<int>(i), root = (static_cast<int>(line.size()) - 1) / 2;
  const double length_m = at[i + 1] - at[i];
  // Frames sit at the node towards the middle, z forward.
  const double z = link >= root ? share * length_m : -(1.0 - share) * length_m;
  return {link, Vector3(0, 0, z)};
}

}  // namespace tubetwin

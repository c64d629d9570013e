#include "planner/evaluator/rollout_scene.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/random.h"
#include "models/gripper_spec.h"
#include "planner/grasp/gripper_boxes.h"
#include "planner/scene_query/sweep.h"
#include "scenes/bin_body.h"
#include "scenes/engine/engine_error.h"
#include "scenes/engine/surface.h"

namespace tubetwin {
namespace {

constexpr double kChord_m = 0.001;  // Rigid tubes: error of the capsules' axes.
// The hand: stiff against the tube, slow enough for the time step (reference: 0.4 rad per step).
constexpr double kSlideStiffness_N_m = 2e4, kSlideArmature_kg = 1.5, kHandMass_kg = 0.2;
constexpr double kTurnStiffness_Nm = 1000.0, kTurnDamping_Nms = 16.0, kTurnArmature_kgm2 = 0.05;
constexpr double kTurnTorque_Nm = 5.0;
// Settling: overlaps of what was perceived are let apart with most of the speed taken away.
constexpr double kGentle_s = 0.24, kKeepSpeed = 0.7, kSettle_s = 1.5, kAtRest_m_s = 0.005;
constexpr int kRestSteps = 10;
constexpr double kCreepWindow_s = 0.4;
constexpr double kTableBelow_m = 0.10;  // Under the bin's floor.
// Slower than this times the step for ten steps: asleep. What turns back accelerates by more.
constexpr double kAsleep_m_s2 = 2.5;
constexpr double kParked_m = 5.0;  // The hand's height before it grips.
// What the hand may touch: all tubes but the one that it holds. Walls are checked with the motion.
constexpr int kHandBit = 2;
constexpr double kHandFriction = 0.3;

PileTube TubeToBuild(const PerceivedTube& tube, const Part& part, const Vector3& shift) {
  PileTube build;
  build.id = tube.id;
  build.radius_m = tube.radius_m;
  const double length_m = Length(tube.centerline_N);
  // A tube of which only a part was seen weighs only that part: the rest is not in the scene.
  build.mass_kg = part.mass_kg * std::clamp(length_m / part.length_m, 0.1, 1.5);
  const Polyline line = part.is_hose() ? ResampleCount(tube.centerline_N, part.links + 1)
                                       : Simplified(tube.centerline_N, kChord_m);
  build.centerline_N = Transformed(Translation(shift), line);
  return build;
}

std::vector<PileTube> TubesToBuild(const TubeScene& scene, const Part& part,
                                   const SampleDraw& draw) {
  std::vector<PileTube> out;
  for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
    out.push_back(TubeToBuild(scene.tubes[i], part, draw.shift_N[i]));
  }
  return out;
}

void SetServo(mjSpec& spec, const std::string& joint, double stiffness, double damping,
              double limit) {
  mjsActuator* servo = mjs_addActuator(&spec, nullptr);
  SetName(servo->element, joint + "_servo");
  servo->trntype = mjTRN_JOINT;
  mjs_setString(servo->target, joint.c_str());
  servo->gaintype = mjGAIN_FIXED;
  servo->gainprm[0] = stiffness;
  servo->biastype = mjBIAS_AFFINE;
  servo->biasprm[0] = 0.0;
  servo->biasprm[1] = -stiffness;
  servo->biasprm[2] = -damping;
  servo->forcelimited = mjLIMITED_TRUE;
  servo->forcerange[0] = -limit;
  servo->forcerange[1] = limit;
}

}  // namespace

SampleDraw DrawSample(const Part& part, int tubes, int sample, std::uint64_t seed,
                      const EvaluatorConfig& config) {
  SampleDraw draw{part.friction, part.bending_stiffness_Nm2,
                  std::vector<Vector3>(tubes, Vector3::Zero())};
  if (sample == 0) return draw;
  RandomStream stream(seed, static_cast<std::uint64_t>(sample), "evaluator");
  const auto within = [&](const std::vector<double>& range, double nominal) {
    return range.size() == 2 ? stream.Uniform(range[0], range[1]) : nominal;
  };
  draw.friction = within(part.friction_range, part.friction);
  draw.bending_stiffness_Nm2 = within(part.bending_stiffness_range_Nm2, part.bending_stiffness_Nm2);
  for (Vector3& shift : draw.shift_N) {
    for (int k = 0; k < 3; ++k) shift[k] = stream.Normal(0.0, config.pose_error_m);
  }
  return draw;
}

RolloutScene::RolloutScene(const TubeScene& scene, const Part& part, const Bin& bin,
                           const SampleDraw& draw, const EvaluatorOptions& options)
    : RolloutScene(TubesToBuild(scene, part, draw), part, bin, draw.friction,
                   draw.bending_stiffness_Nm2, options) {}

RolloutScene::RolloutScene(const std::vector<PileTube>& tubes, const Part& part, const Bin& bin,
                           double friction, double bending_stiffness_Nm2,
                           const EvaluatorOptions& options)
    : bin_(bin), pad_width_m_(options.gripper.spec.pad_width_m) {
  const EvaluatorConfig& config = options.config;
  EngineOptions engine;
  engine.timestep_s = config.timestep_s;
  engine.impratio = 10.0;
  MjSpec spec = MakeSpec(engine);
  // Contacts may not be stiffer than two time steps.
  const double contact_s = std::max(0.005, 2.0 * config.timestep_s);
  BinBodyOptions bin_options;
  bin_options.friction = friction;
  bin_options.contact_time_s = contact_s;
  AddBin(*spec, bin, bin_options);
  // What falls out of the bin lands somewhere.
  AddGround(*spec, Translation(0, 0, -kTableBelow_m), bin_options);

  RoundPhysics physics = NominalPhysics(part);
  physics.bending_stiffness_Nm2 = bending_stiffness_Nm2;
  physics.tube_friction = friction;
  TubeBodyOptions tube_options = MakeTubeBodyOptions(part, physics, RigidTransform::Identity(), 0);
  tube_options.contact_time_s = contact_s;
  tubes_.reserve(tubes.size());
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    tubes_.emplace_back(*spec, "tube" + std::to_string(i), tubes[i], tube_options);
  }
  AddHand(*spec, config.hand_force_N);
  AddFingers(*mjs_findBody(spec.get(), "hand"), options.gripper, part.radius_m, contact_s);
  model_ = Compile(*spec, "evaluator");
  for (TubeBody& tube : tubes_) tube.Bind(*model_);
  BindHand();
  Settle();
  // Where things move, chance decides more than the solver's last digits do.
  model_->opt.tolerance = config.tolerance;
  // Tubes that lie still apart from the lifted one are left out until something touches them.
  model_->opt.enableflags |= mjENBL_SLEEP;
  model_->opt.sleep_tolerance = kAsleep_m_s2 * config.timestep_s;
}

void RolloutScene::AddHand(mjSpec& spec, double force_N) {
  mjsBody* hand = mjs_addBody(mjs_findBody(&spec, "world"), nullptr);
  SetName(hand->element, "hand");
  hand->gravcomp = 1.0;
  hand->explicitinertial = true;
  hand->mass = kHandMass_kg;
  for (double& inertia : hand->inertia) inertia = 1e-3;
  const char* names[kHandAxes] = {"hand_x",     "hand_y",     "hand_z",
                                  "hand_rot_x", "hand_rot_y", "hand_rot_z"};
  for (int axis = 0; axis < kHandAxes; ++axis) {
    mjsJoint* joint = mjs_addJoint(hand, nullptr);
    SetName(joint->element, names[axis]);
    const bool slide = axis < 3;
    joint->type = slide ? mjJNT_SLIDE : mjJNT_HINGE;
    for (int k = 0; k < 3; ++k) joint->axis[k] = k == axis % 3 ? 1.0 : 0.0;
    joint->armature = slide ? kSlideArmature_kg : kTurnArmature_kgm2;
    const double critical =
        2.0 * std::sqrt(kSlideStiffness_N_m * (kSlideArmature_kg + kHandMass_kg));
    SetServo(spec, names[axis], slide ? kSlideStiffness_N_m : kTurnStiffness_Nm,
             slide ? critical : kTurnDamping_Nms, slide ? force_N : kTurnTorque_Nm);
  }
  // One sleeping weld per link: every candidate is a switch, not another model.
  for (const TubeBody& tube : tubes_) {
    for (const std::string& link : tube.body_names()) {
      mjsEquality* weld = mjs_addEquality(&spec, nullptr);
      SetName(weld->element, "grip_" + link);
      weld->type = mjEQ_WELD;
      weld->objtype = mjOBJ_BODY;
      mjs_setString(weld->name1, "hand");
      mjs_setString(weld->name2, link.c_str());
      weld->active = false;
      weld->solref[0] = 2.0 * spec.option.timestep;
      weld->solref[1] = 1.0;
      weld->solimp[0] = 0.99;
      weld->solimp[1] = 0.999;
      weld->solimp[2] = 0.001;
    }
  }
}

// The gripper as it comes down vertically, closed on a tube that lies on the floor.
void RolloutScene::AddFingers(mjsBody& hand, const GripperGeometry& gripper, double radius_m,
                              double contact_s) {
  const double height_m = GraspHeightOverAxis(radius_m, gripper.spec);
  const GripperBoxes boxes = MakeGripperBoxes(gripper, 2.0 * radius_m, radius_m, height_m);
  const RigidTransform X_HandE =
      Translation(0, 0, height_m) * Eigen::AngleAxisd(kPi, Vector3::UnitX());
  std::vector<OrientedBox> solid = {boxes.finger[0], boxes.finger[1]};
  for (const auto& [name, box_E] : boxes.carrying) solid.push_back(box_E);
  for (const OrientedBox& box_E : solid) {
    const OrientedBox box = Moved(X_HandE, box_E);
    mjsGeom* geom = mjs_addGeom(&hand, nullptr);
    geom->type = mjGEOM_BOX;
    const std::array<double, 4> turn = QuaternionWxyz(box.X_AB.linear());
    std::copy(turn.begin(), turn.end(), geom->quat);
    for (int k = 0; k < 3; ++k) geom->pos[k] = box.X_AB.translation()[k];
    for (int k = 0; k < 3; ++k) geom->size[k] = box.half_m[k];
    geom->mass = 0.0;
    SetSurface(*geom, kHandFriction, 1, contact_s);
    geom->contype = kHandBit;
    geom->conaffinity = 0;
  }
}

void RolloutScene::BindHand() {
  hand_ = IdOf(*model_, mjOBJ_BODY, "hand");
  first_axis_qpos_ = model_->jnt_qposadr[IdOf(*model_, mjOBJ_JOINT, "hand_x")];
  first_actuator_ = IdOf(*model_, mjOBJ_ACTUATOR, "hand_x_servo");
  TT_CHECK(IdOf(*model_, mjOBJ_ACTUATOR, "hand_rot_z_servo") == first_actuator_ + 5);
  int next = 0;
  for (const TubeBody& tube : tubes_) {
    TT_CHECK(IdOf(*model_, mjOBJ_EQUALITY, "grip_" + tube.body_names().front()) == next);
    weld_offset_.push_back(next);
    next += static_cast<int>(tube.body_names().size());
    for (const int geom : tube.geoms()) {
      model_->geom_conaffinity[geom] |= kHandBit;
      model_->body_conaffinity[model_->geom_bodyid[geom]] |= kHandBit;
    }
  }
}

void RolloutScene::Settle() {
  MjData data = MakeData(*model_);
  data->qpos[first_axis_qpos_ + 2] = kParked_m;
  Command(Vector3(0, 0, kParked_m), Matrix3::Identity(), *data);
  const double dt = model_->opt.timestep;
  const int gentle = static_cast<int>(kGentle_s / dt), limit = static_cast<int>(kSettle_s / dt);
  int at_rest = 0;
  for (int step = 0; step < limit && at_rest < kRestSteps; ++step) {
    status_ = Step(*model_, *data);
    if (status_ != StepStatus::kOk) return;
    if (step < gentle) {
      for (int k = 0; k < model_->nv; ++k) data->qvel[k] *= kKeepSpeed;
      continue;
    }
    double fastest = 0.0;
    for (const TubeBody& tube : tubes_) {
      fastest = std::max(fastest, tube.MaxSpeed(*model_, *data));
    }
    at_rest = fastest < kAtRest_m_s ? at_rest + 1 : 0;
  }
  std::fill(data->qvel, data->qvel + model_->nv, 0.0);
  data->time = 0.0;
  settled_ = Snapshot(*model_, *data);
  MeasureCreep(*data);
}

void RolloutScene::MeasureCreep(mjData& data) {
  settled_.Restore(*model_, data);
  for (const TubeBody& tube : tubes_) centres_N_.push_back(tube.CentreOfMass_W(*model_, data));
  status_ = Step(*model_, data, static_cast<int>(kCreepWindow_s / model_->opt.timestep));
  if (status_ != StepStatus::kOk) return;
  for (std::size_t i = 0; i < tubes_.size(); ++i) {
    const Vector3 moved = tubes_[i].CentreOfMass_W(*model_, data) - centres_N_[i];
    creep_m_s_.push_back(moved.norm() / kCreepWindow_s);
  }
}

RigidTransform RolloutScene::Grip(int index, double share, mjModel& model, mjData& data) const {
  GuardEngine([&] { mj_resetData(&model, &data); });  // Awake, whatever ran before.
  settled_.Restore(model, data);
  const TubeBody& tube = tubes_[index];
  const double length_m = Length(tube.initial().centerline_N);
  const TubeBody::Attachment at = tube.AttachmentAt(share * length_m);
  const RigidTransform X_NLink = BodyPose(data, tube.bodies()[at.link]);
  const Polyline line = tube.Centerline_N(data);
  const Vector3 tangent = TangentAt(line, share * Length(line), pad_width_m_);
  RigidTransform X_NHand = Translation(X_NLink * at.p_Body);
  // Of the two equal yaws the smaller, so that motions may turn it either way.
  double yaw = std::atan2(tangent.y(), tangent.x());
  if (yaw > 0.5 * kPi) yaw -= kPi;
  if (yaw <= -0.5 * kPi) yaw += kPi;
  X_NHand.rotate(Eigen::AngleAxisd(yaw, Vector3::UnitZ()));

  const int weld = weld_offset_[index] + at.link;
  mjtNum* eq = model.eq_data + mjNEQDATA * weld;
  // Anchor in the link, the same point in the hand (its origin), turn of the link in the hand.
  const std::array<double, 4> turn =
      QuaternionWxyz(X_NHand.linear().transpose() * X_NLink.linear());
  for (int k = 0; k < 3; ++k) eq[k] = at.p_Body[k];
  for (int k = 0; k < 3; ++k) eq[3 + k] = 0.0;
  for (int k = 0; k < 4; ++k) eq[6 + k] = turn[k];
  eq[10] = 1.0;
  data.eq_active[weld] = 1;
  for (const int geom : tube.geoms()) model.geom_conaffinity[geom] &= ~kHandBit;
  for (int k = 0; k < 3; ++k) data.qpos[first_axis_qpos_ + k] = X_NHand.translation()[k];
  data.qpos[first_axis_qpos_ + 5] = yaw;
  Command(X_NHand.translation(), X_NHand.linear(), data);
  return X_NHand;
}

void RolloutScene::Command(const Vector3& p_NHand, const Matrix3& R_NHand, mjData& data) const {
  // The hinges follow each other: R = Rx Ry Rz.
  const Matrix3& R = R_NHand;
  const std::array<double, 3> angles = {std::atan2(-R(1, 2), R(2, 2)),
                                        std::asin(std::clamp(R(0, 2), -1.0, 1.0)),
                                        std::atan2(-R(0, 1), R(0, 0))};
  for (int k = 0; k < 3; ++k) data.ctrl[first_actuator_ + k] = p_NHand[k];
  for (int k = 0; k < 3; ++k) {
    // A hinge goes on beyond half a turn instead of the long way back.
    mjtNum& hinge = data.ctrl[first_actuator_ + 3 + k];
    hinge = angles[k] + 2.0 * kPi * std::round((hinge - angles[k]) / (2.0 * kPi));
  }
}

double RolloutScene::Load(const mjModel& model, const mjData& data) const {
  double load = 0.0;
  for (int k = first_actuator_; k < first_actuator_ + kHandAxes; ++k) {
    load = std::max(load, std::abs(data.actuator_force[k]) / model.actuator_forcerange[2 * k + 1]);
  }
  return load;
}

}  // namespace tubetwin

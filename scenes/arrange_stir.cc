#include <cmath>
#include <string>
#include <vector>

#include "scenes/arrange.h"
#include "scenes/engine/stepping.h"
#include "scenes/pile_scene.h"

namespace tubetwin::arrange {
namespace {

constexpr double kRodRadius_m = 0.012, kRodLength_m = 0.35, kRodMass_kg = 0.5;
constexpr double kFloorGap_m = 0.006;  // Under the lowered rod: no tube slips below.
constexpr double kClear_m = 0.05;      // Raised rod's tip over the pile.
constexpr double kSpeed_m_s = 0.5, kForce_N = 15.0;
constexpr double kStiffness_N_m = 2000.0, kDamping_Ns_m = 60.0;
constexpr int kSweeps = 4;
constexpr double kReach = 0.55;  // Sweeps turn round at this share of the half sides.
constexpr double kLimit_s = 20.0;

// A rod on three slides, each with a position servo of limited force; the slides' zero is the
// floor's centre with the tip at the floor.
void AddRod(mjSpec& spec) {
  mjsBody* body = mjs_addBody(mjs_findBody(&spec, "world"), nullptr);
  SetName(body->element, "rod");
  const char* const names[] = {"rod_x", "rod_y", "rod_z"};
  for (int k = 0; k < 3; ++k) {
    mjsJoint* joint = mjs_addJoint(body, nullptr);
    SetName(joint->element, names[k]);
    joint->type = mjJNT_SLIDE;
    for (int i = 0; i < 3; ++i) joint->axis[i] = i == k ? 1.0 : 0.0;
    mjsActuator* servo = mjs_addActuator(&spec, nullptr);
    SetName(servo->element, names[k]);
    servo->trntype = mjTRN_JOINT;
    SetString(servo->target, names[k]);
    servo->gaintype = mjGAIN_FIXED;
    servo->biastype = mjBIAS_AFFINE;
    servo->gainprm[0] = kStiffness_N_m;
    servo->biasprm[1] = -kStiffness_N_m;
    servo->biasprm[2] = -kDamping_Ns_m;
    servo->forcelimited = mjLIMITED_TRUE;
    servo->forcerange[0] = -kForce_N;
    servo->forcerange[1] = kForce_N;
  }
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom->type = mjGEOM_CAPSULE;
  geom->size[0] = kRodRadius_m;
  const double ends[] = {0, 0, kRodRadius_m, 0, 0, kRodLength_m};
  for (int k = 0; k < 6; ++k) geom->fromto[k] = ends[k];
  geom->mass = kRodMass_kg;
  body->gravcomp = 1.0;
  geom->condim = 3;
  geom->priority = 1;  // A smooth rod whatever the tubes are.
  geom->friction[0] = 0.2;
  geom->solref[0] = 0.005;
}

// Moves the servos' set point in a straight line; the last coordinates stay commanded.
StepStatus Move(PileScene& scene, const Vector3& to) {
  mjData& data = scene.data();
  const Vector3 from(data.ctrl);
  const double dt = scene.model().opt.timestep;
  const int steps =
      std::max(1, static_cast<int>(std::ceil((to - from).norm() / (kSpeed_m_s * dt))));
  StepStatus status = StepStatus::kOk;
  for (int i = 1; i <= steps && status == StepStatus::kOk; ++i) {
    const Vector3 now = from + (to - from) * (static_cast<double>(i) / steps);
    for (int k = 0; k < 3; ++k) data.ctrl[k] = now[k];
    status = Step(scene.model(), data, 1);
  }
  return status;
}

// Down beside the middle, chords to and fro across the pile, up again.
std::vector<Vector3> DrawPath(const Order& order, double raised_m, RandomStream& stream) {
  const double x = kReach * order.bin.half_x_m(), y = kReach * order.bin.half_y_m();
  double angle = stream.Uniform(0.0, 2 * kPi);
  std::vector<Vector3> path;
  const auto add = [&](double z) { path.push_back({x * std::cos(angle), y * std::sin(angle), z}); };
  add(raised_m);
  add(kFloorGap_m);
  for (int i = 0; i < kSweeps; ++i) {
    angle += kPi + Radians(stream.Uniform(-60.0, 60.0));
    add(kFloorGap_m);
  }
  add(raised_m);
  return path;
}

}  // namespace

SettleResult Stir(const Order& order, RandomStream stream) {
  SettleResult dropped = Drop(order, stream.Fork("drop"));
  if (dropped.status != SettleStatus::kSettled) return dropped;
  PileSpec parts = MakePileSpec(dropped.pile, order.physics);
  AddRod(*parts.spec);
  PileScene scene(std::move(parts), dropped.pile, "stirred pile");
  RandomStream draws = stream.Fork("path");
  const std::vector<Vector3> path = DrawPath(order, scene.Top() + kClear_m, draws);
  // The rod begins raised, over the first point.
  for (int k = 0; k < 3; ++k) {
    scene.data().ctrl[k] = path[0][k];
    scene.data().qpos[scene.model().nq - 3 + k] = path[0][k];
  }
  for (const Vector3& point : path) {
    const StepStatus status = Move(scene, point);
    if (status == StepStatus::kOk) continue;
    SettleResult result = dropped;
    result.status = SettleStatus::kDiverged;
    result.reason = std::string("while stirring, the physics engine reports ") + ToString(status);
    return result;
  }
  const double stirred_s = scene.data().time;
  SettleResult result = StepUntilSettled(scene, kLimit_s);
  result.simulated_s += stirred_s + dropped.simulated_s;
  return result;
}

}  // namespace tubetwin::arrange

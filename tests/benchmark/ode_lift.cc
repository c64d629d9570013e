#include "tests/benchmark/ode_lift.h"

#define dDOUBLE
#include <ode/ode.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "models/base/frames.h"
#include "models/base/polyline.h"
#include "planner/scene_query/sweep.h"

namespace tubetwin {
namespace {

constexpr double kStep_s = 0.001;
constexpr int kIterations = 50;
constexpr int kMostContacts = 8;
constexpr double kChord_m = 0.001;  // As the evaluator's capsules.

struct World {
  World() {
    dInitODE2(0);
    world = dWorldCreate();
    space = dHashSpaceCreate(nullptr);
    contacts = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, 0, -9.80665);
    dWorldSetQuickStepNumIterations(world, kIterations);
    dWorldSetERP(world, 0.2);
    dWorldSetCFM(world, 1e-6);
    dWorldSetContactSurfaceLayer(world, 0.001);
    dWorldSetContactMaxCorrectingVel(world, 0.1);
  }
  ~World() {
    dJointGroupDestroy(contacts);
    dSpaceDestroy(space);
    dWorldDestroy(world);
    dCloseODE();
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  dWorldID world;
  dSpaceID space;
  dJointGroupID contacts;
  double friction = 0.3;
};

void OnNear(void* data, dGeomID a, dGeomID b) {
  World& world = *static_cast<World*>(data);
  const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
  if (body_a == body_b) return;
  dContactGeom found[kMostContacts];
  const int count = dCollide(a, b, kMostContacts, found, sizeof(dContactGeom));
  for (int k = 0; k < count; ++k) {
    dContact contact{};
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = world.friction;
    contact.geom = found[k];
    dJointAttach(dJointCreateContact(world.world, world.contacts, &contact), body_a, body_b);
  }
}

dBodyID AddTube(World& world, const PileTube& tube) {
  const dBodyID body = dBodyCreate(world.world);
  const Polyline line = Simplified(tube.centerline_N, kChord_m);
  const Vector3 centre = CurveCentre(line);
  dBodySetPosition(body, centre.x(), centre.y(), centre.z());
  const double length = Length(line);
  dMass total;
  dMassSetZero(&total);
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vector3 middle = 0.5 * (line[k - 1] + line[k]) - centre, way = line[k] - line[k - 1];
    const double part = way.norm();
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), way);
    const dQuaternion q = {turn.w(), turn.x(), turn.y(), turn.z()};
    const dGeomID geom = dCreateCapsule(world.space, tube.radius_m, part);
    dGeomSetBody(geom, body);
    dGeomSetOffsetPosition(geom, middle.x(), middle.y(), middle.z());
    dGeomSetOffsetQuaternion(geom, q);
    dMass mass;
    dMassSetCylinderTotal(&mass, tube.mass_kg * part / length, 3, tube.radius_m, part);
    dMatrix3 rotation;
    dQtoR(q, rotation);
    dMassRotate(&mass, rotation);
    dMassTranslate(&mass, middle.x(), middle.y(), middle.z());
    dMassAdd(&total, &mass);
  }
  // What is left of the centre's error is below the chord's.
  dMassTranslate(&total, -total.c[0], -total.c[1], -total.c[2]);
  dBodySetMass(body, &total);
  return body;
}

void AddBin(World& world, const Bin& bin) {
  const auto box = [&](double x, double y, double z, double lx, double ly, double lz) {
    dGeomSetPosition(dCreateBox(world.space, lx, ly, lz), x, y, z);
  };
  const double x = bin.half_x_m(), y = bin.half_y_m(), h = bin.wall_m();
  const double t = Bin::kWallThickness_m;
  box(0, 0, -0.5 * t, 2 * x + 2 * t, 2 * y + 2 * t, t);
  for (const double side : {-1.0, 1.0}) {
    box(side * (x + 0.5 * t), 0, 0.5 * h, t, 2 * y + 2 * t, h);
    box(0, side * (y + 0.5 * t), 0.5 * h, 2 * x, t, h);
  }
}

Vector3 PositionOf(dBodyID body) {
  const dReal* p = dBodyGetPosition(body);
  return {p[0], p[1], p[2]};
}

}  // namespace

OdeLift LiftInOde(const Pile& pile, int index, double lift_m, double speed_m_s, double hold_s) {
  World world;
  world.friction = pile.part.friction;
  AddBin(world, pile.bin);
  std::vector<dBodyID> bodies;
  std::vector<Vector3> before;
  for (const PileTube& tube : pile.tubes) {
    bodies.push_back(AddTube(world, tube));
    before.push_back(PositionOf(bodies.back()));
  }
  const int rising = static_cast<int>(std::lround(lift_m / speed_m_s / kStep_s));
  const int steps = rising + static_cast<int>(std::lround(hold_s / kStep_s));
  const auto began = std::chrono::steady_clock::now();
  for (int step = 0; step < steps; ++step) {
    dBodySetLinearVel(bodies[index], 0, 0, step < rising ? speed_m_s : 0.0);
    dBodySetAngularVel(bodies[index], 0, 0, 0);
    dSpaceCollide(world.space, &world, &OnNear);
    dWorldQuickStep(world.world, kStep_s);
    dJointGroupEmpty(world.contacts);
  }
  OdeLift out;
  out.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  out.simulated_s = steps * kStep_s;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (static_cast<int>(k) != index) {
      out.displacement_m += (PositionOf(bodies[k]) - before[k]).norm();
    }
  }
  return out;
}

}  // namespace tubetwin

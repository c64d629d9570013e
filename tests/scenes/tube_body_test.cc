#include "scenes/tube_body.h"

#include <cmath>

#include "models/base/random.h"
#include "scenes/bin_body.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/engine/stepping.h"
#include "tests/support/catch.h"
#include "tests/support/clamp.h"

namespace tubetwin {
namespace {

PileTube Straight(int nodes, double length_m, double radius_m, double mass_kg, double height_m) {
  PileTube tube;
  for (int i = 0; i < nodes; ++i) {
    tube.centerline_N.push_back({length_m * i / (nodes - 1) - 0.5 * length_m, 0, height_m});
  }
  tube.radius_m = radius_m;
  tube.mass_kg = mass_kg;
  return tube;
}

PileTube Crooked(std::uint64_t seed, int nodes) {
  RandomStream stream(seed, 0, "crooked");
  PileTube tube = Straight(nodes, 0.4, 0.01, 0.11, 0.2);
  for (Vector3& p : tube.centerline_N) {
    p += Vector3(0, stream.Uniform(-0.02, 0.02), stream.Uniform(-0.02, 0.02));
  }
  return tube;
}

double LargestGap(const Polyline& a, const Polyline& b) {
  REQUIRE(a.size() == b.size());
  double gap = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) gap = std::max(gap, (a[i] - b[i]).norm());
  return gap;
}

TEST_CASE("A tube put into a scene reads back node for node, in any bin pose", "[unit]") {
  const double kRounding_m = 1e-12;
  for (const bool hose : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      PileTube tube = Crooked(seed, 11);
      tube.rest_centerline_N = Crooked(seed + 100, 11).centerline_N;
      TubeBodyOptions options;
      options.hose = hose;
      options.X_WN = MakeTransform(RotZ(1.1) * RotX(0.2), Vector3(0.6, 0.1, 0.3));
      MjSpec spec = MakeSpec();
      TubeBody body(*spec, "tube", tube, options);
      MjModel model = Compile(*spec, "round trip");
      body.Bind(*model);
      const MjData data = MakeData(*model);
      CHECK(LargestGap(body.Centerline_N(*data), tube.centerline_N) < kRounding_m);
      CHECK(mj_getTotalmass(model.get()) == Approx(tube.mass_kg));
      const Vector3 centre_N = options.X_WN.inverse() * body.CentreOfMass_W(*model, *data);
      CHECK((centre_N - CurveCentre(tube.centerline_N)).norm() < kRounding_m);
      // Places along the axis, too.
      for (double s = 0.0; s < Length(tube.centerline_N); s += 0.013) {
        const TubeBody::Attachment at = body.AttachmentAt(s);
        const Vector3 p_N =
            options.X_WN.inverse() * (BodyPose(*data, body.bodies()[at.link]) * at.p_Body);
        CHECK((p_N - PointAt(tube.centerline_N, s)).norm() < kRounding_m);
      }
    }
  }
}

TEST_CASE("A rigid tube has the inertia of its thin wall", "[unit]") {
  const PileTube tube = Straight(6, 0.5, 0.0125, 0.055, 0.1);
  MjSpec spec = MakeSpec();
  TubeBody body(*spec, "tube", tube, {});
  MjModel model = Compile(*spec, "inertia");
  body.Bind(*model);
  const double* inertia = model->body_inertia + 3 * body.bodies()[0];
  CHECK(inertia[0] == Approx(0.055 * 0.0125 * 0.0125));
  CHECK(inertia[2] == Approx(0.055 * (0.0125 * 0.0125 / 2 + 0.5 * 0.5 / 12)));
}

TEST_CASE("A clamped hose sags as beam theory says", "[physics]") {
  const double kChainError = 0.08;  // Ten stiff links instead of a smooth beam, and the solver.
  for (const double stiffness : {0.1, 0.3}) {
    const double length_m = 0.25;
    const int links = 10;
    const PileTube tube = Straight(links + 1, length_m, 0.01, 0.275 * length_m, 0.5);
    TubeBodyOptions options;
    options.hose = true;
    options.bending_stiffness_Nm2 = stiffness;
    MjSpec spec = MakeSpec();
    TubeBody body(*spec, "hose", tube, options);
    test::ClampFirstLink(*spec, body);
    MjModel model = Compile(*spec, "cantilever");
    body.Bind(*model);
    MjData data = MakeData(*model);
    REQUIRE(Step(*model, *data, 3000) == StepStatus::kOk);
    mj_forward(model.get(), data.get());
    CHECK(body.MaxSpeed(*model, *data) < 1e-3);
    const Polyline line = body.Centerline_N(*data);
    const double sag_m = line.front().z() - line.back().z();
    // The first link is held whole; the joint at its end bends for half of it and half of the next.
    const double free_m = length_m - 0.5 * length_m / links;
    const double weight_N_per_m = 0.275 * kGravity;
    const double theory_m = weight_N_per_m * std::pow(free_m, 4) / (8 * stiffness);
    CHECK(sag_m == Approx(theory_m).epsilon(kChainError));
  }
}

TEST_CASE("A hose without load goes back to its rest shape from a bent one", "[physics]") {
  // The rest shape is a hook out of plane; the start is straight. No gravity.
  PileTube tube = Straight(11, 0.4, 0.01, 0.11, 0.2);
  Polyline rest = {Vector3::Zero()};
  Vector3 direction = Vector3::UnitX();
  for (int i = 0; i < 10; ++i) {
    rest.push_back(rest.back() + 0.04 * direction);
    direction = (i < 5 ? RotZ(0.3) : RotY(0.25)) * direction;
  }
  tube.rest_centerline_N = rest;
  TubeBodyOptions options;
  options.hose = true;
  MjSpec spec = MakeSpec();
  TubeBody body(*spec, "hose", tube, options);
  MjModel model = Compile(*spec, "relax");
  for (double& g : model->opt.gravity) g = 0.0;
  body.Bind(*model);
  MjData data = MakeData(*model);
  REQUIRE(Step(*model, *data, 2000) == StepStatus::kOk);
  mj_forward(model.get(), data.get());
  const Polyline line = body.Centerline_N(*data);
  // Same distances between all pairs of nodes, and the same handedness: the same shape in space.
  const double kTwistOfHinges_m = 2e-4;  // Two hinges are free of twist only to second order.
  for (std::size_t i = 0; i < line.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      CHECK((line[i] - line[j]).norm() ==
            Approx((rest[i] - rest[j]).norm()).margin(kTwistOfHinges_m));
    }
  }
  const auto handedness = [](const Polyline& p) {
    return (p[3] - p[0]).cross(p[6] - p[3]).dot(p[10] - p[6]);
  };
  CHECK(handedness(line) == Approx(handedness(rest)).epsilon(0.02));
}

// Slides a tube laid across a tilted plane for a second and says how far it went downhill.
double SlideDistance(double friction, double tilt_rad) {
  EngineOptions engine;
  engine.up = RotX(tilt_rad) * Vector3::UnitZ();  // Gravity tilts instead of the plane.
  MjSpec spec = MakeSpec(engine);
  // Uphill is y, and the tube lies along y: it cannot roll.
  PileTube tube = Straight(3, 0.4, 0.01, 0.05, 0.01);
  for (Vector3& p : tube.centerline_N) p = RotZ(kPi / 2) * p;
  TubeBodyOptions options;
  options.friction = friction;
  BinBodyOptions ground;
  ground.friction = friction;
  AddGround(*spec, RigidTransform::Identity(), ground);
  TubeBody body(*spec, "tube", tube, options);
  MjModel model = Compile(*spec, "slope");
  body.Bind(*model);
  MjData data = MakeData(*model);
  const double start = body.CentreOfMass_W(*model, *data).y();
  REQUIRE(Step(*model, *data, 500) == StepStatus::kOk);
  mj_forward(model.get(), data.get());
  return std::abs(body.CentreOfMass_W(*model, *data).y() - start);
}

TEST_CASE("A tube slides on a slope above the friction angle and sticks below it", "[physics]") {
  for (const double friction : {0.3, 0.9}) {
    const double angle = std::atan(friction);
    CHECK(SlideDistance(friction, angle - Radians(2)) < 1e-3);  // Creep of the soft contact.
    const double steeper = angle + Radians(3);
    const double acceleration = kGravity * (std::sin(steeper) - friction * std::cos(steeper));
    // From rest in one second; the creep of soft friction adds a little.
    CHECK(SlideDistance(friction, steeper) == Approx(0.5 * acceleration).epsilon(0.05));
  }
}

}  // namespace
}  // namespace tubetwin

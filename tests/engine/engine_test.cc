#include <mujoco/mujoco.h>

#include <filesystem>

#include "models/base/error.h"
#include "scenes/engine/engine_error.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/engine/stepping.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

mjsBody* World(const MjSpec& spec) { return mjs_findBody(spec.get(), "world"); }

// A ball of 1 kg, 10 cm, free.
void AddBall(const MjSpec& spec, double height_m) {
  mjsBody* body = mjs_addBody(World(spec), nullptr);
  SetName(body->element, "ball");
  body->pos[2] = height_m;
  mjs_addFreeJoint(body);
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom->type = mjGEOM_SPHERE;
  geom->size[0] = 0.1;
  geom->mass = 1.0;
}

TEST_CASE("A free fall follows g t^2 / 2", "[physics]") {
  MjSpec spec = MakeSpec();
  AddBall(spec, 10.0);
  MjModel model = Compile(*spec, "fall");
  MjData data = MakeData(*model);
  const double dt = model->opt.timestep;
  const int steps = 500;
  REQUIRE(Step(*model, *data, steps) == StepStatus::kOk);
  // Semi-implicit integration: velocity first, so n steps fall g dt^2 n (n + 1) / 2, exactly.
  const double fallen = kGravity * dt * dt * steps * (steps + 1) / 2;
  const double kRounding = 1e-9;
  CHECK(data->qpos[2] == Approx(10.0 - fallen).margin(kRounding));
  CHECK(data->qvel[2] == Approx(-kGravity * steps * dt).margin(kRounding));
}

TEST_CASE("A pendulum swings with the period of its length", "[physics]") {
  EngineOptions options;
  options.timestep_s = 0.0005;
  MjSpec spec = MakeSpec(options);
  mjsBody* body = mjs_addBody(World(spec), nullptr);
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  joint->type = mjJNT_HINGE;
  joint->axis[0] = 0;
  joint->axis[1] = 1;
  joint->axis[2] = 0;
  body->explicitinertial = true;
  body->mass = 0.5;
  body->ipos[0] = body->ipos[1] = 0;  // All three, or the compiler takes none.
  body->ipos[2] = -0.7;
  body->inertia[0] = body->inertia[1] = body->inertia[2] = 1e-3;
  MjModel model = Compile(*spec, "pendulum");
  MjData data = MakeData(*model);
  data->qpos[0] = 0.02;
  int crossings = 0;
  double first_s = 0, last_s = 0, before = data->qpos[0];
  while (crossings < 11 && data->time < 20) {
    REQUIRE(Step(*model, *data, 1) == StepStatus::kOk);
    const double now = data->qpos[0];
    if (before * now < 0) {
      last_s = data->time - options.timestep_s * now / (now - before);
      if (crossings++ == 0) first_s = last_s;
    }
    before = now;
  }
  const double period_s = (last_s - first_s) / 5;
  const double length_m = 0.7 + 1e-3 / (0.5 * 0.7);  // Equivalent simple pendulum.
  const double kStepError = 1e-3;                    // Semi-implicit at 0.5 ms.
  CHECK(period_s == Approx(2 * kPi * std::sqrt(length_m / kGravity)).epsilon(kStepError));
}

TEST_CASE("A fatal engine error is an Error, the next scene works and no log file appears",
          "[unit]") {
  std::filesystem::remove("MUJOCO_LOG.TXT");
  InitEngine();
  CHECK_THROWS_MATCHES(GuardEngine([] { mju_error("made up %d", 7); }), Error,
                       Catch::Matchers::Message("MuJoCo: made up 7"));
  // Nested guards: the outer one is in force again after the inner failed.
  const auto nested = [] {
    try {
      GuardEngine([] { mju_error("inner"); });
    } catch (const Error&) {
    }
    GuardEngine([] { mju_error("outer"); });
  };
  CHECK_THROWS_MATCHES(nested(), Error, Catch::Matchers::Message("MuJoCo: outer"));
  MjSpec spec = MakeSpec();
  AddBall(spec, 1.0);
  MjModel model = Compile(*spec, "after an error");
  MjData data = MakeData(*model);
  CHECK(Step(*model, *data, 10) == StepStatus::kOk);
  CHECK_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST_CASE("A scene that does not compile says why", "[unit]") {
  MjSpec spec = MakeSpec();
  mjsBody* body = mjs_addBody(World(spec), nullptr);
  mjs_addFreeJoint(body);  // No mass.
  CHECK_THROWS_WITH(
      Compile(*spec, "massless"),
      Catch::Contains("massless: the scene does not compile:") && Catch::Contains("mass"));
}

TEST_CASE("A step that leaves the numbers says diverged and is not reset", "[unit]") {
  TakeEngineWarnings();
  MjSpec spec = MakeSpec();
  AddBall(spec, 1.0);
  MjModel model = Compile(*spec, "bad");
  MjData data = MakeData(*model);
  const Snapshot start(*model, *data);
  data->qvel[0] = 1e12;
  CHECK(Step(*model, *data, 5) == StepStatus::kDiverged);
  CHECK(std::abs(data->qvel[0]) > 1e9);
  CHECK_FALSE(TakeEngineWarnings().empty());
  start.Restore(*model, *data);
  CHECK(Step(*model, *data, 5) == StepStatus::kOk);
  CHECK(TakeEngineWarnings().empty());
}

TEST_CASE("A restored snapshot repeats bit by bit", "[unit]") {
  MjSpec spec = MakeSpec();
  mjsGeom* floor = mjs_addGeom(World(spec), nullptr);
  floor->type = mjGEOM_PLANE;
  floor->size[0] = floor->size[1] = floor->size[2] = 1;
  AddBall(spec, 0.12);
  MjModel model = Compile(*spec, "repeat");
  MjData data = MakeData(*model);
  data->qvel[0] = 0.3;
  data->qvel[4] = 5.0;
  REQUIRE(Step(*model, *data, 100) == StepStatus::kOk);
  const Snapshot middle(*model, *data);
  REQUIRE(Step(*model, *data, 200) == StepStatus::kOk);
  const std::vector<double> end(data->qpos, data->qpos + model->nq);
  middle.Restore(*model, *data);
  REQUIRE(Step(*model, *data, 200) == StepStatus::kOk);
  CHECK(end == std::vector<double>(data->qpos, data->qpos + model->nq));
}

}  // namespace
}  // namespace tubetwin

#include "scenes/rod/rod_frames.h"

#include <cmath>

#include "models/base/random.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/engine/stepping.h"
#include "scenes/tube_body.h"
#include "tests/support/catch.h"
#include "tests/support/clamp.h"

namespace tubetwin {
namespace {

Polyline Hook(double plane_rad) {
  Polyline line = {Vector3::Zero()};
  // The middle runs along x; the second hook's plane is turned about it.
  Vector3 direction = RotZ(-1.5) * Vector3::UnitX();
  const Vector3 second_axis = RotX(plane_rad) * Vector3::UnitY();
  for (int i = 0; i < 12; ++i) {
    line.push_back(line.back() + 0.04 * direction);
    if (i < 3) direction = RotZ(0.5) * direction;
    if (i >= 7) direction = Eigen::AngleAxisd(0.5, second_axis) * direction;
  }
  return line;
}

TEST_CASE("A rod that lies as without load is at rest in every joint", "[unit]") {
  const double kRounding_rad = 1e-6;
  RandomStream stream(1, 0, "rods");
  for (int k = 0; k < 10; ++k) {
    const Polyline rest = Hook(stream.Uniform(-kPi, kPi));
    const RigidTransform X = MakeTransform(
        RotZ(stream.Uniform(-3, 3)) * RotX(stream.Uniform(-3, 3)), Vector3(0.1, 0.2, 0.3));
    const RodFrames frames = LeastEnergyFrames(Transformed(X, rest), rest, {});
    for (std::size_t i = 1; i < frames.current.size(); ++i) {
      const RodJoint joint = JointBetween(frames.current[i - 1].transpose() * frames.current[i],
                                          frames.rest[i - 1].transpose() * frames.rest[i]);
      for (const double angle : joint.rest_rad) CHECK(std::abs(angle) < kRounding_rad);
    }
  }
}

TEST_CASE("Hooks turned against each other twist the rod between them", "[unit]") {
  const double turned_rad = 0.4;
  const RodFrames frames = LeastEnergyFrames(Hook(turned_rad), Hook(0.0), {0.15, 0.10});
  double twist_rad = 0.0;
  for (std::size_t i = 1; i < frames.current.size(); ++i) {
    twist_rad += JointBetween(frames.current[i - 1].transpose() * frames.current[i],
                              frames.rest[i - 1].transpose() * frames.rest[i])
                     .rest_rad[2];
  }
  // The hooks give way a little; the more the stiffer the rod is against torsion.
  CHECK(std::abs(twist_rad) > 0.5 * turned_rad);
  CHECK(std::abs(twist_rad) < turned_rad);
}

TEST_CASE("The turns found are those of least energy", "[unit]") {
  // Any other turns store more: a rod that may not twist shows all of it as bending.
  const Polyline rest = Hook(0.0), now = Hook(0.4);
  const auto bending = [&](double torsion_Nm2) {
    const RodFrames frames = LeastEnergyFrames(now, rest, {0.15, torsion_Nm2});
    double sum = 0.0, twist = 0.0;
    for (std::size_t i = 1; i < frames.current.size(); ++i) {
      const RodJoint joint = JointBetween(frames.current[i - 1].transpose() * frames.current[i],
                                          frames.rest[i - 1].transpose() * frames.rest[i]);
      sum += std::pow(joint.rest_rad[0], 2) + std::pow(joint.rest_rad[1], 2);
      twist += std::pow(joint.rest_rad[2], 2);
    }
    return std::array<double, 2>{sum, twist};
  };
  const auto soft = bending(1e-4), stiff = bending(10.0);
  CHECK(soft[0] < 0.01 * stiff[0]);
  CHECK(stiff[1] < 0.01 * soft[1]);
}

TEST_CASE("Stiffness against torsion and the first bending frequency are those of theory",
          "[unit]") {
  CHECK(TorsionalStiffness(0.15) == Approx(0.10));
  // Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1: lambda = 4.73004.
  CHECK(FirstFreeBending(0.15, 0.11, 0.4) ==
        Approx(4.73004 * 4.73004 / 0.16 * std::sqrt(0.15 / 0.275)));
}

// Deflection at the tip of a quarter circle that is clamped at its other end, out of its plane.
double QuarterCircleSag(int links, double radius_m, double load_N) {
  const double kClampedLink_m = 0.002;  // Its joint bends for half of the first free link.
  PileTube tube;
  tube.centerline_N.push_back({-kClampedLink_m, 0, 0});
  for (int i = 0; i <= links; ++i) {
    const double at = 0.5 * kPi * i / links;
    tube.centerline_N.push_back(radius_m * Vector3(std::sin(at), 1.0 - std::cos(at), 0.0));
  }
  tube.radius_m = 0.01;
  tube.mass_kg = 0.05;
  TubeBodyOptions options;
  options.hose = true;
  options.loss_factor = 1.0;
  MjSpec spec = MakeSpec();
  TubeBody body(*spec, "hose", tube, options);
  // A weld is the softer the lighter what it holds.
  mjsBody* clamped = mjs_findBody(spec.get(), body.body_names()[0].c_str());
  clamped->mass = 1.0;
  for (double& inertia : clamped->inertia) inertia = 0.01;
  test::ClampFirstLink(*spec, body);
  MjModel model = Compile(*spec, "quarter circle");
  for (double& g : model->opt.gravity) g = 0.0;
  body.Bind(*model);
  MjData data = MakeData(*model);
  const int last = body.bodies().back();
  const Vector3 load(0, 0, load_N);
  const Vector3 lever = tube.centerline_N.back() - Vector3(data->xipos + 3 * last);
  const Vector3 torque = lever.cross(load);
  for (int k = 0; k < 3; ++k) {
    data->xfrc_applied[6 * last + k] = load[k];
    data->xfrc_applied[6 * last + 3 + k] = torque[k];
  }
  REQUIRE(Step(*model, *data, 4000) == StepStatus::kOk);
  mj_forward(model.get(), data.get());
  return body.Centerline_N(*data).back().z();
}

TEST_CASE("A curved hose gives way out of its plane as a curved beam does", "[physics]") {
  // Timoshenko, Strength of Materials II: a quarter circle, clamped at one end, loaded across its
  // plane at the other: P R^3 (pi / (4 EI) + (3 pi / 4 - 2) / GJ).
  const double R = 0.08, P = 0.05, EI = 0.15;
  const double theory_m =
      P * R * R * R * (0.25 * kPi / EI + (0.75 * kPi - 2.0) / TorsionalStiffness(EI));
  const double kFewLinks = 0.10, kManyLinks = 0.03;
  CHECK(QuarterCircleSag(4, R, P) == Approx(theory_m).epsilon(kFewLinks));
  CHECK(QuarterCircleSag(16, R, P) == Approx(theory_m).epsilon(kManyLinks));
}

}  // namespace
}  // namespace tubetwin

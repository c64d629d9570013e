#include <cmath>
#include <memory>
#include <string>

#include "scenes/arrange.h"
#include "scenes/engine/stepping.h"
#include "scenes/pile_scene.h"

namespace tubetwin::arrange {
namespace {

constexpr double kDropGap_m = 0.025;  // Lowest point over the pile's top at release.
constexpr double kDropEvery_s = 0.35;
constexpr double kSpread = 0.34;  // Of the half sides: 0.13 x 0.09 m in the paper's bin.
constexpr int kPoses = 60;
constexpr double kLimit_s = 20.0;

// A pose inside the walls, the nearer to the bin's middle the harder it is to find one; its lowest
// point at height 0.
RigidTransform DrawPose(const Order& order, const Polyline& shape, RandomStream& stream) {
  const bool hose = order.part.is_hose();
  const double tilt_deg = hose ? 30.0 : 15.0, r = order.part.radius_m;
  const bool flips = !hose && order.part.shape == "arcs";  // Planar shapes lie on a face.
  RigidTransform X_NShape;
  for (int i = 0; i < kPoses; ++i) {
    const double spread = kSpread * (1.0 - static_cast<double>(i) / kPoses);
    const double yaw = stream.Uniform(0.0, 2 * kPi);
    const double tilt = Radians(stream.Uniform(-tilt_deg, tilt_deg));
    const double roll = stream.Uniform(0.0, 2 * kPi);
    const double x = stream.Uniform(-spread, spread) * order.bin.half_x_m();
    const double y = stream.Uniform(-spread, spread) * order.bin.half_y_m();
    X_NShape = MakeTransform(RotZ(yaw) * RotY(tilt) * RotX(flips ? (roll < kPi ? 0.0 : kPi) : roll),
                             Vector3(x, y, 0.0));
    bool inside = true;
    double lowest = 1e9;
    for (const Vector3& p : Transformed(X_NShape, shape)) {
      inside = inside && std::abs(p.x()) < order.bin.half_x_m() - r &&
               std::abs(p.y()) < order.bin.half_y_m() - r;
      lowest = std::min(lowest, p.z() - r);
    }
    X_NShape.translation().z() = -lowest;
    if (inside) break;
  }
  return X_NShape;
}

SettleResult Diverged(const PileScene& scene, const char* what) {
  SettleResult result;
  result.status = SettleStatus::kDiverged;
  result.reason = std::string("while dropping, the physics engine reports ") + what;
  result.pile = scene.Current();
  result.simulated_s = scene.data().time;
  return result;
}

}  // namespace

SettleResult Drop(const Order& order, RandomStream stream) {
  Pile pile = EmptyPile(order);
  std::unique_ptr<PileScene> scene;
  for (int i = 0; i < order.count; ++i) {
    const Part part = SpecimenPart(order, i + 1);
    const Polyline shape = DrawShape(part, stream);
    RigidTransform X_NShape = DrawPose(order, shape, stream);
    X_NShape.translation().z() += kDropGap_m + (scene ? scene->Top() : 0.0);
    pile.tubes.push_back(MakeTube(part, i + 1, shape, X_NShape));
    // A new scene with one tube more; those before keep their motion.
    auto next = std::make_unique<PileScene>(pile, order.physics);
    if (scene) next->CopyStateOfFirst(*scene);
    scene = std::move(next);
    const int steps = static_cast<int>(std::lround(kDropEvery_s / scene->model().opt.timestep));
    const StepStatus status = Step(scene->model(), scene->data(), steps);
    if (status != StepStatus::kOk) return Diverged(*scene, ToString(status));
    scene->Refresh();
  }
  const double dropped_s = scene->data().time;
  SettleResult result = StepUntilSettled(*scene, kLimit_s);
  result.simulated_s += dropped_s;
  return result;
}

}  // namespace tubetwin::arrange

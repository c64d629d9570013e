#include <cmath>

#include "models/base/error.h"
#include "scenes/engine/stepping.h"
#include "scenes/pile.h"
#include "scenes/pile_scene.h"

namespace tubetwin {
namespace {

constexpr double kLimit_s = 20.0;
// Overlaps of the input (about 1 mm in the public set) are let apart with soft contacts and with
// velocities that die away, so that nothing is thrown.
constexpr double kSoftContact_s = 0.02, kSoftPhase_s = 0.3, kVelocityDecay_s = 0.03;

void SetContactTime(mjModel& model, double time_s) {
  for (int geom = 0; geom < model.ngeom; ++geom) model.geom_solref[geom * mjNREF] = time_s;
}

StepStatus LetApart(PileScene& scene) {
  mjModel& model = scene.model();
  mjData& data = scene.data();
  const double contact_s = model.geom_solref[0];
  SetContactTime(model, kSoftContact_s);
  const double keep = std::exp(-model.opt.timestep / kVelocityDecay_s);
  const int steps = static_cast<int>(std::lround(kSoftPhase_s / model.opt.timestep));
  StepStatus status = StepStatus::kOk;
  for (int i = 0; i < steps && status == StepStatus::kOk; ++i) {
    status = Step(model, data, 1);
    for (int dof = 0; dof < model.nv; ++dof) data.qvel[dof] *= keep;
  }
  SetContactTime(model, contact_s);
  return status;
}

}  // namespace

const char* ToString(SettleStatus status) {
  switch (status) {
    case SettleStatus::kSettled:
      return "settled";
    case SettleStatus::kTimeout:
      return "timeout";
    case SettleStatus::kEscaped:
      return "escaped";
    case SettleStatus::kDiverged:
      return "diverged";
  }
  return "?";
}

SettleResult SettlePile(const Pile& pile, const RoundPhysics& physics) {
  ValidatePile(pile, "pile");
  PileScene scene(pile, physics);
  const StepStatus status = LetApart(scene);
  if (status != StepStatus::kOk) {
    SettleResult result;
    result.status = SettleStatus::kDiverged;
    result.reason =
        std::string("while letting overlaps apart, the physics engine reports ") + ToString(status);
    result.pile = pile;
    result.pile.settled = false;
    result.simulated_s = scene.data().time;
    return result;
  }
  SettleResult result = StepUntilSettled(scene, kLimit_s - kSoftPhase_s);
  result.simulated_s += kSoftPhase_s;
  return result;
}

}  // namespace tubetwin

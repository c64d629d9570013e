#include "twin/cell/twin_gripper.h"

#include <algorithm>
#include <cmath>

#include "models/base/json.h"
#include "models/base/json_text.h"
#include "scenes/engine/mj_handles.h"
#include "twin/cell/gripper_body.h"

namespace tubetwin {
namespace {

constexpr double kStillSpeed_m_s = 0.002;  ///< Slower than this is standing, of the opening.
constexpr int kStillSamples = 30;          ///< 30 ms.
constexpr double kAtPosition_m = 0.0008;   ///< Two counts.
/// Fingers that move on by this much have lost what they held.
constexpr double kLost_m = 0.001;
/// The servo's lead that saturates the force with margin.
constexpr double kSaturation = 1.3;

/// The step nearest to a value between the ends, back as the value it stands for.
double AsStep(double value, double low, double high, int steps) {
  const double share = (std::clamp(value, low, high) - low) / (high - low);
  return low + (high - low) * std::round(share * steps) / steps;
}

double QuantisedOpening(double opening_m, const GripperSpec& spec) {
  const double counts = spec.opening_counts;
  const double count = std::round(std::clamp(opening_m / spec.stroke_m, 0.0, 1.0) * counts);
  return spec.stroke_m * count / counts;
}

}  // namespace

TwinGripper::TwinGripper(CellWorld& world)
    : world_(world),
      spec_(world.gripper()),
      model_(world.model()),
      data_(world.data()),
      tendon_(IdOf(model_, mjOBJ_TENDON, kGripActuator)),
      actuator_(IdOf(model_, mjOBJ_ACTUATOR, kGripActuator)),
      force_N_(spec_.min_force_N) {
  target_m_ = reference_m_ = Travel();
}

double TwinGripper::Travel() const { return data_.ten_length[tendon_]; }

double TwinGripper::TrueOpening() const { return spec_.stroke_m - Travel(); }

void TwinGripper::Command(const GripperCommand& command) {
  target_m_ = spec_.stroke_m - QuantisedOpening(command.opening_m, spec_);
  speed_m_s_ =
      AsStep(command.speed_m_s, spec_.min_speed_m_s, spec_.max_speed_m_s, spec_.command_counts);
  force_N_ = AsStep(command.force_N, spec_.min_force_N, spec_.max_force_N, spec_.command_counts);
  SetForceRange();
  MoveOn();
}

void TwinGripper::SetForceRange() {
  model_.actuator_forcerange[2 * actuator_] = -force_N_;
  model_.actuator_forcerange[2 * actuator_ + 1] = force_N_;
}

Json TwinGripper::StoredState() const {
  return Json{{"phase", static_cast<int>(phase_)},
              {"target_m", target_m_},
              {"reference_m", reference_m_},
              {"speed_m_s", speed_m_s_},
              {"force_N", force_N_},
              {"contact_m", contact_m_},
              {"still", still_}};
}

void TwinGripper::Restore(const JsonView& state) {
  const JsonView phase = state.Field("phase");
  constexpr double kWidest_m = 1.0, kFastest_m_s = 10.0, kStrongest_N = 1e4;
  phase_ = static_cast<Phase>(IntegerIn(phase, 0, static_cast<int>(Phase::kAtPosition)));
  target_m_ = state.Field("target_m").AsNumber(-kWidest_m, kWidest_m);
  reference_m_ = state.Field("reference_m").AsNumber(-kWidest_m, kWidest_m);
  speed_m_s_ = state.Field("speed_m_s").AsNumber(0.0, kFastest_m_s);
  force_N_ = state.Field("force_N").AsNumber(0.0, kStrongest_N);
  contact_m_ = state.Field("contact_m").AsNumber(-kWidest_m, kWidest_m);
  still_ = CountFromJson(state.Field("still"));
  SetForceRange();
}

GripperState TwinGripper::State() const {
  GripperState state;
  state.time = world_.now();
  state.opening_m = QuantisedOpening(TrueOpening(), spec_);
  state.requested_m = spec_.stroke_m - target_m_;
  switch (phase_) {
    case Phase::kMoving:
    case Phase::kPressing:
      state.object = GripperObject::kMoving;
      break;
    case Phase::kContact:
      state.object =
          contact_m_ < target_m_ ? GripperObject::kContactClosing : GripperObject::kContactOpening;
      break;
    case Phase::kAtPosition:
      state.object = GripperObject::kAtPosition;
      break;
  }
  return state;
}

void TwinGripper::MoveOn() {
  phase_ = Phase::kMoving;
  reference_m_ = Travel();
  still_ = 0;
}

void TwinGripper::Control() {
  const double step_m = speed_m_s_ * model_.opt.timestep;
  const double travel_m = Travel();
  const double missing_m = target_m_ - travel_m;
  still_ = std::abs(data_.ten_velocity[tendon_]) < kStillSpeed_m_s ? still_ + 1 : 0;
  const double lead_m = kSaturation * force_N_ / kGripStiffness_N_m;
  const double toward = missing_m < 0.0 ? -1.0 : 1.0;

  switch (phase_) {
    case Phase::kMoving:
      reference_m_ += std::clamp(target_m_ - reference_m_, -step_m, step_m);
      reference_m_ = std::clamp(reference_m_, travel_m - lead_m, travel_m + lead_m);
      if (still_ < kStillSamples) break;
      if (std::abs(missing_m) <= kAtPosition_m) {
        phase_ = Phase::kAtPosition;
      } else {
        phase_ = Phase::kPressing;
        contact_m_ = travel_m;
      }
      break;
    case Phase::kPressing:
    case Phase::kContact:
      // Something is in the way: the motor pulls on up to the set force.
      if ((travel_m - contact_m_) * toward > kLost_m) {
        MoveOn();
        break;
      }
      reference_m_ += toward * step_m;
      if ((reference_m_ - travel_m) * toward >= lead_m) {
        reference_m_ = travel_m + toward * lead_m;
        if (still_ >= kStillSamples) phase_ = Phase::kContact;
      }
      break;
    case Phase::kAtPosition:
      reference_m_ = target_m_;
      // What stood at its request and was pushed off it drives back.
      if (std::abs(missing_m) > 2 * kAtPosition_m) MoveOn();
      break;
  }
  data_.ctrl[actuator_] = reference_m_;
}

}  // namespace tubetwin

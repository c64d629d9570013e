#include "twin/cell/twin_wrist.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "models/base/json.h"
#include "scenes/engine/mj_handles.h"
#include "twin/cell/arm_body.h"

namespace tubetwin {
namespace {

// Data sheet, Fx Fy Fz Tx Ty Tz: largest reading and one count.
constexpr std::array<double, 6> kRange = {65.0, 65.0, 200.0, 5.0, 5.0, 5.0};
constexpr double kForceCountXy_N = 1.0 / 80.0;
constexpr double kForceCountZ_N = 1.0 / 40.0;
constexpr double kTorqueCount_Nm = 10.0 / 13333.0;
constexpr std::array<double, 6> kCount = {kForceCountXy_N, kForceCountXy_N, kForceCountZ_N,
                                          kTorqueCount_Nm, kTorqueCount_Nm, kTorqueCount_Nm};

/// One of the low-pass corners that the sensor's box offers.
constexpr double kCorner_Hz = 73.0;
/// The bias walk of the round's physics is given for this time.
constexpr double kWalkTime_s = 600.0;

}  // namespace

WrenchChain::WrenchChain(const RoundPhysics& physics, RandomStream stream)
    : stream_(stream.Fork("samples")), noise_counts_(physics.wrench_noise_counts) {
  // The walk is given for z in newtons; other axes drift by as many counts.
  const double samples = kWalkTime_s / Seconds(kControlPeriod);
  walk_counts_ = physics.wrench_bias_walk_N / kForceCountZ_N / std::sqrt(samples);
  cross_talk_.setIdentity();
  RandomStream talk = stream.Fork("cross-talk");
  for (int to = 0; to < 6; ++to) {
    for (int from = 0; from < 6; ++from) {
      // Shares of full scale: a full reading of one axis shows as this share of another's.
      const double share = talk.Uniform(-physics.wrench_cross_talk, physics.wrench_cross_talk);
      if (to != from) cross_talk_(to, from) = share * kRange[to] / kRange[from];
    }
  }
}

WrenchSample WrenchChain::Next(const Wrench& load_K, TimeNs time) {
  Vector6 load;
  load << load_K.force_N, load_K.torque_Nm;
  const Vector6 mixed = cross_talk_ * load;
  const double share = 1.0 - std::exp(-2.0 * kPi * kCorner_Hz * Seconds(kControlPeriod));
  filtered_ = first_ ? mixed : Vector6(filtered_ + share * (mixed - filtered_));
  first_ = false;

  WrenchSample sample;
  sample.time = time;
  Vector6 reading;
  for (int i = 0; i < 6; ++i) {
    bias_[i] += stream_.Normal(0.0, walk_counts_ * kCount[i]);
    const double noisy = filtered_[i] + bias_[i] + stream_.Normal(0.0, noise_counts_ * kCount[i]);
    sample.saturated = sample.saturated || std::abs(noisy) > kRange[i];
    const double counts = std::round(noisy / kCount[i]);
    const double max_counts = std::floor(kRange[i] / kCount[i] + 1e-9);
    reading[i] = kCount[i] * std::clamp(counts, -max_counts, max_counts);
  }
  sample.wrench_K.force_N = reading.head<3>();
  sample.wrench_K.torque_Nm = reading.tail<3>();
  return sample;
}

Json WrenchChain::StoredState() const {
  return Json{{"filtered", std::vector<double>(filtered_.begin(), filtered_.end())},
              {"bias", std::vector<double>(bias_.begin(), bias_.end())},
              {"drawn", stream_.drawn()}};
}

void WrenchChain::Restore(const JsonView& state) {
  const auto read = [&](const char* name, Vector6& out) {
    const JsonView field = state.Field(name);
    if (field.Size() != 6) field.Fail("six numbers are needed");
    const std::vector<double> numbers = field.AsNumbers();
    std::copy(numbers.begin(), numbers.end(), out.begin());
  };
  read("filtered", filtered_);
  read("bias", bias_);
  stream_ = stream_.After(static_cast<std::uint64_t>(state.Field("drawn").AsInteger()));
  first_ = false;
}

TwinWrist::TwinWrist(const CellWorld& world, const RoundPhysics& physics, RandomStream stream)
    : world_(world),
      data_(world.data()),
      force_(world.model().sensor_adr[IdOf(world.model(), mjOBJ_SENSOR, kWristForce)]),
      torque_(world.model().sensor_adr[IdOf(world.model(), mjOBJ_SENSOR, kWristTorque)]),
      chain_(physics, stream) {}

Wrench TwinWrist::TrueLoad() const {
  return {-Vector3(data_.sensordata + force_), -Vector3(data_.sensordata + torque_)};
}

Json TwinWrist::StoredState() const {
  Json state = chain_.StoredState();
  state["newest"] = Json{{"time_ns", newest_.time.count()},
                         {"force_N", ToJson(newest_.wrench_K.force_N)},
                         {"torque_Nm", ToJson(newest_.wrench_K.torque_Nm)},
                         {"saturated", newest_.saturated}};
  return state;
}

void TwinWrist::Restore(const JsonView& state) {
  chain_.Restore(state);
  const JsonView newest = state.Field("newest");
  newest_.time = TimeNs(newest.Field("time_ns").AsInteger());
  newest_.wrench_K.force_N = newest.Field("force_N").AsVector3();
  newest_.wrench_K.torque_Nm = newest.Field("torque_Nm").AsVector3();
  newest_.saturated = newest.Field("saturated").AsBool();
}

void TwinWrist::Sample() { newest_ = chain_.Next(TrueLoad(), world_.now()); }

}  // namespace tubetwin

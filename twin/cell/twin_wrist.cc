#include "twin/cell/twin_wrist.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "models/base/json.h"
#include "models/base/json_text.h"
#include "scenes/engine/mj_handles.h"
#include "twin/cell/arm_body.h"

namespace tubetwin {
namespace {

constexpr int kFz = 2;
/// The bias walk of the round's physics is given for this time.
constexpr double kWalkTime_s = 600.0;
constexpr double kLargestLoad = 1e6;  // N and N m: of a stored state, beyond any sensor.

}  // namespace

WrenchChain::WrenchChain(const WristSpec& spec, const RoundPhysics& physics, RandomStream stream)
    : spec_(spec), stream_(stream.Fork("samples")), noise_counts_(physics.wrench_noise_counts) {
  // The walk is given for z in newtons; other axes drift by as many counts.
  const double samples = kWalkTime_s / Seconds(kControlPeriod);
  walk_counts_ = physics.wrench_bias_walk_N / spec_.count[kFz] / std::sqrt(samples);
  cross_talk_.setIdentity();
  RandomStream talk = stream.Fork("cross-talk");
  for (int to = 0; to < 6; ++to) {
    for (int from = 0; from < 6; ++from) {
      // Shares of full scale: a full reading of one axis shows as this share of another's.
      const double share = talk.Uniform(-physics.wrench_cross_talk, physics.wrench_cross_talk);
      if (to != from) cross_talk_(to, from) = share * spec_.range[to] / spec_.range[from];
    }
  }
}

WrenchSample WrenchChain::Next(const Wrench& load_K, TimeNs time) {
  Vector6 load;
  load << load_K.force_N, load_K.torque_Nm;
  const Vector6 mixed = cross_talk_ * load;
  const double share = 1.0 - std::exp(-2.0 * kPi * spec_.corner_Hz * Seconds(kControlPeriod));
  filtered_ = first_ ? mixed : Vector6(filtered_ + share * (mixed - filtered_));
  first_ = false;

  WrenchSample sample;
  sample.time = time;
  Vector6 reading;
  for (int i = 0; i < 6; ++i) {
    bias_[i] += stream_.Normal(0.0, walk_counts_ * spec_.count[i]);
    const double noisy =
        filtered_[i] + bias_[i] + stream_.Normal(0.0, noise_counts_ * spec_.count[i]);
    sample.saturated = sample.saturated || std::abs(noisy) > spec_.range[i];
    const double counts = std::round(noisy / spec_.count[i]);
    const double max_counts = std::floor(spec_.range[i] / spec_.count[i] + 1e-9);
    reading[i] = spec_.count[i] * std::clamp(counts, -max_counts, max_counts);
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
    for (std::size_t i = 0; i < 6; ++i) {
      out[static_cast<Eigen::Index>(i)] = field.Item(i).AsNumber(-kLargestLoad, kLargestLoad);
    }
  };
  read("filtered", filtered_);
  read("bias", bias_);
  const JsonView drawn = state.Field("drawn");
  drawn.AsNumber(0.0, 1e15);
  stream_ = stream_.After(static_cast<std::uint64_t>(drawn.AsInteger()));
  first_ = false;
}

TwinWrist::TwinWrist(const WristSpec& spec, const CellWorld& world, const RoundPhysics& physics,
                     RandomStream stream)
    : world_(world),
      data_(world.data()),
      force_(world.model().sensor_adr[IdOf(world.model(), mjOBJ_SENSOR, kWristForce)]),
      torque_(world.model().sensor_adr[IdOf(world.model(), mjOBJ_SENSOR, kWristTorque)]),
      chain_(spec, physics, stream) {}

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
  const JsonView time = newest.Field("time_ns");
  time.AsNumber(0.0, static_cast<double>(world_.now().count()));
  newest_.time = TimeNs(time.AsInteger());
  for (const char* name : {"force_N", "torque_Nm"}) {
    const JsonView load = newest.Field(name);
    for (std::size_t k = 0; k < load.Size(); ++k)
      load.Item(k).AsNumber(-kLargestLoad, kLargestLoad);
  }
  newest_.wrench_K.force_N = newest.Field("force_N").AsVector3();
  newest_.wrench_K.torque_Nm = newest.Field("torque_Nm").AsVector3();
  newest_.saturated = newest.Field("saturated").AsBool();
}

void TwinWrist::Sample() { newest_ = chain_.Next(TrueLoad(), world_.now()); }

}  // namespace tubetwin

#include "scenes/pile_scene.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"
#include "scenes/bin_body.h"
#include "scenes/engine/engine_error.h"
#include "scenes/engine/stepping.h"

namespace tubetwin {
namespace {

constexpr double kGroundBelowFloor_m = 0.1;
constexpr double kRestSpeed_m_s = 0.005;  // Soft friction creeps below a tenth of this.
constexpr double kRestTime_s = 0.25, kCheckEvery_s = 0.05;
constexpr double kFallen_m = -0.03;  // Centre of mass below the floor's lower face.

}  // namespace

PileSpec MakePileSpec(const Pile& pile, const RoundPhysics& physics, const EngineOptions& engine) {
  PileSpec out{MakeSpec(engine), {}};
  BinBodyOptions bin;
  bin.friction = physics.bin_friction;
  AddBin(*out.spec, pile.bin, bin);
  AddGround(*out.spec, Translation(0, 0, -kGroundBelowFloor_m), bin);
  for (const PileTube& tube : pile.tubes) {
    out.tubes.emplace_back(
        *out.spec, "tube" + std::to_string(tube.id), tube,
        MakeTubeBodyOptions(pile.part, physics, RigidTransform::Identity(), tube.id));
  }
  return out;
}

PileScene::PileScene(const Pile& pile, const RoundPhysics& physics, const EngineOptions& engine)
    : PileScene(MakePileSpec(pile, physics, engine), pile, "pile") {}

PileScene::PileScene(PileSpec parts, const Pile& pile, const std::string& what)
    : model_(Compile(*parts.spec, what)),
      data_(MakeData(*model_)),
      tubes_(std::move(parts.tubes)),
      pile_(pile) {
  for (TubeBody& tube : tubes_) tube.Bind(*model_);
}

void PileScene::Refresh() {
  GuardEngine([this] { mj_forward(model_.get(), data_.get()); });
}

Pile PileScene::Current() const {
  Pile pile = pile_;
  for (std::size_t i = 0; i < tubes_.size(); ++i) pile.tubes[i] = tubes_[i].Current(*data_);
  pile.settled = false;
  return pile;
}

double PileScene::MaxSpeed() const {
  double fastest = 0.0;
  for (const TubeBody& tube : tubes_) fastest = std::max(fastest, tube.MaxSpeed(*model_, *data_));
  return fastest;
}

double PileScene::Top() const {
  double top = 0.0;
  for (const TubeBody& tube : tubes_) {
    for (const Vector3& node : tube.Centerline_N(*data_)) {
      top = std::max(top, node.z() + tube.initial().radius_m);
    }
  }
  return top;
}

void PileScene::CopyStateOfFirst(const PileScene& other) {
  const mjModel& from = other.model();
  TT_CHECK(from.nq <= model_->nq && from.nv <= model_->nv);
  std::copy_n(other.data().qpos, from.nq, data_->qpos);
  std::copy_n(other.data().qvel, from.nv, data_->qvel);
  std::copy_n(other.data().qacc_warmstart, from.nv, data_->qacc_warmstart);
  data_->time = other.data().time;
}

Place PlaceOf(const PileTube& tube, const Bin& bin) {
  const auto beyond = [&bin](const Vector3& p) {
    return std::abs(p.x()) > bin.half_x_m() || std::abs(p.y()) > bin.half_y_m();
  };
  const Vector3 centre = CurveCentre(tube.centerline_N);
  if (beyond(centre) || centre.z() < kFallen_m) return Place::kOutside;
  const bool overhangs = std::any_of(tube.centerline_N.begin(), tube.centerline_N.end(), beyond);
  return overhangs ? Place::kOverhangs : Place::kInside;
}

SettleResult StepUntilSettled(PileScene& scene, double limit_s) {
  const double dt = scene.model().opt.timestep;
  const int steps = static_cast<int>(std::lround(kCheckEvery_s / dt));
  const int needed = static_cast<int>(std::lround(kRestTime_s / kCheckEvery_s));
  const double start_s = scene.data().time;
  SettleResult result;
  int calm = 0;
  double speed = 0.0;
  while (calm < needed && scene.data().time - start_s < limit_s) {
    const StepStatus status = Step(scene.model(), scene.data(), steps);
    if (status != StepStatus::kOk) {
      result.status = SettleStatus::kDiverged;
      result.reason = std::string("the physics engine reports ") + ToString(status);
      break;
    }
    scene.Refresh();
    speed = scene.MaxSpeed();
    calm = speed < kRestSpeed_m_s ? calm + 1 : 0;
  }
  result.simulated_s = scene.data().time - start_s;
  result.pile = scene.Current();
  if (result.status == SettleStatus::kDiverged) return result;
  for (const PileTube& tube : result.pile.tubes) {
    if (PlaceOf(tube, result.pile.bin) != Place::kOutside) continue;
    result.status = SettleStatus::kEscaped;
    result.reason =
        "tube " + std::to_string(tube.id) + " lies outside the bin or hangs over a wall";
    return result;
  }
  if (calm < needed) {
    result.status = SettleStatus::kTimeout;
    result.reason = "something still moves at " + Number(std::round(speed * 1e4) / 1e4) +
                    " m/s after " + Number(limit_s) + " s";
    return result;
  }
  result.pile.settled = true;
  return result;
}

}  // namespace tubetwin

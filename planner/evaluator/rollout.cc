#include "planner/evaluator/rollout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"
#include "scenes/engine/engine_error.h"

namespace tubetwin {
namespace {

using Status = CandidateScore::Status;

constexpr double kRamp_s = 0.15;
constexpr double kSaturated = 0.99;       // Of the hand's force limit.
constexpr double kRaised_m = 0.03;        // A tube that was over the rim before did not come along.
constexpr double kOthersRest_m_s = 0.02;  // What they still do then is below 1 mm.
constexpr double kRides_m_s = 0.01;       // A tube that slips less on what lifts it is carried,
constexpr int kRidingLooks = 3;           // when it is seen so often in a row.
constexpr int kLookEvery = 10;            // Steps between looks for an early end.
constexpr double kBeads_m = 0.01;         // Between points of an axis that are compared.
constexpr double kNeverDown_m = std::numeric_limits<double>::infinity();
constexpr double kLevel_m = 0.005;  // A tube that is lower by this is passed already.

struct HeightRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

// Of all capsules of a tube, surfaces included.
HeightRange Heights(const mjModel& model, const mjData& data, const TubeBody& tube) {
  HeightRange range;
  for (const int geom : tube.geoms()) {
    const double reach = model.geom_size[3 * geom] +
                         model.geom_size[3 * geom + 1] * std::abs(data.geom_xmat[9 * geom + 8]);
    range.low = std::min(range.low, data.geom_xpos[3 * geom + 2] - reach);
    range.high = std::max(range.high, data.geom_xpos[3 * geom + 2] + reach);
  }
  return range;
}

// Points along a tube's axis, at most kBeads_m apart.
std::vector<Vector3> Beads(const mjModel& model, const mjData& data, const TubeBody& tube) {
  std::vector<Vector3> beads;
  for (const int geom : tube.geoms()) {
    const mjtNum* p = data.geom_xpos + 3 * geom;
    const mjtNum* R = data.geom_xmat + 9 * geom;
    const Vector3 centre(p[0], p[1], p[2]), axis(R[2], R[5], R[8]);
    const double half_m = model.geom_size[3 * geom + 1];
    const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * half_m / kBeads_m)));
    for (int k = 0; k <= steps; ++k) {
      beads.push_back(centre + (2.0 * k / steps - 1.0) * half_m * axis);
    }
  }
  return beads;
}

// Whether some point of `other` is in the way of a tube that goes straight up.
bool IsOver(const std::vector<Vector3>& other, const std::vector<Vector3>& rising, double reach_m) {
  for (const Vector3& o : other) {
    for (const Vector3& p : rising) {
      if (o.z() > p.z() - kLevel_m && (o - p).head<2>().squaredNorm() < reach_m * reach_m) {
        return true;
      }
    }
  }
  return false;
}

// The lifted tube and those that it carries straight up, as far as it is sure that they stay on it.
class Lifted {
 public:
  Lifted(const RolloutScene& scene, int index)
      : scene_(scene), index_(index), looks_(scene.tubes().size(), 0) {}

  bool Carries(int i) const { return looks_[i] >= kRidingLooks; }

  /// One more look at the other tubes, while the hand moves at `v_N`.
  void Look(const Vector3& v_N, bool only_rises, const mjModel& model, const mjData& data) {
    for (int i = 0; i < Count(); ++i) {
      const bool rides = i != index_ && only_rises && v_N.z() > kOthersRest_m_s &&
                         scene_.tubes()[i].MaxSpeed(model, data, v_N) < kRides_m_s;
      looks_[i] = rides ? looks_[i] + 1 : 0;
    }
  }

  /// All others are carried or at rest, and the load is a radius over those at rest or, where it
  /// only rises from here on, none of them is within a radius of its way.
  /// `lowest_m`: as low as it comes down again later.
  bool TouchesNothingMore(bool only_rises, double lowest_m, const mjModel& model,
                          const mjData& data) const {
    std::vector<Vector3> beads;
    double low = lowest_m;
    for (int i = 0; i < Count(); ++i) {
      if (i == index_ || Carries(i)) {
        low = std::min(low, Heights(model, data, scene_.tubes()[i]).low);
      } else if (!(scene_.tubes()[i].MaxSpeed(model, data) < kOthersRest_m_s)) {
        return false;
      }
    }
    for (int i = 0; i < Count(); ++i) {
      if (i == index_ || Carries(i)) continue;
      if (Heights(model, data, scene_.tubes()[i]).high + scene_.radius_m(i) <= low) continue;
      if (!only_rises) return false;
      if (beads.empty()) beads = BeadsOfAll(model, data);
      const double reach_m = scene_.radius_m(index_) + 2.0 * scene_.radius_m(i);
      if (IsOver(Beads(model, data, scene_.tubes()[i]), beads, reach_m)) return false;
    }
    return true;
  }

 private:
  int Count() const { return static_cast<int>(looks_.size()); }

  std::vector<Vector3> BeadsOfAll(const mjModel& model, const mjData& data) const {
    std::vector<Vector3> all;
    for (int i = 0; i < Count(); ++i) {
      if (i != index_ && !Carries(i)) continue;
      const std::vector<Vector3> beads = Beads(model, data, scene_.tubes()[i]);
      all.insert(all.end(), beads.begin(), beads.end());
    }
    return all;
  }

  const RolloutScene& scene_;
  const int index_;
  std::vector<int> looks_;  // In a row, in which it was carried.
};

struct Disturbance {
  double displacement_m = 0.0;
  bool extra = false;
};

// Beyond the walls.
bool IsOff(const Vector3& p_N, const Bin& bin) {
  return std::abs(p_N.x()) > bin.half_x_m() || std::abs(p_N.y()) > bin.half_y_m();
}

// What the others have done in the first `sim_s` seconds, those that are carried `rise_m` higher.
Disturbance Measure(const RolloutScene& scene, int index, double sim_s, const mjModel& model,
                    const mjData& data, const Lifted& lifted, double rise_m = 0.0) {
  Disturbance out;
  for (int i = 0; i < static_cast<int>(scene.tubes().size()); ++i) {
    if (i == index) continue;
    Vector3 centre = scene.tubes()[i].CentreOfMass_W(model, data);
    if (lifted.Carries(i)) centre.z() += rise_m;
    const Vector3& before = scene.centres_N()[i];
    const double creep_m = scene.creep_m_s()[i] * sim_s;
    out.displacement_m += std::max(0.0, (centre - before).norm() - creep_m);
    const Bin& bin = scene.bin();
    if (centre.z() > std::max(bin.wall_m(), before.z() + kRaised_m)) out.extra = true;
    if (IsOff(centre, bin) && !IsOff(before, bin)) out.extra = true;
  }
  return out;
}

// How low a tube comes where the way turns it, as far as it keeps its shape; infinite where the way
// does not.
double LowestTurned(const TubeBody& tube, const ObjectPath& way) {
  double low = kNeverDown_m;
  for (std::size_t k = 0; k < way.rotations_N.size(); ++k) {
    if (!IsTurnedOver(way.rotations_N[k])) continue;
    for (const Vector3& p : Transformed(PoseAt(way, k), tube.initial().centerline_N)) {
      low = std::min(low, p.z() - tube.initial().radius_m);
    }
  }
  return low;
}

}  // namespace

LegProfile::LegProfile(std::vector<Vector3> waypoints, double speed_m_s,
                       std::vector<Eigen::Quaterniond> turns, double turn_speed_rad_s)
    : waypoints_(std::move(waypoints)), turns_(std::move(turns)) {
  TT_CHECK(!waypoints_.empty() && speed_m_s > 0.0 && turn_speed_rad_s > 0.0);
  TT_CHECK(turns_.empty() || turns_.size() == waypoints_.size());
  double end_s = 0.0;
  for (std::size_t k = 1; k < waypoints_.size(); ++k) {
    double length_m = (waypoints_[k] - waypoints_[k - 1]).norm();
    if (!turns_.empty()) {
      const double angle = turns_[k - 1].angularDistance(turns_[k]);
      length_m = std::max(length_m, angle / turn_speed_rad_s * speed_m_s);
    }
    const double speed = std::min(speed_m_s, length_m / kRamp_s);
    if (length_m > 0.0) end_s += length_m / speed + kRamp_s;
    end_s_.push_back(end_s);
    length_m_.push_back(length_m);
    speed_m_s_.push_back(speed);
  }
}

LegProfile::Place LegProfile::PlaceAt(double time_s) const {
  std::size_t leg = 0;
  while (leg < end_s_.size() && time_s >= end_s_[leg]) ++leg;
  if (leg == end_s_.size()) return {leg, 0.0};
  const double begin_s = leg == 0 ? 0.0 : end_s_[leg - 1];
  const double duration_s = end_s_[leg] - begin_s, t = std::max(0.0, time_s - begin_s);
  // Distance after a time from rest: half-cosine ramp of the speed, then constant speed.
  const auto from_rest = [&](double time) {
    if (time >= kRamp_s) return speed_m_s_[leg] * (time - 0.5 * kRamp_s);
    return 0.5 * speed_m_s_[leg] * (time - kRamp_s / kPi * std::sin(kPi * time / kRamp_s));
  };
  const double travelled =
      t < 0.5 * duration_s ? from_rest(t) : length_m_[leg] - from_rest(duration_s - t);
  return {leg, travelled / length_m_[leg]};
}

Vector3 LegProfile::At(double time_s) const {
  const auto [leg, share] = PlaceAt(time_s);
  if (leg == end_s_.size()) return waypoints_.back();
  const Vector3 way = waypoints_[leg + 1] - waypoints_[leg];
  return waypoints_[leg] + way * share;
}

Eigen::Quaterniond LegProfile::TurnAt(double time_s) const {
  if (turns_.empty()) return Eigen::Quaterniond::Identity();
  const auto [leg, share] = PlaceAt(time_s);
  if (leg == end_s_.size()) return turns_.back();
  return turns_[leg].slerp(share, turns_[leg + 1]);
}

double LegProfile::RisingFrom() const {
  std::size_t leg = end_s_.size();
  const auto rises = [this](std::size_t k) {
    const Vector3 way = waypoints_[k + 1] - waypoints_[k];
    return way.head<2>().norm() < 1e-9 && way.z() >= 0.0 &&
           (turns_.empty() || turns_[k].isApprox(turns_[k + 1], 1e-9));
  };
  while (leg > 0 && rises(leg - 1)) --leg;
  return leg == 0 ? 0.0 : end_s_[leg - 1];
}

double LegProfile::TurnedOverUntil() const {
  for (std::size_t leg = end_s_.size(); leg > 0 && !turns_.empty(); --leg) {
    if (IsTurnedOver(turns_[leg])) return end_s_[leg - 1];
  }
  return 0.0;
}

RolloutOutcome RollOut(const RolloutScene& scene, int index, double grip_share,
                       const CandidateMotion& motion, bool full, const EvaluatorConfig& config,
                       mjModel& model, mjData& data) {
  RolloutOutcome outcome;
  if (scene.status() != StepStatus::kOk) {
    outcome.status = Status::kDiverged;
    return outcome;
  }
  GuardEngine([&] { mj_copyModel(&model, &scene.model()); });
  const RigidTransform X_NStart = scene.Grip(index, grip_share, model, data);
  std::vector<Vector3> way_NHand;
  for (std::size_t k = 0; k < motion.waypoints_N.size(); ++k) {
    way_NHand.push_back(PoseAt(motion, k) * X_NStart.translation());
  }
  const LegProfile profile(std::move(way_NHand), motion.speed_m_s, motion.rotations_N,
                           motion.turn_speed_rad_s);
  const double dt = model.opt.timestep, rising_from_s = profile.RisingFrom();
  const double turned_until_s = profile.TurnedOverUntil();
  const double lowest_turned_m = LowestTurned(scene.tubes()[index], motion);
  const bool may_give_up = !ShedsByTilting(motion);  // What a tip sheds counts less in the end.
  const int steps = static_cast<int>(std::ceil((profile.duration_s() + config.hold_s) / dt));
  double saturated_s = 0.0, rise_m = 0.0;
  Lifted lifted(scene, index);
  int step = 0;
  while (step < steps) {
    ++step;
    scene.Command(profile.At(step * dt), profile.TurnAt(step * dt) * X_NStart.linear(), data);
    if (Step(model, data) != StepStatus::kOk) {
      outcome.status = Status::kDiverged;
      break;
    }
    saturated_s = scene.Load(model, data) > kSaturated ? saturated_s + dt : 0.0;
    if (saturated_s > config.jam_s) outcome.status = Status::kJammed;
    if (full) continue;
    if (outcome.status == Status::kJammed) break;
    if (step % kLookEvery != 0) continue;
    const Vector3 p_NHand = profile.At(step * dt);
    const bool only_rises = step * dt >= rising_from_s;
    lifted.Look((p_NHand - profile.At((step - 1) * dt)) / dt, only_rises, model, data);
    const double lowest_m = step * dt < turned_until_s ? lowest_turned_m : kNeverDown_m;
    if (lifted.TouchesNothingMore(only_rises, lowest_m, model, data)) {
      rise_m = profile.At(profile.duration_s()).z() - p_NHand.z();
      break;
    }
    if (may_give_up &&
        Measure(scene, index, step * dt, model, data, lifted).displacement_m > config.give_up_m) {
      outcome.given_up = true;
      break;
    }
  }
  outcome.sim_s = step * dt;
  if (outcome.status == Status::kDiverged) return outcome;
  GuardEngine([&] { mj_forward(&model, &data); });
  const Disturbance others = Measure(scene, index, outcome.sim_s, model, data, lifted, rise_m);
  outcome.displacement_m = others.displacement_m;
  outcome.extra = others.extra;
  return outcome;
}

}  // namespace tubetwin

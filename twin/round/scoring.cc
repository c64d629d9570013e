#include "twin/round/scoring.h"

#include <algorithm>

#include "planner/grasp/placement.h"
#include "twin/statistics/wilson.h"

namespace tubetwin {
namespace {

constexpr double kAtRest_m_s = 0.02;  // The physics' own creep stays far below.

Json DetectionJson(const std::optional<Detection>& detection) {
  if (!detection) return nullptr;
  return Json{{"outcome", ToString(detection->outcome)},
              {"force_N", detection->force_N},
              {"torque_Nm", ToJson(detection->torque_Nm)},
              {"at_s", detection->at_s}};
}

Json GraspJson(const PickPlan& plan) {
  Json out = ToJson(plan.grasp.X_NG);
  out["at_m"] = plan.grasp.at_m;
  out["opening_m"] = plan.grasp.opening_m;
  return out;
}

Json MotionJson(const PickPlan& plan) {
  Json json = {{"name", plan.motion.name}};
  AddObjectPath(plan.motion, json);
  return json;
}

Json NudgesJson(const std::vector<NudgeReport>& nudges) {
  Json out = Json::array();
  for (const NudgeReport& nudge : nudges) out.push_back(ToJson(nudge));
  return out;
}

/// Angle between a tube and the tray's y axis, ends being equal, degrees.
double YawErrorDeg(const Vector3& direction_T) {
  const double angle = std::atan2(std::abs(direction_T.x()), std::abs(direction_T.y()));
  return Degrees(angle);
}

bool Has(const std::vector<int>& ids, int id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

TrayCount CountTray(const std::vector<Truth::Tube>& tubes, const TrayCount& before) {
  TrayCount now;
  for (const Truth::Tube& tube : tubes) {
    if (!tube.over_tray || tube.over_bin || tube.touches_pads || tube.hangs) continue;
    now.arrived_ids.push_back(tube.id);
    if (tube.speed_m_s < kAtRest_m_s || Has(before.placed_ids, tube.id)) {
      now.placed_ids.push_back(tube.id);
    }
  }
  return now;
}

RoundScorer::RoundScorer(const TwinCell& cell, int tubes_start)
    : truth_(cell), tubes_start_(tubes_start) {}

Json RoundScorer::State() const {
  return Json{{"placed_ids", tray_.placed_ids},
              {"arrived_ids", tray_.arrived_ids},
              {"outside_ids", outside_ids_}};
}

void RoundScorer::Restore(const JsonView& state) {
  const auto read = [&](const char* name, std::vector<int>& ids) {
    const JsonView view = state.Field(name);
    for (std::size_t i = 0; i < view.Size(); ++i) {
      ids.push_back(static_cast<int>(view.Item(i).AsInteger()));
    }
  };
  read("placed_ids", tray_.placed_ids);
  read("arrived_ids", tray_.arrived_ids);
  read("outside_ids", outside_ids_);
  placed_before_ = static_cast<int>(tray_.placed_ids.size());
  outside_before_ = static_cast<int>(outside_ids_.size());
}

void RoundScorer::AtDetection() {
  if (truth_) held_at_detection_ = truth_->Held();
}

Json RoundScorer::AttemptRow(const AttemptReport& report, int round) {
  const std::vector<Truth::Tube> tubes = truth_ ? truth_->Tubes() : std::vector<Truth::Tube>();
  if (!truth_ && attempts_ == 0) tubes_start_ = report.tubes_in_bin;
  const TrayCount tray = CountTray(tubes, tray_);
  std::vector<int> outside;
  const CellLayout layout;
  Json error_mm = nullptr, error_deg = nullptr;
  int added = 0;
  for (const Truth::Tube& tube : tubes) {
    if (tube.outside) outside.push_back(tube.id);
    // What arrived with an earlier attempt and only now rests is no work of this one.
    const bool is_new = Has(tray.placed_ids, tube.id) && !Has(tray_.arrived_ids, tube.id);
    added += is_new ? 1 : 0;
    if (is_new && report.slot_centre_T) {
      const RigidTransform X_TB = layout.X_BT.inverse();
      const Vector3 off = X_TB * tube.centre_of_mass_B - *report.slot_centre_T;
      error_mm = 1e3 * off.head<2>().norm();
      error_deg = YawErrorDeg(PrincipalDirection(Transformed(X_TB, tube.centerline_B)));
    }
  }
  const bool new_outside = outside.size() > outside_ids_.size();
  const bool believed = report.outcome == AttemptOutcome::kPlaced;
  const bool success = believed && added == 1 && !new_outside;
  tray_ = tray;
  outside_ids_ = outside;

  Json row;
  row["round"] = round;
  row["attempt"] = report.attempt;
  row["tubes_in_bin"] = report.tubes_in_bin;
  row["target"] = report.plan ? Json(report.plan->target) : Json(nullptr);
  row["class"] = report.plan ? Json(ToString(report.plan->target_class)) : Json(nullptr);
  row["motion"] = report.plan ? MotionJson(*report.plan) : Json(nullptr);
  row["grasp"] = report.plan ? GraspJson(*report.plan) : Json(nullptr);
  row["used_simulator"] = report.plan ? report.plan->used_simulator : false;
  row["prediction"] = report.plan ? ToJson(report.plan->prediction) : Json(nullptr);
  row["detection"] = DetectionJson(report.detection);
  row["resolution"] =
      Json{{"used", report.resolution_used},
           {"strategy", report.resolution_used ? Json(report.strategy) : Json(nullptr)},
           {"outcome", report.resolution_outcome ? Json(ToString(*report.resolution_outcome))
                                                 : Json(nullptr)}};
  row["nudges"] = NudgesJson(report.nudges);
  row["outcome"] = ToString(report.outcome);
  row["reason"] = report.reason;
  row["success"] = truth_ ? Json(success) : Json(nullptr);
  row["sim_s"] = Json{{"scan", report.sim_s.scan},
                      {"move", report.sim_s.move},
                      {"weigh", report.sim_s.weigh},
                      {"settle", report.sim_s.settle},
                      {"total", report.sim_s.total()}};
  if (truth_) {
    row["truth"] = Json{{"held", report.detection ? Json(held_at_detection_) : Json(nullptr)},
                        {"placed_ids", tray_.placed_ids},
                        {"outside_ids", outside_ids_},
                        {"placement_error_mm", error_mm},
                        {"placement_error_deg", error_deg}};
  } else {
    row["truth"] = nullptr;
  }
  ++attempts_;
  successes_ += success;
  const bool placed = truth_ ? success : believed;
  if (placed && report.attempt == 1) ++first_attempts_placed_;
  if (placed) ++picks_placed_;
  if (report.outcome == AttemptOutcome::kDropped) ++dropped_;
  rows_.push_back(row);
  return row;
}

Json RoundScorer::TimingRow(const AttemptReport& report, int round, double wall_s) {
  return Json{{"round", round},
              {"attempt", report.attempt},
              {"compute_s", Json{{"modelling", report.compute_s.modelling},
                                 {"planning", report.compute_s.planning},
                                 {"evaluator", report.compute_s.evaluator},
                                 {"total", report.compute_s.total}}},
              {"wall_s", wall_s}};
}

Json RoundScorer::Summary(const RoundReport& report, double sim_s) const {
  const int placed = truth_ ? static_cast<int>(tray_.placed_ids.size()) : report.placed_believed;
  const auto interval = Wilson95(first_attempts_placed_, picks_placed_);
  Json out;
  out["schema"] = "tubetwin/summary/1";
  out["tubes_start"] = tubes_start_;
  // Of a round that began in the middle.
  if (placed_before_ > 0) out["placed_before"] = placed_before_;
  if (outside_before_ > 0) out["outside_before"] = outside_before_;
  out["placed"] = placed;
  out["attempts"] = attempts_;
  const auto success = Wilson95(successes_, attempts_);
  out["success"] = Json{
      {"k", successes_}, {"n", attempts_}, {"wilson95", Json::array({success.low, success.high})}};
  if (!truth_) out["success"] = nullptr;
  out["first_attempt"] = Json{{"k", first_attempts_placed_},
                              {"n", picks_placed_},
                              {"wilson95", Json::array({interval.low, interval.high})}};
  out["emptied"] = truth_ ? placed == tubes_start_ : report.end == RoundEnd::kEmpty;
  out["end_reason"] = ToString(report.end);
  out["end_detail"] = report.reason;
  out["placed_believed"] = report.placed_believed;
  out["outside"] = truth_ ? Json(outside_ids_.size()) : Json(nullptr);
  out["dropped"] = dropped_;
  out["sim_s"] = sim_s;
  out["sim_s_per_pick"] = picks_placed_ > 0 ? Json(sim_s / picks_placed_) : Json(nullptr);
  if (!truth_) out["scored_by"] = "belief";
  return out;
}

}  // namespace tubetwin

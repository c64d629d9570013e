#include "twin/round/scoring.h"

#include <algorithm>
#include <utility>

#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/round/records/json_fields.h"

namespace tubetwin {
namespace {

constexpr double kAtRest_m_s = 0.02;  // The physics' own creep stays far below.

bool Has(const std::vector<int>& ids, int id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

double YawErrorDeg(const Polyline& centerline_T) {
  constexpr int kSamples = 64;
  const Polyline points = ResampleCount(centerline_T, kSamples);
  Vector3 mean = Vector3::Zero();
  for (const Vector3& p : points) mean += p / static_cast<double>(points.size());
  Matrix3 covariance = Matrix3::Zero();
  for (const Vector3& p : points) covariance += (p - mean) * (p - mean).transpose();
  // Eigenvalues come in rising order.
  const Vector3 axis = Eigen::SelfAdjointEigenSolver<Matrix3>(covariance).eigenvectors().col(2);
  return Degrees(std::atan2(std::abs(axis.x()), std::abs(axis.y())));
}

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

Json ToJson(const ScorerState& state) {
  return Json{{"placed_ids", state.tray.placed_ids},
              {"arrived_ids", state.tray.arrived_ids},
              {"outside_ids", state.outside_ids}};
}

ScorerState ScorerStateFromJson(const JsonView& view) {
  return {{IntegersFromJson(view.Field("placed_ids")), IntegersFromJson(view.Field("arrived_ids"))},
          IntegersFromJson(view.Field("outside_ids"))};
}

RoundScorer::RoundScorer(const TwinCell& cell, const CellLayout& layout, int tubes_start,
                         const PlacementTolerance& tolerance)
    : truth_(cell),
      X_TB_(layout.X_BT.inverse()),
      tolerance_(tolerance),
      tubes_start_(tubes_start) {}

void RoundScorer::Restore(const ScorerState& state) { before_ = now_ = state; }

void RoundScorer::AtDetection() {
  if (truth_) held_at_detection_ = truth_->Held();
}

void RoundScorer::AddTruth(const AttemptReport& report, AttemptRecord& record) {
  TT_CHECK(truth_);
  const std::vector<Truth::Tube> tubes = truth_->Tubes();
  const TrayCount tray = CountTray(tubes, now_.tray);
  AttemptTruth out;
  if (report.detection) out.held = held_at_detection_;
  int added = 0;
  for (const Truth::Tube& tube : tubes) {
    if (tube.outside) out.outside_ids.push_back(tube.id);
    // What arrived with an earlier attempt and only now rests is no work of this one.
    const bool is_new = Has(tray.placed_ids, tube.id) && !Has(now_.tray.arrived_ids, tube.id);
    added += is_new ? 1 : 0;
    if (is_new && report.slot_centre_T) {
      const Vector3 off = X_TB_ * tube.centre_of_mass_B - *report.slot_centre_T;
      out.placement_error_mm = 1e3 * off.head<2>().norm();
      out.placement_error_deg = YawErrorDeg(Transformed(X_TB_, tube.centerline_B));
    }
  }
  out.placed_ids = tray.placed_ids;
  record.success = report.outcome == AttemptOutcome::kPlaced && added == 1 &&
                   out.outside_ids.size() <= now_.outside_ids.size();
  record.in_tolerance = *record.success && out.placement_error_mm && out.placement_error_deg &&
                        tolerance_->Holds(*out.placement_error_mm, *out.placement_error_deg);
  now_ = {tray, out.outside_ids};
  record.truth = std::move(out);
}

AttemptRecord RoundScorer::Believed(const AttemptReport& report) {
  AttemptRecord out;
  out.attempt = report.attempt;
  out.tubes_in_bin = report.tubes_in_bin;
  if (report.plan) {
    out.chosen = ChosenPickOf(*report.plan);
    out.used_simulator = report.plan->used_simulator;
    out.prediction = report.plan->prediction;
  }
  out.detection = report.detection;
  out.resolution_used = report.resolution_used;
  if (report.resolution_used) out.strategy = report.strategy;
  out.held_at_last = report.resolution_outcome;
  out.nudges = report.nudges;
  out.outcome = report.outcome;
  out.reason = report.reason;
  out.sim_s = report.sim_s;
  out.phases_s = report.phases_s;
  if (!tubes_start_) tubes_start_ = report.tubes_in_bin;
  return out;
}

RoundSummary RoundScorer::Summary(const RoundReport& report,
                                  const std::vector<AttemptRecord>& attempts, double sim_s) const {
  RoundSummary out;
  out.tubes_start = tubes_start_.value_or(0);
  out.placed_before = static_cast<int>(before_.tray.placed_ids.size());
  out.outside_before = static_cast<int>(before_.outside_ids.size());
  const AttemptCounts rows = CountAttempts(attempts);
  out.attempts = rows.attempts;
  out.first_attempt = rows.first_attempt;
  out.dropped = rows.dropped;
  if (truth_) out.success = rows.success;
  out.tolerance = tolerance_;
  out.placed_believed = report.placed_believed;
  out.placed = truth_ ? static_cast<int>(now_.tray.placed_ids.size()) : report.placed_believed;
  out.outside = static_cast<int>(now_.outside_ids.size());
  out.emptied = truth_ ? out.placed == out.tubes_start : report.end == RoundEnd::kEmpty;
  out.end = report.end;
  out.end_detail = report.reason;
  out.sim_s = sim_s;
  return out;
}

}  // namespace tubetwin

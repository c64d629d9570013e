#include "twin/round/records/attempt_record.h"

#include <algorithm>
#include <utility>

#include "models/base/json.h"
#include "models/base/json_text.h"
#include "twin/round/records/json_fields.h"

namespace tubetwin {
namespace {

Json NumberOrNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::array<double, 4> QuaternionFromJson(const JsonView& view) {
  const std::vector<double> numbers = view.AsNumbers();
  if (numbers.size() != 4) view.Fail("four numbers w, x, y, z are needed");
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

std::optional<double> OptionalNumber(const JsonView& view, const std::string& name) {
  const auto field = view.Optional(name);
  return field ? std::optional<double>(field->AsNumber()) : std::nullopt;
}

void AddChosen(const std::optional<ChosenPick>& chosen, Json& row) {
  for (const char* key : {"target", "class", "motion", "grasp"}) row[key] = nullptr;
  if (!chosen) return;
  row["target"] = chosen->target;
  row["class"] = ToString(chosen->target_class);
  Json motion{{"name", chosen->motion}, {"waypoints_m", ToJson(chosen->waypoints_N)}};
  if (!chosen->rotations_N_wxyz.empty()) {
    motion["rotations_wxyz"] = chosen->rotations_N_wxyz;
    motion["pivot_m"] = ToJson(chosen->pivot_N);
  }
  row["motion"] = std::move(motion);
  row["grasp"] = Json{{"p_m", ToJson(chosen->p_NG)},
                      {"q_wxyz", chosen->q_NG_wxyz},
                      {"at_m", chosen->at_m},
                      {"opening_m", chosen->opening_m}};
}

ChosenPick ChosenFromJson(const JsonView& row) {
  ChosenPick chosen;
  chosen.target = CountFromJson(row.Field("target"));
  chosen.target_class = EnumFromJson(row.Field("class"), TubeClass::kStrong);
  const JsonView motion = row.Field("motion");
  chosen.motion = motion.Field("name").AsString();
  chosen.waypoints_N = motion.Field("waypoints_m").AsPolyline();
  if (const auto rotations = motion.Optional("rotations_wxyz")) {
    for (std::size_t i = 0; i < rotations->Size(); ++i) {
      chosen.rotations_N_wxyz.push_back(QuaternionFromJson(rotations->Item(i)));
    }
    chosen.pivot_N = motion.Field("pivot_m").AsVector3();
  }
  const JsonView grasp = row.Field("grasp");
  chosen.p_NG = grasp.Field("p_m").AsVector3();
  chosen.q_NG_wxyz = QuaternionFromJson(grasp.Field("q_wxyz"));
  chosen.at_m = grasp.Field("at_m").AsNumber();
  chosen.opening_m = grasp.Field("opening_m").AsNumber();
  return chosen;
}

Json DetectionJson(const std::optional<Detection>& detection) {
  if (!detection) return nullptr;
  return Json{{"outcome", ToString(detection->outcome)},
              {"force_N", detection->force_N},
              {"torque_Nm", ToJson(detection->torque_Nm)},
              {"at_s", detection->at_s}};
}

Detection DetectionFromJson(const JsonView& view) {
  Detection detection;
  detection.outcome = EnumFromJson(view.Field("outcome"), HeldOutcome::kSeveral);
  detection.force_N = view.Field("force_N").AsNumber();
  detection.torque_Nm = view.Field("torque_Nm").AsVector3();
  detection.at_s = view.Field("at_s").AsNumber();
  return detection;
}

Prediction PredictionFromJson(const JsonView& view) {
  return {view.Field("displacement_m").AsNumber(), view.Field("extra_probability").AsNumber(),
          CountFromJson(view.Field("samples"))};
}

Json TruthJson(const std::optional<AttemptTruth>& truth) {
  if (!truth) return nullptr;
  return Json{{"held", truth->held ? Json(*truth->held) : Json(nullptr)},
              {"placed_ids", truth->placed_ids},
              {"outside_ids", truth->outside_ids},
              {"placement_error_mm", NumberOrNull(truth->placement_error_mm)},
              {"placement_error_deg", NumberOrNull(truth->placement_error_deg)}};
}

AttemptTruth TruthFromJson(const JsonView& view) {
  AttemptTruth truth;
  if (const auto held = FieldOrNull(view, "held")) truth.held = CountFromJson(*held);
  truth.placed_ids = IntegersFromJson(view.Field("placed_ids"));
  truth.outside_ids = IntegersFromJson(view.Field("outside_ids"));
  truth.placement_error_mm = OptionalNumber(view, "placement_error_mm");
  truth.placement_error_deg = OptionalNumber(view, "placement_error_deg");
  return truth;
}

Json SimTimeJson(const std::optional<AttemptReport::SimTime>& sim_s) {
  if (!sim_s) return nullptr;
  return Json{{"scan", sim_s->scan},
              {"move", sim_s->move},
              {"weigh", sim_s->weigh},
              {"settle", sim_s->settle},
              {"total", sim_s->total()}};
}

Json RowHead(const RowPlace& place, int attempt) {
  Json row{{"round", place.round}};
  if (place.variant) row["variant"] = *place.variant;
  row["attempt"] = attempt;
  return row;
}

}  // namespace

ChosenPick ChosenPickOf(const PickPlan& plan) {
  ChosenPick chosen;
  chosen.target = plan.target;
  chosen.target_class = plan.target_class;
  chosen.motion = plan.motion.name;
  chosen.waypoints_N = plan.motion.waypoints_N;
  for (const Eigen::Quaterniond& rotation : plan.motion.rotations_N) {
    chosen.rotations_N_wxyz.push_back(QuaternionWxyz(rotation.toRotationMatrix()));
  }
  chosen.pivot_N = plan.motion.pivot_N;
  chosen.p_NG = plan.grasp.X_NG.translation();
  chosen.q_NG_wxyz = QuaternionWxyz(plan.grasp.X_NG.linear());
  chosen.at_m = plan.grasp.at_m;
  chosen.opening_m = plan.grasp.opening_m;
  return chosen;
}

Json ToJson(const AttemptRecord& attempt, const RowPlace& place) {
  Json row = RowHead(place, attempt.attempt);
  row["tubes_in_bin"] = attempt.tubes_in_bin ? Json(*attempt.tubes_in_bin) : Json(nullptr);
  AddChosen(attempt.chosen, row);
  row["used_simulator"] = attempt.used_simulator;
  row["prediction"] = ToJson(attempt.prediction);
  row["detection"] = DetectionJson(attempt.detection);
  row["resolution"] = Json{
      {"used", attempt.resolution_used},
      {"strategy", attempt.strategy.empty() ? Json(nullptr) : Json(attempt.strategy)},
      {"outcome", attempt.held_at_last ? Json(ToString(*attempt.held_at_last)) : Json(nullptr)}};
  row["nudges"] = Json::array();
  for (const NudgeReport& nudge : attempt.nudges) row["nudges"].push_back(ToJson(nudge));
  row["outcome"] = ToString(attempt.outcome);
  row["reason"] = attempt.reason;
  row["success"] = attempt.success ? Json(*attempt.success) : Json(nullptr);
  if (attempt.in_tolerance) {
    row["in_tolerance"] = *attempt.in_tolerance;
  } else if (!attempt.success) {
    row["in_tolerance"] = nullptr;  // Where success is known and this is not, an older row is told.
  }
  row["sim_s"] = SimTimeJson(attempt.sim_s);
  if (attempt.phases_s) row["phases_s"] = ToJson(*attempt.phases_s);
  row["truth"] = TruthJson(attempt.truth);
  return row;
}

AttemptRecord AttemptFromJson(const JsonView& row) {
  AttemptRecord attempt;
  attempt.attempt = CountFromJson(row.Field("attempt"));
  if (const auto tubes = FieldOrNull(row, "tubes_in_bin")) {
    attempt.tubes_in_bin = CountFromJson(*tubes);
  }
  if (FieldOrNull(row, "target")) attempt.chosen = ChosenFromJson(row);
  attempt.used_simulator = row.Field("used_simulator").AsBool();
  if (const auto found = row.Optional("prediction"))
    attempt.prediction = PredictionFromJson(*found);
  if (const auto found = FieldOrNull(row, "detection"))
    attempt.detection = DetectionFromJson(*found);
  const JsonView resolution = row.Field("resolution");
  attempt.resolution_used = resolution.Field("used").AsBool();
  if (const auto name = resolution.Optional("strategy")) attempt.strategy = name->AsString();
  if (const auto held = resolution.Optional("outcome")) {
    attempt.held_at_last = EnumFromJson(*held, HeldOutcome::kSeveral);
  }
  if (const auto nudges = row.Optional("nudges")) {
    for (std::size_t i = 0; i < nudges->Size(); ++i) {
      attempt.nudges.push_back(NudgeReportFromJson(nudges->Item(i)));
    }
  }
  attempt.outcome = EnumFromJson(row.Field("outcome"), AttemptOutcome::kFault);
  attempt.reason = row.Field("reason").AsString();
  if (const auto success = FieldOrNull(row, "success")) attempt.success = success->AsBool();
  if (const auto held = row.Optional("in_tolerance")) attempt.in_tolerance = held->AsBool();
  if (const auto times = FieldOrNull(row, "sim_s")) {
    attempt.sim_s.emplace();
    attempt.sim_s->scan = times->Field("scan").AsNumber();
    attempt.sim_s->move = times->Field("move").AsNumber();
    attempt.sim_s->weigh = times->Field("weigh").AsNumber();
    attempt.sim_s->settle = times->Field("settle").AsNumber();
  }
  if (const auto phases_s = row.Optional("phases_s")) attempt.phases_s = PhasesFromJson(*phases_s);
  if (const auto truth = FieldOrNull(row, "truth")) attempt.truth = TruthFromJson(*truth);
  return attempt;
}

Json ToJson(const AttemptTiming& timing, const RowPlace& place) {
  Json row = RowHead(place, timing.attempt);
  row["compute_s"] = nullptr;
  if (timing.compute_s) {
    row["compute_s"] = Json{{"modelling", timing.compute_s->modelling},
                            {"planning", timing.compute_s->planning},
                            {"evaluator", timing.compute_s->evaluator},
                            {"total", timing.compute_s->total}};
  }
  row["wall_s"] = timing.wall_s;
  return row;
}

AttemptTiming TimingFromJson(const JsonView& row) {
  AttemptTiming timing;
  timing.attempt = CountFromJson(row.Field("attempt"));
  if (const auto times = row.Optional("compute_s")) {
    timing.compute_s = AttemptReport::ComputeTime{
        times->Field("modelling").AsNumber(), times->Field("planning").AsNumber(),
        times->Field("evaluator").AsNumber(), times->Field("total").AsNumber()};
  }
  timing.wall_s = row.Field("wall_s").AsNumber();
  return timing;
}

}  // namespace tubetwin

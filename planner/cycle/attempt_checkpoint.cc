#include "planner/cycle/attempt_checkpoint.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/json.h"

namespace tubetwin {
namespace {

Json MatrixJson(const RigidTransform& X_AB) {
  // Sixteen numbers instead of a quaternion, whose conversion rounds.
  return std::vector<double>(X_AB.matrix().data(), X_AB.matrix().data() + 16);
}

RigidTransform MatrixFromJson(const JsonView& view) {
  if (view.Size() != 16) view.Fail("sixteen numbers of a pose, by columns, are needed");
  const std::vector<double> numbers = view.AsNumbers();
  RigidTransform X_AB;
  std::copy(numbers.begin(), numbers.end(), X_AB.matrix().data());
  return X_AB;
}

Json DetectionJson(const Detection& detection) {
  return Json{{"outcome", static_cast<int>(detection.outcome)},
              {"force_N", detection.force_N},
              {"torque_Nm", ToJson(detection.torque_Nm)},
              {"at_s", detection.at_s}};
}

Detection DetectionFromJson(const JsonView& view) {
  Detection detection;
  detection.outcome = static_cast<HeldOutcome>(view.Field("outcome").AsNumber(0, 2));
  detection.force_N = view.Field("force_N").AsNumber();
  detection.torque_Nm = view.Field("torque_Nm").AsVector3();
  detection.at_s = view.Field("at_s").AsNumber();
  return detection;
}

Json PlanJson(const PickPlan& plan) {
  Json json = {{"target", plan.target},
               {"class", static_cast<int>(plan.target_class)},
               {"motion", plan.motion.name},
               {"X_NG", MatrixJson(plan.grasp.X_NG)},
               {"at_m", plan.grasp.at_m},
               {"opening_m", plan.grasp.opening_m},
               {"used_simulator", plan.used_simulator},
               {"prediction", ToJson(plan.prediction)}};
  AddObjectPath(plan.motion, json);
  return json;
}

PickPlan PlanFromJson(const JsonView& view) {
  PickPlan plan;
  plan.target = plan.motion.tube = plan.grasp.tube =
      static_cast<int>(view.Field("target").AsInteger());
  plan.target_class = static_cast<TubeClass>(view.Field("class").AsNumber(0, 2));
  plan.motion.name = view.Field("motion").AsString();
  static_cast<ObjectPath&>(plan.motion) = ObjectPathFromJson(view);
  plan.grasp.X_NG = MatrixFromJson(view.Field("X_NG"));
  plan.grasp.at_m = view.Field("at_m").AsNumber();
  plan.grasp.opening_m = view.Field("opening_m").AsNumber();
  plan.used_simulator = view.Field("used_simulator").AsBool();
  if (const auto prediction = view.Optional("prediction")) {
    plan.prediction = Prediction{prediction->Field("displacement_m").AsNumber(),
                                 prediction->Field("extra_probability").AsNumber(),
                                 static_cast<int>(prediction->Field("samples").AsInteger())};
  }
  return plan;
}

}  // namespace

Json ToJson(const AttemptCheckpoint& state) {
  const AttemptReport& report = state.report;
  TT_CHECK(report.plan && report.detection && report.first_weighing);
  Json placed = Json::array();
  for (const Polyline& line_T : state.placed_T) placed.push_back(ToJson(line_T));
  Json nudges = Json::array();
  for (const NudgeReport& nudge : report.nudges) nudges.push_back(ToJson(nudge));
  return Json{{"attempt", report.attempt},
              {"nudges", nudges},
              {"tubes_in_bin", report.tubes_in_bin},
              {"plan", PlanJson(*report.plan)},
              {"first_weighing", DetectionJson(*report.first_weighing)},
              {"detection", DetectionJson(*report.detection)},
              {"sim_s", Json::array({report.sim_s.scan, report.sim_s.move, report.sim_s.weigh,
                                     report.sim_s.settle})},
              {"phases_s", ToJson(report.phases_s)},
              {"line_E_m", ToJson(state.line_E)},
              {"reference_K", Json{{"force_N", ToJson(state.reference_K.force_N)},
                                   {"torque_Nm", ToJson(state.reference_K.torque_Nm)}}},
              {"attempt_began_ns", state.attempt_began.count()},
              {"placed_T_m", placed},
              {"q", std::vector<double>(state.q.begin(), state.q.end())},
              {"opening_m", state.opening_m}};
}

AttemptCheckpoint AttemptCheckpointFromJson(const JsonView& view) {
  AttemptCheckpoint state;
  AttemptReport& report = state.report;
  report.attempt = static_cast<int>(view.Field("attempt").AsInteger());
  report.tubes_in_bin = static_cast<int>(view.Field("tubes_in_bin").AsInteger());
  if (const auto nudges = view.Optional("nudges")) {
    for (std::size_t i = 0; i < nudges->Size(); ++i) {
      report.nudges.push_back(NudgeReportFromJson(nudges->Item(i)));
    }
  }
  report.plan = PlanFromJson(view.Field("plan"));
  report.first_weighing = DetectionFromJson(view.Field("first_weighing"));
  report.detection = DetectionFromJson(view.Field("detection"));
  const JsonView sim_s = view.Field("sim_s");
  report.sim_s = {sim_s.Item(0).AsNumber(), sim_s.Item(1).AsNumber(), sim_s.Item(2).AsNumber(),
                  sim_s.Item(3).AsNumber()};
  if (const auto phases_s = view.Optional("phases_s")) report.phases_s = PhasesFromJson(*phases_s);
  state.line_E = view.Field("line_E_m").AsPolyline();
  const JsonView reference = view.Field("reference_K");
  state.reference_K = {reference.Field("force_N").AsVector3(),
                       reference.Field("torque_Nm").AsVector3()};
  state.attempt_began = TimeNs(view.Field("attempt_began_ns").AsInteger());
  const JsonView placed = view.Field("placed_T_m");
  for (std::size_t i = 0; i < placed.Size(); ++i) {
    state.placed_T.push_back(placed.Item(i).AsPolyline());
  }
  const JsonView q = view.Field("q");
  if (q.Size() != kNumJoints) q.Fail("one number for each of the 6 joints is needed");
  const std::vector<double> numbers = q.AsNumbers();
  std::copy(numbers.begin(), numbers.end(), state.q.begin());
  state.opening_m = view.Field("opening_m").AsNumber();
  return state;
}

}  // namespace tubetwin

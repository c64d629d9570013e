#include "planner/cycle/attempt_checkpoint.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/json_text.h"

namespace tubetwin {
namespace {

// What a stored moment may say: far more than any cell's, far less than what would never end.
constexpr double kLongest_s = 1e6, kFarthest_m = 10.0, kWidest_m = 1.0;
constexpr double kClosed_m = -0.01;  // Fingers that press on each other may read less than nothing.
constexpr double kFarthestTurn_rad = 20.0;
constexpr double kLargestLoad = 1e4;  // N and N m.

Vector3 LoadFromJson(const JsonView& view) {
  for (std::size_t k = 0; k < view.Size(); ++k) {
    view.Item(k).AsNumber(-kLargestLoad, kLargestLoad);
  }
  return view.AsVector3();
}

Json MatrixJson(const RigidTransform& X_AB) {
  // Sixteen numbers instead of a quaternion, whose conversion rounds.
  return std::vector<double>(X_AB.matrix().data(), X_AB.matrix().data() + 16);
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
  detection.force_N = view.Field("force_N").AsNumber(-kLargestLoad, kLargestLoad);
  detection.torque_Nm = LoadFromJson(view.Field("torque_Nm"));
  detection.at_s = view.Field("at_s").AsNumber(0.0, kLongest_s);
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
  plan.target = plan.motion.tube = plan.grasp.tube = CountFromJson(view.Field("target"));
  plan.target_class = static_cast<TubeClass>(view.Field("class").AsNumber(0, 2));
  plan.motion.name = view.Field("motion").AsString();
  static_cast<ObjectPath&>(plan.motion) = ObjectPathFromJson(view);
  plan.grasp.X_NG = TransformOfColumns(view.Field("X_NG"));
  plan.grasp.at_m = view.Field("at_m").AsNumber(0.0, kFarthest_m);
  plan.grasp.opening_m = view.Field("opening_m").AsNumber(kClosed_m, kWidest_m);
  plan.used_simulator = view.Field("used_simulator").AsBool();
  if (const auto prediction = view.Optional("prediction")) {
    plan.prediction = Prediction{prediction->Field("displacement_m").AsNumber(),
                                 prediction->Field("extra_probability").AsNumber(),
                                 CountFromJson(prediction->Field("samples"))};
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
  report.attempt = CountFromJson(view.Field("attempt"));
  report.tubes_in_bin = CountFromJson(view.Field("tubes_in_bin"));
  if (const auto nudges = view.Optional("nudges")) {
    for (std::size_t i = 0; i < nudges->Size(); ++i) {
      report.nudges.push_back(NudgeReportFromJson(nudges->Item(i)));
    }
  }
  report.plan = PlanFromJson(view.Field("plan"));
  report.first_weighing = DetectionFromJson(view.Field("first_weighing"));
  report.detection = DetectionFromJson(view.Field("detection"));
  const JsonView sim_s = view.Field("sim_s");
  const auto seconds = [&](std::size_t k) { return sim_s.Item(k).AsNumber(0.0, kLongest_s); };
  report.sim_s = {seconds(0), seconds(1), seconds(2), seconds(3)};
  if (const auto phases_s = view.Optional("phases_s")) report.phases_s = PhasesFromJson(*phases_s);
  state.line_E = view.Field("line_E_m").AsPolyline();
  const JsonView reference = view.Field("reference_K");
  state.reference_K = {LoadFromJson(reference.Field("force_N")),
                       LoadFromJson(reference.Field("torque_Nm"))};
  const JsonView began = view.Field("attempt_began_ns");
  began.AsNumber(0.0, 1e9 * kLongest_s);
  state.attempt_began = TimeNs(began.AsInteger());
  const JsonView placed = view.Field("placed_T_m");
  for (std::size_t i = 0; i < placed.Size(); ++i) {
    state.placed_T.push_back(placed.Item(i).AsPolyline());
  }
  const JsonView q = view.Field("q");
  if (q.Size() != kNumJoints) q.Fail("one number for each of the 6 joints is needed");
  for (std::size_t k = 0; k < kNumJoints; ++k) {
    state.q[k] = q.Item(k).AsNumber(-kFarthestTurn_rad, kFarthestTurn_rad);
  }
  state.opening_m = view.Field("opening_m").AsNumber(kClosed_m, kWidest_m);
  return state;
}

}  // namespace tubetwin

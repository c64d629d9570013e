#include "planner/cycle/attempt_report.h"

#include "models/base/error.h"
#include "models/base/json.h"

namespace tubetwin {

const char* ToString(ResolutionStrategy strategy) {
  switch (strategy) {
    case ResolutionStrategy::kNone:
      return "none";
    case ResolutionStrategy::kPlus45:
      return "plus45";
    case ResolutionStrategy::kPlus45Minus45:
      return "plus45_minus45";
    case ResolutionStrategy::kPerpendicular:
      return "perpendicular";
    case ResolutionStrategy::kPutback:
      return "putback";
  }
  return "none";
}

const std::vector<std::string>& ResolutionStrategyNames() {
  static const std::vector<std::string> names = {"none", "plus45", "plus45_minus45",
                                                 "perpendicular", "putback"};
  return names;
}

ResolutionStrategy ResolutionStrategyFromName(const std::string& name) {
  for (const auto strategy :
       {ResolutionStrategy::kNone, ResolutionStrategy::kPlus45, ResolutionStrategy::kPlus45Minus45,
        ResolutionStrategy::kPerpendicular, ResolutionStrategy::kPutback}) {
    if (name == ToString(strategy)) return strategy;
  }
  throw LogicError("no resolution strategy is called '" + name + "'");
}

const char* ToString(AttemptOutcome outcome) {
  switch (outcome) {
    case AttemptOutcome::kPlaced:
      return "placed";
    case AttemptOutcome::kPutBack:
      return "put_back";
    case AttemptOutcome::kNothingHeld:
      return "nothing_held";
    case AttemptOutcome::kDropped:
      return "dropped";
    case AttemptOutcome::kNoPlan:
      return "no_plan";
    case AttemptOutcome::kFault:
      return "fault";
  }
  return "fault";
}

const char* ToString(RoundEnd end) {
  switch (end) {
    case RoundEnd::kEmpty:
      return "empty";
    case RoundEnd::kNoPlan:
      return "no_plan";
    case RoundEnd::kAttemptLimit:
      return "attempt_limit";
    case RoundEnd::kFault:
      return "fault";
    case RoundEnd::kInterrupted:
      return "interrupted";
    case RoundEnd::kStored:
      return "stored";
  }
  return "fault";
}

Json ToJson(const NudgeReport& nudge) {
  return Json{{"tube", nudge.tube},         {"direction", ToJson(nudge.direction_N)},
              {"travel_m", nudge.travel_m}, {"contact", nudge.contact},
              {"press_N", nudge.press_N},   {"stopped", nudge.stopped},
              {"rejected", nudge.rejected}};
}

NudgeReport NudgeReportFromJson(const JsonView& view) {
  NudgeReport nudge;
  nudge.tube = static_cast<int>(view.Field("tube").AsInteger());
  nudge.direction_N = view.Field("direction").AsVector3();
  nudge.travel_m = view.Field("travel_m").AsNumber();
  nudge.contact = view.Field("contact").AsBool();
  nudge.press_N = view.Field("press_N").AsNumber();
  nudge.stopped = view.Field("stopped").AsBool();
  nudge.rejected = view.Field("rejected").AsString();
  return nudge;
}

}  // namespace tubetwin

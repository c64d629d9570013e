#include "planner/cycle/attempt_report.h"

#include "models/base/json.h"
#include "models/base/json_text.h"

namespace tubetwin {

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

const std::array<NamedPhase, 9>& AttemptPhases() {
  using Phases = AttemptReport::Phases;
  static constexpr std::array<NamedPhase, 9> kPhases = {{{"look", &Phases::look},
                                                         {"reach", &Phases::reach},
                                                         {"close", &Phases::close},
                                                         {"lift", &Phases::lift},
                                                         {"weigh", &Phases::weigh},
                                                         {"carry", &Phases::carry},
                                                         {"place", &Phases::place},
                                                         {"return", &Phases::back},
                                                         {"recover", &Phases::recover}}};
  return kPhases;
}

double AttemptReport::Phases::total() const {
  double sum = 0.0;
  for (const NamedPhase& named : AttemptPhases()) sum += this->*named.phase;
  return sum;
}

Json ToJson(const AttemptReport::Phases& phases_s) {
  Json out;
  for (const NamedPhase& named : AttemptPhases()) out[named.name] = phases_s.*named.phase;
  return out;
}

AttemptReport::Phases PhasesFromJson(const JsonView& view) {
  AttemptReport::Phases phases_s;
  for (const NamedPhase& named : AttemptPhases()) {
    phases_s.*named.phase = view.Field(named.name).AsNumber();
  }
  return phases_s;
}

Json ToJson(const NudgeReport& nudge) {
  return Json{{"tube", nudge.tube},         {"direction", ToJson(nudge.direction_N)},
              {"travel_m", nudge.travel_m}, {"contact", nudge.contact},
              {"press_N", nudge.press_N},   {"stopped", nudge.stopped},
              {"rejected", nudge.rejected}};
}

NudgeReport NudgeReportFromJson(const JsonView& view) {
  NudgeReport nudge;
  nudge.tube = CountFromJson(view.Field("tube"));
  nudge.direction_N = view.Field("direction").AsVector3();
  nudge.travel_m = view.Field("travel_m").AsNumber();
  nudge.contact = view.Field("contact").AsBool();
  nudge.press_N = view.Field("press_N").AsNumber();
  nudge.stopped = view.Field("stopped").AsBool();
  nudge.rejected = view.Field("rejected").AsString();
  return nudge;
}

}  // namespace tubetwin

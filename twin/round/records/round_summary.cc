#include "twin/round/records/round_summary.h"

#include "models/base/json.h"
#include "twin/round/records/json_fields.h"
#include "twin/statistics/rate.h"

namespace tubetwin {
namespace {

constexpr const char* kCrashed = "crashed";

int Integer(const JsonView& view, const std::string& name) {
  return CountFromJson(view.Field(name));
}

int IntegerOrZero(const JsonView& view, const std::string& name) {
  const auto field = view.Optional(name);
  return field ? CountFromJson(*field) : 0;
}

}  // namespace

std::string RoundSummary::EndName() const { return end ? ToString(*end) : kCrashed; }

std::optional<double> RoundSummary::SecondsPerPick() const {
  if (!sim_s || first_attempt.n == 0) return std::nullopt;
  return *sim_s / first_attempt.n;
}

Json ToJson(const RoundSummary& summary) {
  const bool has_truth = summary.success.has_value();
  const auto per_pick = summary.SecondsPerPick();
  Json out;
  out["schema"] = "tubetwin/summary/1";
  out["tubes_start"] = summary.tubes_start;
  if (summary.placed_before > 0) out["placed_before"] = summary.placed_before;
  if (summary.outside_before > 0) out["outside_before"] = summary.outside_before;
  out["placed"] = summary.placed;
  out["attempts"] = summary.attempts;
  out["success"] = has_truth ? ToJson(*summary.success) : Json(nullptr);
  out["first_attempt"] = ToJson(summary.first_attempt);
  if (summary.tolerance) out["tolerance"] = ToJson(*summary.tolerance);
  out["emptied"] = summary.emptied;
  out["end_reason"] = summary.EndName();
  out["end_detail"] = summary.end_detail;
  out["placed_believed"] = summary.placed_believed;
  out["outside"] = has_truth ? Json(summary.outside) : Json(nullptr);
  out["dropped"] = summary.dropped;
  out["sim_s"] = summary.sim_s ? Json(*summary.sim_s) : Json(nullptr);
  out["sim_s_per_pick"] = per_pick ? Json(*per_pick) : Json(nullptr);
  if (!has_truth) out["scored_by"] = "belief";
  return out;
}

RoundSummary SummaryFromJson(const JsonView& view) {
  RoundSummary out;
  RequireSchema(view, "summary");
  out.tubes_start = Integer(view, "tubes_start");
  out.placed_before = IntegerOrZero(view, "placed_before");
  out.outside_before = IntegerOrZero(view, "outside_before");
  out.placed = Integer(view, "placed");
  out.attempts = Integer(view, "attempts");
  if (const auto success = view.Optional("success")) out.success = CountsFromJson(*success);
  out.first_attempt = CountsFromJson(view.Field("first_attempt"));
  if (const auto tolerance = view.Optional("tolerance")) {
    out.tolerance = ToleranceFromJson(*tolerance);
  }
  out.emptied = view.Field("emptied").AsBool();
  const JsonView end = view.Field("end_reason");
  if (end.AsString() != kCrashed) out.end = EnumFromJson(end, RoundEnd::kStored);
  out.end_detail = view.Field("end_detail").AsString();
  out.placed_believed = Integer(view, "placed_believed");
  out.outside = IntegerOrZero(view, "outside");
  out.dropped = Integer(view, "dropped");
  if (const auto sim_s = view.Optional("sim_s")) out.sim_s = sim_s->AsNumber();
  return out;
}

}  // namespace tubetwin

#include "twin/round/round_record.h"

#include "planner/cycle/attempt_report.h"
#include "twin/statistics/wilson.h"

namespace tubetwin {
namespace {

constexpr const char* kCrashed = "crashed";  // No RoundEnd: nobody was left to say it.

}  // namespace

Json FaultRow(const std::string& reason) {
  Json row;
  row["round"] = 0;
  row["attempt"] = 1;
  for (const char* unknown : {"tubes_in_bin", "target", "class", "motion", "grasp"}) {
    row[unknown] = nullptr;
  }
  row["used_simulator"] = false;
  row["prediction"] = nullptr;
  row["detection"] = nullptr;
  row["resolution"] = Json{{"used", false}, {"strategy", nullptr}, {"outcome", nullptr}};
  row["nudges"] = Json::array();
  row["outcome"] = ToString(AttemptOutcome::kFault);
  row["reason"] = reason;
  row["success"] = false;
  row["sim_s"] = nullptr;
  row["truth"] = nullptr;
  return row;
}

Json FaultTimingRow(double wall_s) {
  return Json{{"round", 0}, {"attempt", 1}, {"compute_s", nullptr}, {"wall_s", wall_s}};
}

Json FaultSummary(int tubes_start, const std::string& reason) {
  Json out;
  out["schema"] = "tubetwin/summary/1";
  out["tubes_start"] = tubes_start;
  out["placed"] = 0;
  out["attempts"] = 1;
  const auto success = Wilson95(0, 1);
  out["success"] = Json{{"k", 0}, {"n", 1}, {"wilson95", Json::array({success.low, success.high})}};
  out["first_attempt"] = Json{{"k", 0}, {"n", 0}, {"wilson95", Json::array({0.0, 1.0})}};
  out["emptied"] = false;
  out["end_reason"] = kCrashed;
  out["end_detail"] = reason;
  out["placed_believed"] = 0;
  out["outside"] = 0;
  out["dropped"] = 0;
  out["sim_s"] = nullptr;
  out["sim_s_per_pick"] = nullptr;
  return out;
}

bool IsFaultSummary(const Json& summary) { return summary["end_reason"] == kCrashed; }

}  // namespace tubetwin

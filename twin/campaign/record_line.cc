#include "twin/campaign/record_line.h"

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/campaign.h"

namespace tubetwin {
namespace {

const std::string kCheckHead = ",\"check\":\"";
const std::string kCheckTail = "\"}";
constexpr std::size_t kCheckDigits = 16;

std::vector<Json> Rows(const JsonView& view) {
  std::vector<Json> rows;
  for (std::size_t i = 0; i < view.Size(); ++i) rows.push_back(view.Item(i).json());
  return rows;
}

}  // namespace

std::string NameOf(const RoundRecord& record) {
  return "arm " + std::to_string(record.arm) + " round " + std::to_string(record.round);
}

Json CampaignRow(const Json& row, int arm, int round) {
  Json out;
  out["round"] = round;
  out["arm"] = arm;
  for (const auto& [key, value] : row.items()) {
    if (key != "round" && key != "arm") out[key] = value;
  }
  return out;
}

std::string CheckedLine(const Json& json) {
  TT_CHECK(json.is_object() && !json.empty());
  std::string text = json.dump();
  const std::string check = Fingerprint(text);
  text.pop_back();  // The closing brace comes after the check.
  return text + kCheckHead + check + kCheckTail;
}

Json ParseCheckedLine(const std::string& line) {
  const std::size_t tail = kCheckHead.size() + kCheckDigits + kCheckTail.size();
  if (line.size() <= tail || line.compare(line.size() - tail, kCheckHead.size(), kCheckHead) != 0 ||
      !line.ends_with(kCheckTail)) {
    throw Error(ErrorKind::kBadData, "half-written or no line of a shard (its check is missing)");
  }
  const std::string body = line.substr(0, line.size() - tail) + "}";
  if (Fingerprint(body) != line.substr(line.size() - tail + kCheckHead.size(), kCheckDigits)) {
    throw Error(ErrorKind::kBadData, "damaged (its check does not fit)");
  }
  try {
    return Json::parse(body);
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorKind::kBadData, "no JSON although its check fits");
  }
}

std::string RecordLine(const RoundRecord& record) {
  Json out;
  out["arm"] = record.arm;
  out["round"] = record.round;
  out["seed"] = record.seed;
  out["summary"] = record.summary;
  out["picks"] = record.picks;
  out["timings"] = record.timings;
  return CheckedLine(out);
}

RoundRecord ParseRecordLine(const std::string& line) {
  const Json json = ParseCheckedLine(line);
  const JsonView view(json, "round");
  RoundRecord record;
  record.arm = static_cast<int>(view.Field("arm").AsInteger());
  record.round = static_cast<int>(view.Field("round").AsInteger());
  record.seed = view.Field("seed").AsInteger();
  record.summary = view.Field("summary").json();
  record.picks = Rows(view.Field("picks"));
  record.timings = Rows(view.Field("timings"));
  return record;
}

std::string RecordDifference(const RoundRecord& a, const RoundRecord& b) {
  if (a.seed != b.seed) {
    return "seed is " + std::to_string(a.seed) + " against " + std::to_string(b.seed);
  }
  if (a.picks.size() != b.picks.size()) {
    return "it has " + std::to_string(a.picks.size()) + " rows against " +
           std::to_string(b.picks.size());
  }
  for (std::size_t i = 0; i < a.picks.size(); ++i) {
    if (const auto difference = FirstDifference(a.picks[i], b.picks[i])) {
      return "row " + std::to_string(i + 1) + ": " + *difference;
    }
  }
  return FirstDifference(a.summary, b.summary).value_or("");
}

}  // namespace tubetwin

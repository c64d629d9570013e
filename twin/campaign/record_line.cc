#include "twin/campaign/record_line.h"

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/json_text.h"
#include "twin/campaign/campaign.h"
#include "twin/round/records/json_fields.h"

namespace tubetwin {
namespace {

const std::string kCheckHead = ",\"check\":\"";
const std::string kCheckTail = "\"}";
constexpr std::size_t kCheckDigits = 16;

}  // namespace

Json ToJson(const RoundRecord& record) {
  const RowPlace place{record.round, record.variant};
  Json out{{"variant", record.variant}, {"round", record.round},
           {"seed", record.seed},       {"summary", ToJson(record.summary)},
           {"picks", Json::array()},    {"timings", Json::array()}};
  for (const AttemptRecord& attempt : record.attempts) {
    out["picks"].push_back(ToJson(attempt, place));
  }
  for (const AttemptTiming& timing : record.timings) {
    out["timings"].push_back(ToJson(timing, place));
  }
  return out;
}

RoundRecord RecordFromJson(const JsonView& view) {
  RoundRecord record;
  record.variant = VariantOf(view);
  record.round = CountFromJson(view.Field("round"));
  record.seed = view.Field("seed").AsInteger();
  record.summary = SummaryFromJson(view.Field("summary"));
  const JsonView picks = view.Field("picks"), timings = view.Field("timings");
  for (std::size_t i = 0; i < picks.Size(); ++i) {
    record.attempts.push_back(AttemptFromJson(picks.Item(i)));
  }
  for (std::size_t i = 0; i < timings.Size(); ++i) {
    record.timings.push_back(TimingFromJson(timings.Item(i)));
  }
  return record;
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
  return ParseJson(body, "its check fits");
}

std::string RecordLine(const RoundRecord& record) { return CheckedLine(ToJson(record)); }

RoundRecord ParseRecordLine(const std::string& line) {
  const Json json = ParseCheckedLine(line);
  return RecordFromJson(JsonView(json, "round"));
}

std::string RecordDifference(const RoundRecord& a, const RoundRecord& b) {
  if (a.seed != b.seed) {
    return "seed is " + std::to_string(a.seed) + " against " + std::to_string(b.seed);
  }
  if (a.attempts.size() != b.attempts.size()) {
    return "it has " + std::to_string(a.attempts.size()) + " rows against " +
           std::to_string(b.attempts.size());
  }
  for (std::size_t i = 0; i < a.attempts.size(); ++i) {
    if (const auto difference =
            FirstDifference(ToJson(a.attempts[i], RowPlace()), ToJson(b.attempts[i], RowPlace()))) {
      return "row " + std::to_string(i + 1) + ": " + *difference;
    }
  }
  return FirstDifference(ToJson(a.summary), ToJson(b.summary)).value_or("");
}

}  // namespace tubetwin

// Records of attempts and rounds as files hold them.

#include "twin/round/records/round_record.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/round/result_files.h"
#include "twin/statistics/rate.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

/// A row with everything in it, its digits as no shorter number gives them.
const char* const kFullRow =
    R"({"round":2,"variant":1,"attempt":3,"tubes_in_bin":4,"target":2,"class":"strong","motion":{"name":"tip+","waypoints_m":[[0.0,0.0,0.0],[0.1,-0.2,0.30000000000000004]],"rotations_wxyz":[[1.0,0.0,0.0,0.0],[0.9659258262890683,0.25881904510252074,0.0,0.0]],"pivot_m":[0.1,0.2,0.0125]},"grasp":{"p_m":[0.12345678901234566,0.1,0.02],"q_wxyz":[0.0,0.7071067811865476,0.7071067811865475,-1e-17],"at_m":0.25,"opening_m":0.04},"used_simulator":true,"prediction":{"displacement_m":0.1,"extra_probability":0.2,"samples":5},"detection":{"outcome":"several","force_N":1.1,"torque_Nm":[0.1,0.0,-0.1],"at_s":12.5},"resolution":{"used":true,"strategy":"plus45","outcome":"one"},"nudges":[{"tube":3,"direction":[1.0,0.0,0.0],"travel_m":0.05,"contact":true,"press_N":3.1,"stopped":false,"rejected":""}],"outcome":"placed","reason":"","success":true,"in_tolerance":true,"sim_s":{"scan":5.1,"move":20.2,"weigh":1.3,"settle":0.4,"total":26.999999999999996},"truth":{"held":2,"placed_ids":[1,4],"outside_ids":[],"placement_error_mm":3.25,"placement_error_deg":0.5}})";

/// Of a round whose process crashed.
const char* const kCrashedRow =
    R"({"round":0,"attempt":1,"tubes_in_bin":null,"target":null,"class":null,"motion":null,"grasp":null,"used_simulator":false,"prediction":null,"detection":null,"resolution":{"used":false,"strategy":null,"outcome":null},"nudges":[],"outcome":"fault","reason":"the round crashed","success":false,"in_tolerance":false,"sim_s":null,"truth":null})";

const char* const kSummary =
    R"({"schema":"tubetwin/summary/1","tubes_start":7,"placed_before":1,"placed":6,"attempts":9,"success":{"k":5,"n":9},"first_attempt":{"k":4,"n":5},"tolerance":{"position_mm":20.0,"yaw_deg":7.5},"emptied":false,"end_reason":"no_plan","end_detail":"tube 3: no candidate","placed_believed":6,"outside":1,"dropped":1,"sim_s":412.25,"sim_s_per_pick":82.45})";

AttemptRecord Read(const std::string& row) {
  const Json json = Json::parse(row);
  return AttemptFromJson(JsonView(json, "picks.jsonl:7"));
}

std::string Refusal(const std::string& from, const std::string& to) {
  std::string row = kFullRow;
  const std::size_t at = row.find(from);
  REQUIRE(at != std::string::npos);
  row.replace(at, from.size(), to);
  try {
    Read(row);
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kBadData);
    return e.what();
  }
  return "not refused";
}

TEST_CASE("a row of an attempt comes back byte by byte", "[unit]") {
  CHECK(ToJson(Read(kFullRow), {2, 1}).dump() == kFullRow);
  CHECK(ToJson(Read(kCrashedRow), RowPlace()).dump() == kCrashedRow);
  RoundRecord crashed;
  SetCrashed(7, "the round crashed", 1.5, crashed);
  CHECK(ToJson(crashed.attempts.at(0), RowPlace()).dump() == kCrashedRow);
}

TEST_CASE("a row of earlier versions, without prediction and nudges, is read", "[unit]") {
  Json row = Json::parse(kFullRow);
  row.erase("prediction");
  row.erase("nudges");
  const AttemptRecord attempt = Read(row.dump());
  CHECK_FALSE(attempt.prediction);
  CHECK(attempt.nudges.empty());
  CHECK(attempt.chosen->motion == "tip+");
}

TEST_CASE("a row and a summary of before tolerances are read, told again as they were, not guessed",
          "[unit]") {
  std::string row = kFullRow;
  const std::string key = "\"in_tolerance\":true,";
  row.erase(row.find(key), key.size());
  CHECK_FALSE(Read(row).in_tolerance);
  CHECK(ToJson(Read(row), {2, 1}).dump() == row);
  Json summary = Json::parse(kSummary);
  summary.erase("tolerance");
  CHECK_FALSE(SummaryFromJson(JsonView(summary, "summary.json")).tolerance);
  RoundRecord record;
  record.attempts = {Read(row)};
  const Json told = RoundSummaryJson(record);
  CHECK(told["in_tolerance"]["n"] == 0);
  CHECK(told["in_tolerance_at"]["50"]["n"] == 0);
}

TEST_CASE("where nobody knows success, nobody knows the tolerance", "[unit]") {
  AttemptRecord believed = Read(kFullRow);
  believed.success = believed.in_tolerance = std::nullopt;
  believed.truth = std::nullopt;
  CHECK(ToJson(believed, RowPlace())["in_tolerance"].is_null());
  CHECK_THAT(Refusal("\"in_tolerance\":true", "\"in_tolerance\":1"), Contains("in_tolerance"));
}

TEST_CASE("phases of a row come back behind the times, and rows without them have none", "[unit]") {
  const std::string phases =
      R"("phases_s":{"look":5.1,"reach":6.2,"close":0.5,"lift":3.25,"weigh":1.7,"carry":4.125,"place":2.0,"return":3.0,"recover":1.125},)";
  std::string row = kFullRow;
  row.insert(row.find("\"truth\""), phases);
  CHECK(ToJson(Read(row), {2, 1}).dump() == row);
  CHECK(Read(row).phases_s->total() == Approx(27.0));
  CHECK_FALSE(Read(kFullRow).phases_s);
}

TEST_CASE("a damaged row is refused with file, line and field", "[unit]") {
  CHECK_THAT(Refusal("\"force_N\":1.1", "\"force_N\":\"1.1\""),
             Contains("picks.jsonl:7: detection.force_N: a number is needed"));
  CHECK_THAT(Refusal("\"outcome\":\"placed\"", "\"outcome\":\"plcaed\""),
             Contains("picks.jsonl:7: outcome: 'plcaed' is none of placed, put_back"));
  CHECK_THAT(Refusal("\"at_m\":0.25,", ""), Contains("grasp: field 'at_m' is missing"));
  CHECK_THAT(Refusal("[1,4]", "[1,4.5]"), Contains("truth.placed_ids[1]: a whole number"));
}

TEST_CASE("times of the clock come back, a crashed round has none", "[unit]") {
  const AttemptTiming timing{2, AttemptReport::ComputeTime{0.1, 0.2, 0.3, 0.6}, 61.25};
  const Json row = ToJson(timing, {4, 1});
  CHECK(ToJson(TimingFromJson(JsonView(row, "t")), {4, 1}) == row);
  const Json crashed = ToJson(AttemptTiming{1, std::nullopt, 2.0}, RowPlace());
  CHECK(crashed["compute_s"].is_null());
  CHECK(ToJson(TimingFromJson(JsonView(crashed, "t")), RowPlace()) == crashed);
}

TEST_CASE("a summary comes back byte by byte, of a crashed round and of a cell without truth too",
          "[unit]") {
  const auto again = [](const Json& json) {
    return ToJson(SummaryFromJson(JsonView(json, "summary.json"))).dump();
  };
  Json whole = Json::parse(kSummary);  // Intervals follow from the counts.
  for (const char* rate : {"success", "first_attempt"}) {
    whole[rate] = ToJson(CountsFromJson(JsonView(whole[rate], rate)));
  }
  CHECK(again(whole) == whole.dump());
  RoundRecord crashed;
  SetCrashed(7, "signal 11", 1.5, crashed);
  const Json of_crashed = ToJson(crashed.summary);
  CHECK(of_crashed["end_reason"] == "crashed");
  CHECK(of_crashed["sim_s"].is_null());
  CHECK(again(of_crashed) == of_crashed.dump());
  RoundSummary believed;
  believed.end = RoundEnd::kEmpty;
  believed.sim_s = 10.0;
  const Json of_believed = ToJson(believed);
  CHECK(of_believed["success"].is_null());
  CHECK(of_believed["scored_by"] == "belief");
  CHECK(again(of_believed) == of_believed.dump());
}

TEST_CASE("a round's folder gives back what was written into it", "[unit]") {
  const TemporaryFolder folder;
  RoundRecord record;
  record.attempts = {Read(kFullRow), Read(kCrashedRow)};
  record.timings = {{3, std::nullopt, 1.0}, {1, std::nullopt, 2.0}};
  record.summary.end = RoundEnd::kNoPlan;
  record.summary.attempts = 2;
  record.summary.first_attempt = CountAttempts(record.attempts).first_attempt;
  record.summary.success = Counts{1, 2};
  WriteRoundRecord(record, folder.path());
  const RoundRecord read = ReadRoundRecord(folder.path());
  REQUIRE(read.attempts.size() == 2);
  CHECK(ToJson(read.attempts[0], RowPlace()) == ToJson(record.attempts[0], RowPlace()));
  CHECK(read.timings.size() == 2);
  CHECK(ToJson(read.summary) == ToJson(record.summary));
}

}  // namespace
}  // namespace tubetwin

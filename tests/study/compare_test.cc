#include "twin/study/compare.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/campaign/fake_rounds.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("a comparison pairs rounds by seed and tests what each pair answers") {
  // Variant 0 fails its first pick in rounds 0 to 8, variant 1 in rounds 9 and 10: McNemar 9
  // against 2.
  std::vector<RoundRecord> records;
  for (int variant = 0; variant < 2; ++variant) {
    for (int round = 0; round < 20; ++round) {
      const bool fails = variant == 0 ? round < 9 : round == 9 || round == 10;
      std::vector<AttemptRecord> attempts;
      if (fails) attempts.push_back(FakeAttempt(1, AttemptOutcome::kNothingHeld, false, 0));
      attempts.push_back(FakeAttempt(fails ? 2 : 1, AttemptOutcome::kPlaced, true, 1));
      RoundRecord record = Record(round, attempts, FakeSummary(1, 1, 0, fails ? 70.0 : 40.0));
      record.variant = variant;
      records.push_back(record);
    }
  }
  const CampaignResult result = Result(records, 2);
  const Comparison found = CompareVariants(PairVariantsWithin(result));
  const Json comparison = ToJson(found);
  REQUIRE(comparison["pairs"].size() == 1);
  const Json& pair = comparison["pairs"][0];
  CHECK(pair["pairs"] == 20);
  const Json& first = pair["tests"][0];
  CHECK(first["question"] == "first_pick");
  CHECK(first["only_a"] == 2);
  CHECK(first["only_b"] == 9);
  CHECK(first["p"].get<double>() == Approx(0.06543).margin(5e-6));
  CHECK(first["p_holm"].get<double>() == Approx(3 * 134.0 / 2048.0));
  CHECK(pair["tests"][2]["question"] == "emptied");
  CHECK(pair["tests"][2]["p"] == 1.0);
  CHECK(pair["success"]["a"]["k"] == 20);
  CHECK(pair["success"]["a"]["n"] == 29);
  const double difference = 20.0 / 22.0 - 20.0 / 29.0;
  CHECK(pair["success"]["b_minus_a"].get<double>() == Approx(difference));
  CHECK(pair["success"]["bootstrap95"][0].get<double>() < difference);
  CHECK(pair["success"]["bootstrap95"][1].get<double>() > difference);
  CHECK(pair["sim_s_per_placed_tube"]["b_minus_a"].get<double>() == Approx(-10.5));
  CHECK(pair["resolution"]["b_minus_a"].is_null());  // Never used: nothing is known.
  CHECK_THAT(CompareText(found), Contains("McNemar p = 0.06543"));
}

TEST_CASE("a campaign compared with itself shows no difference, one of other seeds no pair") {
  const TemporaryFolder folder;
  RunAll(FakeCampaign(6), folder / "a");
  RunAll(FakeCampaign(6, 1, 9), folder / "b");
  const CampaignResult a = ReadCampaignResult(folder / "a");
  const CampaignResult b = ReadCampaignResult(folder / "b");
  const Json same = ToJson(CompareVariants(PairVariants(a, a)));
  for (const Json& test : same["pairs"][0]["tests"]) CHECK(test["p"] == 1.0);
  CHECK(same["pairs"][0]["success"]["b_minus_a"] == 0.0);
  try {
    CompareVariants(PairVariants(a, b));
    FAIL("not refused");
  } catch (const Error& e) {
    CHECK_THAT(e.what(), Contains("no seed in common"));
  }
  CHECK_THROWS_AS(PairVariantsWithin(a), Error);
}

}  // namespace tubetwin

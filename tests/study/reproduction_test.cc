#include "twin/study/reproduction.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "twin/study/paper_2020.h"

namespace tubetwin {
namespace {

/// One attempt with its times: placed tubes so far, and how.
void AddAttempt(RoundRecord& record, int number, bool success, int placed, const char* motion,
                bool simulator, bool resolution, double modelling_s) {
  AttemptRecord attempt;
  attempt.attempt = number;
  attempt.chosen.emplace();
  attempt.chosen->motion = motion;
  attempt.used_simulator = simulator;
  attempt.resolution_used = resolution;
  attempt.outcome = success ? AttemptOutcome::kPlaced : AttemptOutcome::kPutBack;
  attempt.success = success;
  attempt.truth.emplace();
  for (int i = 1; i <= placed; ++i) attempt.truth->placed_ids.push_back(i);
  record.attempts.push_back(attempt);
  const double evaluator_s = simulator ? 1.0 : 0.0;
  record.timings.push_back(
      {number,
       AttemptReport::ComputeTime{modelling_s, 0.5, evaluator_s, modelling_s + 0.5 + evaluator_s},
       0.0});
}

/// Two rounds of two tubes in each variant: in the first an escape fails and is resolved in vain,
/// then both are placed; in the second one tube is placed and the other is not found.
CampaignResult TwoRounds() {
  CampaignResult out;
  out.identity.seed = 1;
  out.identity.rounds = 2;
  for (const char* name : {"A leao2020", "B leao2020", "A best", "B best"}) {
    out.identity.variants.push_back(name);
    for (int round = 0; round < 2; ++round) {
      RoundRecord record;
      record.variant = static_cast<int>(out.identity.variants.size()) - 1;
      record.round = round;
      record.summary.tubes_start = 2;
      record.summary.emptied = round == 0;
      record.summary.end = RoundEnd::kEmpty;
      if (round == 0) {
        AddAttempt(record, 1, false, 0, "escape+1", true, true, 1.0);
        AddAttempt(record, 2, true, 1, "up", true, false, 2.0);
        AddAttempt(record, 1, true, 2, "up", false, false, 3.0);
      } else {
        AddAttempt(record, 1, true, 1, "up", false, false, 4.0);
      }
      out.records.push_back(std::move(record));
    }
  }
  return out;
}

const Json& Row(const Json& tables, int table, const std::string& what, const Json& left,
                const char* set = "A") {
  for (const Json& row : tables["tables"][table - 3]["rows"]) {
    if (row["what"] == what && row["tubes_left"] == left && row["set"] == set) return row;
  }
  throw Error(ErrorKind::kInternal, "no row " + what);
}

void CheckRate(const Json& cell, int k, int n) {
  INFO(cell.dump());
  CHECK(cell["k"] == k);
  CHECK(cell["n"] == n);
}

TEST_CASE("The paper's tables are made of a campaign's rows", "[unit]") {
  const Reproduction reproduction = ReproductionOf(TwoRounds());
  const Json tables = ToJson(reproduction);
  CheckRate(Row(tables, 3, "bins emptied", nullptr)["best"], 1, 2);
  // Of the picked tubes one was placed on the second attempt.
  CheckRate(Row(tables, 4, "placed on the first attempt", 2)["best"], 1, 2);
  CheckRate(Row(tables, 4, "placed on the first attempt", 1)["best"], 1, 1);
  CheckRate(Row(tables, 4, "placed on the first attempt", nullptr)["leao2020"], 2, 3);
  CheckRate(Row(tables, 5, "simulator, upwards", 2)["best"], 1, 3);
  CheckRate(Row(tables, 5, "simulator, escape", 2)["best"], 1, 3);
  CheckRate(Row(tables, 5, "simulator used", nullptr)["best"], 2, 4);
  CheckRate(Row(tables, 6, "upwards", nullptr)["best"], 1, 1);
  CheckRate(Row(tables, 6, "escape", nullptr)["best"], 0, 1);
  CheckRate(Row(tables, 7, "resolution used", nullptr)["best"], 1, 4);
  CheckRate(Row(tables, 8, "resolution led to a pick", nullptr)["best"], 0, 1);
  const Json& modelling = Row(tables, 9, "modelling", nullptr)["best"];
  CHECK(modelling["n"] == 4);
  CHECK(modelling["mean"] == 2.5);
  // Student's t with 3 degrees of freedom: 3.182 times sd / 2.
  CHECK(modelling["sd"].get<double>() == Approx(1.2909944));
  CHECK(modelling["mean95"][1].get<double>() ==
        Approx(2.5 + 3.182446 * 1.2909944 / 2).epsilon(1e-6));
  CHECK(Row(tables, 9, "planning, with simulation", nullptr)["best"]["mean"] == 1.5);
  CHECK(ReproductionText(reproduction)
            .find("| Set A, bins emptied | 18/20 = 90 % [70, 97] | 1/2 = 50 %") !=
        std::string::npos);
}

TEST_CASE("The paper's own figures add up to what it prints over all", "[unit]") {
  const Reproduction reproduction = ReproductionOf(TwoRounds());
  const Json tables = ToJson(reproduction);
  CheckRate(Row(tables, 4, "placed on the first attempt", nullptr, "A")["paper"], 136, 137);
  CheckRate(Row(tables, 4, "placed on the first attempt", nullptr, "B")["paper"], 126, 135);
  CheckRate(Row(tables, 5, "simulator used", nullptr, "A")["paper"], 10, 138);
  CheckRate(Row(tables, 5, "simulator used", nullptr, "B")["paper"], 25, 144);
  CheckRate(Row(tables, 6, "with simulator", nullptr, "B")["paper"], 17, 25);
  CheckRate(Row(tables, 7, "resolution used", nullptr, "B")["paper"], 11, 144);
}

TEST_CASE("Intervals that do not meet the paper's are named", "[unit]") {
  const Reproduction reproduction = ReproductionOf(TwoRounds());
  const Json tables = ToJson(reproduction);
  // 1 to 4 s here, 0.81 s about 3.15 s there: they meet. Planning: 0.5 s against 0.84 s: apart.
  CHECK(Row(tables, 9, "modelling", nullptr)["apart"].empty());
  CHECK(Row(tables, 9, "planning, without simulation", nullptr)["apart"].size() == 2);
}

TEST_CASE("Tables need the campaign of the reproduction", "[unit]") {
  CampaignResult other = TwoRounds();
  other.identity.variants[2] = "mine";
  CHECK_THROWS_AS(ReproductionOf(other), Error);
}

}  // namespace
}  // namespace tubetwin

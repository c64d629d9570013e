#include "twin/report/report_page.h"

#include "models/base/json.h"
#include "twin/report/front/front_page.h"
#include "twin/report/page.h"
#include "twin/report/parts.h"

namespace tubetwin {
namespace {

/// Rates of a single variant; several are not mixed.
std::string Cards(const ReportInput& input) {
  // One variant has the intervals by rounds, the totals over variants have not.
  const bool one = !input.is_round;
  const Pointer at = one ? VariantPointer(input, 0) : Pointer();
  std::string out;
  for (const MetricValue& value :
       one ? input.summary.variants.front().metrics : input.summary.metrics) {
    if (value.metric->place != Metric::Place::kHeadline) continue;
    if (input.is_round && value.metric->per_round) continue;  // One round has no rate of rounds.
    out += RateCard(Escaped(value.metric->label), value.rate, at / value.metric->name);
  }
  return out;
}

std::string Facts(const ReportInput& input) {
  const CampaignTotals& totals = input.summary.totals;
  const Pointer at;
  std::vector<std::pair<std::string, std::string>> facts = {
      {"attempts", CountHtml(totals.attempts, at / "attempts")},
      {"several placed", CountHtml(totals.several_placed,
                                   input.is_round ? Pointer::Nowhere() : at / "several_placed")},
      {"dropped", CountHtml(totals.dropped, at / "dropped")}};
  if (!input.is_round) {
    facts.insert(facts.begin(), {"rounds", CountHtml(totals.rounds, at / "rounds")});
    facts.emplace_back("outside", CountHtml(totals.outside, at / "outside"));
    facts.emplace_back("rounds crashed", CountHtml(totals.crashed, at / "crashed"));
    return FactList(facts);
  }
  const RoundSummary& round = input.result.records.front().summary;
  facts.emplace_back("outside", round.success ? CountHtml(round.outside, at / "outside") : kDash);
  facts.emplace_back("simulated time, s", FixedHtml(round.sim_s, at / "sim_s", 1));
  facts.emplace_back("per placed tube, s",
                     FixedHtml(round.SecondsPerPick(), at / "sim_s_per_pick", 1));
  return FactList(facts);
}

/// Picture and film of a round; a campaign has none.
std::string PictureHtml(const KeptForReport& kept) {
  std::string out;
  if (!kept.picture.empty()) {
    out += "<canvas class=\"picture\" data-picture=\"" + std::to_string(kept.attempts.size()) +
           "\" role=\"img\" aria-label=\"The cell at the start of the round\"></canvas>";
  }
  if (!kept.video.empty()) {
    out +=
        "<p class=\"links\"><a href=\"" + LinkTo(kept.video) + "\">The film of the round</a></p>";
  }
  return out;
}

std::string Footer(const ReportInput& input, const KeptForReport& kept) {
  constexpr const char* kIntervals =
      " Intervals are Wilson's, those by rounds of the number of independent attempts that all of "
      "them are worth (Korn and Graubard 1998). Numbers that stand in summary.json say where. ";
  std::string out = "<footer><p>";
  const bool believed = input.is_round && !input.result.records.front().summary.success;
  out += believed ? "The cell of this round has no truth: what was placed is what the picking "
                    "pipeline believes."
                  : "Success is judged by the simulation's truth, which the picking pipeline never "
                    "sees: exactly one new tube at rest on the tray, none outside.";
  out += kIntervals;
  if (!input.is_round)
    return out + "Commands are to be run in the folder of this page.</p></footer>\n";
  return out + "This command, run in the folder of this page, " +
         (believed ? "runs the cell again" : "repeats the round") + ":</p><pre class=\"command\">" +
         Escaped(RepeatCommand(kept.link)) + "</pre></footer>\n";
}

}  // namespace

std::string ReportHtml(const ReportInput& input, const KeptForReport& kept, const Json& told) {
  const bool several = input.summary.variants.size() > 1;
  std::string body = FrontPage(input, several ? "" : Cards(input)) + (several ? "" : Facts(input)) +
                     PictureHtml(kept);
  if (input.summary.totals.attempts == 0) {
    body += "<p>There was no attempt.</p>\n";
  } else {
    body += Section("cycle", "Where a pick's time goes", CycleTime(input)) +
            Section("failures", "What fails", FailureModes(input)) + "<div class=\"two\">" +
            Section("levers", "What would raise the rate", Levers(input)) +
            Section("more", "What more rounds would tell", MoreRounds(input)) + "</div>\n" +
            Section("variants", "Variants", VariantsTable(input)) +
            Section("credibility", "How far to trust these rates", Credibility(input)) +
            Section("left", "Success by tubes left", TubesLeft(input)) +
            Section("times", "Where the time goes", Times(input)) +
            Section("view", "One attempt in 3-D", ViewerHtml(kept.attempts)) +
            Section("gallery", "Failed attempts", GalleryHtml(kept.attempts)) +
            Section("forces", "Load at the wrist", TracesHtml(kept.attempts)) +
            Section("motions", "Motions", Motions(input)) +
            Section("measures", "Steps and measures", Measures(input)) +
            Section("belief", "Belief against truth", Belief(input)) +
            Section("attempts", input.is_round ? "Every attempt" : "Failed attempts, row by row",
                    AttemptsTable(input));
  }
  Json content{{"schema", "tubetwin/report/2"},
               {"kind", input.is_round ? "round" : "campaign"},
               {"summary", told}};
  if (!input.is_round) content["times"] = TimesHistogram(input.result);
  content.update(AttemptData(kept.attempts));
  if (!kept.picture.empty()) content["pictures"].push_back(kept.picture);
  const char* plain = input.is_round ? "tubetwin: one round" : "tubetwin: campaign";
  return ReportPage(input.title.empty() ? plain : input.title, body + Footer(input, kept), content);
}

}  // namespace tubetwin

// The sections behind the front page: where a pick's time goes, what fails, what would help.

#include <algorithm>
#include <map>

#include "twin/report/chart.h"
#include "twin/report/front/front_page.h"
#include "twin/report/front/time_shares.h"
#include "twin/report/parts.h"

namespace tubetwin {
namespace {

constexpr int kLeversTold = 8;

/// A variant with its rounds and what its page's hour is made of.
struct VariantRounds {
  std::size_t index = 0;
  const VariantSummary* summary = nullptr;
  std::vector<RoundFacts> rounds;
  HourOf hour = HourOf::kCell;
};

std::vector<VariantRounds> VariantsOf(const ReportInput& input) {
  std::vector<VariantRounds> out;
  for (std::size_t i = 0; i < input.summary.variants.size(); ++i) {
    out.push_back({i, &input.summary.variants[i],
                   FactsOf(input.result.OfVariant(static_cast<int>(i))), PageRate(input, i).hour});
  }
  return out;
}

std::string Subheading(const ReportInput& input, const VariantRounds& variant) {
  if (input.summary.variants.size() < 2) return "";
  return "<h3>" + Escaped(variant.summary->name) + "</h3>\n";
}

/// Colour of a phase: what moves, what measures, what thinks.
std::string ClassOf(const std::string& phase) {
  static const std::map<std::string, std::string> kClasses = {
      {"look", "part0"},  {"scan", "part0"},   {"compute", "part4"},  {"weigh", "part2"},
      {"close", "part3"}, {"settle", "part3"}, {"recover", "bad-bar"}};
  const auto found = kClasses.find(phase);
  return found == kClasses.end() ? "part1" : found->second;
}

std::string GanttOf(const MedianPick& pick) {
  std::vector<GanttRow> rows;
  double at_s = 0.0;
  for (const auto& [phase, seconds] : pick.phases_s) {
    if (seconds > 0.0) rows.push_back({phase, at_s, at_s + seconds, ClassOf(phase)});
    at_s += seconds;
  }
  return GanttHtml(rows, "The median pick");
}

/// Median and spread of every phase over the picks that placed one.
std::string PhaseTable(const VariantRounds& variant) {
  std::vector<std::pair<std::string, std::vector<double>>> phases;
  const auto add = [&](const std::string& name, double seconds) {
    const auto found = std::find_if(phases.begin(), phases.end(),
                                    [&](const auto& one) { return one.first == name; });
    if (found == phases.end()) {
      phases.push_back({name, {seconds}});
    } else {
      found->second.push_back(seconds);
    }
  };
  for (const RoundFacts& round : variant.rounds) {
    for (const AttemptFacts& facts : round.attempts) {
      if (!facts.PlacedOne()) continue;
      for (const auto& [name, seconds] : PhaseSeconds(*facts.attempt)) add(name, seconds);
      if (variant.hour == HourOf::kCellAndComputing && facts.timing && facts.timing->compute_s) {
        add("compute", facts.timing->compute_s->total);
      }
    }
  }
  std::string rows;
  for (const auto& [name, seconds] : phases) {
    const Spread spread = SpreadOf(seconds);
    rows += "<tr><th>" + Escaped(name) + "</th>" + NumberCell(Fixed(spread.median, 1)) +
            NumberCell(Fixed(spread.mean, 1)) + NumberCell(Fixed(spread.p5, 1)) +
            NumberCell(Fixed(spread.p95, 1)) + "</tr>\n";
  }
  if (rows.empty()) return "";
  return "<div class=\"wide\"><table><tr><th>seconds of a pick</th><th class=\"n\">median</th><th "
         "class=\"n\">mean</th><th class=\"n\">5 %</th><th class=\"n\">95 %</th></tr>\n" +
         rows + "</table></div>\n";
}

std::string FailureWords(const std::string& failure) {
  static const std::map<std::string, std::string> kWords = {
      {"crashed", "the program failed in this round"},
      {"outside", "a part came to lie outside bin and tray"},
      {"several_placed", "more than one part was laid down"},
      {"placed_none", "believed placed, but no new part lies on the tray"},
      {"placed_unnoticed", "placed, though the pipeline believed otherwise"},
      {"nothing_held", "the fingers came up without a part, or it slipped out"},
      {"dropped", "a part was lost on the way to the tray"},
      {"put_back", "several hung in the fingers, or a motion was refused: back into the bin"},
      {"no_plan", "no grasp was found that the arm can carry out"},
      {"fault", "a device did not do as it was told"}};
  const auto found = kWords.find(failure);
  return found == kWords.end() ? "" : found->second;
}

/// The rate of attempts that ended as that failure, by rounds; of a name that none has, 0.
Rate FailureRate(const VariantRounds& variant, const std::string& failure) {
  const auto any = [](const AttemptFacts&) { return true; };
  const auto as_that = [&](const AttemptFacts& facts) {
    return !facts.failure.empty() && facts.failure == failure;
  };
  return ValueOf(AttemptRate("", "", any, as_that), variant.rounds).rate;
}

std::string EndsText(const ReportInput& input, const VariantSummary& variant) {
  if (input.is_round) return "";  // It stands at the head.
  std::string ends;
  for (const auto& [end, count] : variant.end_reasons) {
    const Rate rate{{count, variant.totals.rounds}, std::nullopt};
    ends += (ends.empty() ? "" : "; ") + Escaped(FailureName(end)) + " " +
            RateDetailHtml(rate, Pointer::Nowhere());
  }
  return "<p class=\"quiet\">Rounds ended: " + ends + ".</p>\n";
}

std::string IntervalCells(const PartsPerHour& rate) {
  if (!rate.interval) return "<td class=\"n\">" + std::string(kDash) + "</td><td></td>";
  return NumberCell("\xc2\xb1" + ToText(0.5 * (rate.interval->high - rate.interval->low))) +
         "<td>" + ToText(rate.interval->low) + " to " + ToText(rate.interval->high) + "</td>";
}

}  // namespace

std::string CycleTime(const ReportInput& input) {
  std::string out;
  bool old_rows = false;
  for (const VariantRounds& variant : VariantsOf(input)) {
    const std::optional<MedianPick> pick = MedianPickOf(variant.rounds, variant.hour);
    if (!pick) continue;
    old_rows = old_rows || !pick->record->attempts[pick->row].phases_s;
    const std::string place =
        (input.is_round ? "" : "round " + std::to_string(pick->record->round) + ", ") + "attempt " +
        std::to_string(pick->row + 1);
    out += Subheading(input, variant) +
           Figure(GanttOf(*pick), "The median of " + std::to_string(pick->picks) +
                                      " picks that placed a part: " + place + ", " +
                                      Fixed(pick->total_s, 1) + " s.") +
           "<details><summary>Every phase over all picks</summary>" + PhaseTable(variant) +
           "</details>\n";
  }
  if (out.empty()) return "";
  out += old_rows
             ? "<p class=\"quiet\">An earlier version wrote these rows: it knew of motions "
               "only how long all of them took.</p>\n"
             : "<p class=\"quiet\">Return is the way up from the tray and to the first view of "
               "the next look; weigh is all waits for the load, taring included, told as "
               "one.</p>\n";
  if (PageRate(input, 0).hour == HourOf::kCell) {
    out += "<p class=\"quiet\">Time of the cell; computing is not in it.</p>\n";
  }
  return out;
}

std::string FailureModes(const ReportInput& input) {
  std::string out;
  for (const VariantRounds& variant : VariantsOf(input)) {
    const auto shares = TimeSharesOf(variant.rounds, variant.hour);
    const int attempts = variant.summary->totals.attempts;
    std::string rows;
    for (const auto& [failure, count] : variant.summary->failures) {
      const Rate rate = FailureRate(variant, failure);
      double time_s = 0.0;
      for (const auto& one : shares ? shares->failures : std::vector<TimeShares::Failure>()) {
        if (one.name == failure) time_s = one.time_s;
      }
      rows += "<tr><th>" + Escaped(FailureName(failure)) + "<span class=\"quiet block\">" +
              FailureWords(failure) + "</span></th><td class=\"rate\">" + RateMark(rate) + " " +
              RateHtml(rate, Pointer::Nowhere()) + "</td>" +
              NumberCell(shares ? Fixed(100.0 * time_s / shares->total_s, 1) + "&nbsp;%" : kDash) +
              "</tr>\n";
    }
    out += Subheading(input, variant) +
           (rows.empty()
                ? "<p><b class=\"good\">No attempt failed</b> of " + std::to_string(attempts) +
                      ": the rate of failures is below " +
                      Fixed(100.0 * Interval95(FailureRate(variant, "")).high, 1) +
                      "&nbsp;% (95&nbsp;%).</p>\n"
                : "<div class=\"wide\"><table><tr><th>an attempt ended as</th><th>rate, 95&nbsp;% "
                  "interval</th><th class=\"n\">of the time</th></tr>\n" +
                      rows + "</table></div>\n") +
           EndsText(input, *variant.summary);
  }
  return out;
}

std::string MoreRounds(const ReportInput& input) {
  std::string rows;
  for (std::size_t i = 0; i < input.summary.variants.size(); ++i) {
    const VariantTimes& times = input.manifest.compute_s[i];
    const PartsPerHour& now = times.parts_per_hour;
    if (now.rounds < 2 || !now.interval) continue;
    if (input.summary.variants.size() > 1) {
      rows += "<tr class=\"group\"><th colspan=\"3\">" + Escaped(times.name) + "</th></tr>\n";
    }
    rows += "<tr><th>" + std::to_string(now.rounds) + " rounds, as run</th>" + IntervalCells(now) +
            "</tr>\n";
    for (const auto& [factor, rate] : times.with_more_rounds) {
      rows += "<tr><th>" + std::to_string(factor * now.rounds) + " rounds</th>" +
              IntervalCells(rate) + "</tr>\n";
    }
  }
  if (rows.empty()) {
    return "<p>One round gives no interval: run a campaign, for example of 20 rounds, and more as "
           "far as the interval is too wide.</p>\n";
  }
  return "<div class=\"wide\"><table><tr><th></th><th class=\"n\">half width</th><th>95&nbsp;% "
         "interval of parts per hour</th></tr>\n" +
         rows +
         "</table></div>\n<p class=\"quiet\">Drawn from the rounds as they are: with more of them "
         "the middle moves within today's interval, its width falls about with the root of their "
         "number.</p>\n";
}

std::string Levers(const ReportInput& input) {
  std::string out;
  for (const VariantRounds& variant : VariantsOf(input)) {
    const auto shares = TimeSharesOf(variant.rounds, variant.hour);
    if (!shares || shares->placed == 0) continue;
    const std::vector<Lever> levers = LeversOf(*shares);
    if (levers.empty()) continue;
    std::vector<BarRow> bars;
    for (const Lever& lever : levers) {
      if (static_cast<int>(bars.size()) >= kLeversTold) break;
      bars.push_back({lever.what,
                      {lever.gain},
                      "+" + Fixed(lever.gain, 1) + " to " + ToText(lever.parts_per_hour)});
    }
    const Lever& best = levers.front();
    out += Subheading(input, variant) + "<p>Most by this: <b>" + Escaped(best.what) +
           "</b>, from " + ToText(3600.0 * shares->placed / shares->total_s) + " to " +
           ToText(best.parts_per_hour) + " parts per hour.</p>\n" +
           Figure(BarsHtml(bars, {"good-bar"}, "Parts per hour that would be gained"),
                  "Parts per hour more, if this one thing were so and all else as measured.");
  }
  if (out.empty()) return "";
  return out +
         "<p class=\"quiet\">Computed from the measured times: a phase in half its time; a class "
         "of "
         "failures without the time of its attempts, and with the parts that they lost placed in "
         "the mean time of a pick.</p>\n";
}

}  // namespace tubetwin

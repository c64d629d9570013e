#include "twin/report/front/front_page.h"

#include <algorithm>
#include <set>

#include "twin/report/front/part_picture.h"
#include "twin/report/front/study_facts.h"
#include "twin/report/parts.h"

namespace tubetwin {
namespace {

constexpr int kFewRounds = 10;  ///< With fewer a bootstrap's interval is clearly too narrow.

std::string Title(const ReportInput& input) {
  if (!input.title.empty()) return Escaped(input.title);
  const std::size_t variants = input.summary.variants.size();
  if (variants > 1) return std::to_string(variants) + " variants compared";
  return "Placed " + CountHtml(input.summary.totals.placed, Pointer() / "placed") + " of " +
         CountHtml(input.summary.totals.tubes_start, Pointer() / "tubes_start") + " parts";
}

std::string Eyebrow(const ReportInput& input) {
  std::string out = input.customer.empty() ? "" : "For " + Escaped(input.customer) + " \xc2\xb7 ";
  if (input.is_round) return out + "One round";
  return out + "Campaign, seed " + std::to_string(input.summary.seed) + ", program " +
         Shown(input.result.identity.program) + ", MuJoCo " + Shown(input.result.identity.mujoco);
}

/// What the page is about, in a sentence or two.
std::string Lead(const ReportInput& input) {
  const CampaignTotals& totals = input.summary.totals;
  const std::size_t variants = input.summary.variants.size();
  std::string out;
  if (!input.title.empty() && variants == 1) {
    out = "Placed " + CountHtml(totals.placed, Pointer() / "placed") + " of " +
          CountHtml(totals.tubes_start, Pointer() / "tubes_start") + " parts. ";
  }
  if (input.is_round) {
    const RoundSummary& round = input.result.records.front().summary;
    return out +
           (round.emptied ? "<b class=\"good\">The bin was emptied.</b> "
                          : "<b class=\"bad\">The bin was not emptied.</b> ") +
           "The round ended: " + Escaped(round.EndName()) +
           (round.end_detail.empty() ? "" : " (" + Escaped(round.end_detail) + ")") + ".";
  }
  if (variants == 1) {
    return out + CountHtml(totals.rounds, Pointer() / "rounds") +
           " bins: " + Escaped(input.summary.variants.front().name) + ".";
  }
  return out + std::to_string(input.summary.variants.front().totals.rounds) +
         " bins of each, with the same seeds: every variant is told on its own.";
}

std::string RateNumber(double value, const Pointer& at) {
  return FixedHtml(value, at, value < 9.95 ? 1 : 0);
}

std::string IntervalText(const PartsPerHour& rate, const Pointer& at) {
  if (rate.rounds == 1)
    return "one round: it cannot say how much rounds differ, so there is no interval";
  if (!rate.interval) return "no interval";
  std::string out = "95&nbsp;% interval " + RateNumber(rate.interval->low, at / "low") + " to " +
                    RateNumber(rate.interval->high, at / "high") + ", by a bootstrap over " +
                    std::to_string(rate.rounds) + " rounds";
  if (rate.rounds < kFewRounds) {
    out += "; of fewer than " + std::to_string(kFewRounds) + " rounds it is too narrow";
  }
  return out;
}

/// Where the rate of the cell alone stands in summary.json.
Pointer CellPointer(const ReportInput& input, std::size_t variant) {
  return (input.is_round ? Pointer() : Pointer() / "variants" / variant) / "parts_per_hour";
}

/// What a clock had a part in stands in no summary.json.
Pointer RatePointer(const ReportInput& input, std::size_t variant) {
  if (PageRate(input, variant).hour != HourOf::kCell) return Pointer::Nowhere();
  return CellPointer(input, variant);
}

std::string RateCell(const ReportInput& input, std::size_t variant) {
  const PartsPerHour& rate = PageRate(input, variant);
  const Pointer at = RatePointer(input, variant);
  if (!rate.value) return "<b>" + std::string(kDash) + "</b>";
  return "<b>" + RateNumber(*rate.value, at / "value") + "</b> <span class=\"quiet\">" +
         (rate.interval ? RateNumber(rate.interval->low, at / "low") + " to " +
                              RateNumber(rate.interval->high, at / "high")
                        : std::string("no interval")) +
         "</span>";
}

std::string RateNote(const PartsPerHour& rate) {
  std::string out = std::string("An hour is: ") + DefinitionOf(rate.hour) + ".";
  if (rate.hour == HourOf::kCell) {
    out += " <code>tubetwin campaign report</code> of this folder tells it with computing time.";
  } else {
    out += " Computing time is that of the machine that ran the rounds.";
  }
  if (rate.left_out > 0) {
    out += " Not counted: " + std::to_string(rate.left_out) +
           " rounds that crashed or whose times were not kept.";
  }
  return out;
}

std::string HeadlineCard(const ReportInput& input) {
  const PartsPerHour& rate = PageRate(input, 0);
  const Pointer at = RatePointer(input, 0);
  std::string out = "<div class=\"card headline\"><h3>Parts per hour</h3><p class=\"big\">" +
                    (rate.value ? RateNumber(*rate.value, at / "value") : std::string(kDash)) +
                    "</p><p class=\"quiet\">" + IntervalText(rate, at) +
                    ".</p><p class=\"quiet\">" + RateNote(rate) + "</p>";
  const PartsPerHour& cell = input.summary.variants.front().parts_per_hour;
  if (rate.hour != HourOf::kCell && cell.value) {
    const Pointer cell_at = CellPointer(input, 0) / "value";
    out +=
        "<p class=\"quiet\">Without computing time " + RateNumber(*cell.value, cell_at) + ".</p>";
  }
  return out + "</div>\n";
}

std::string Pictures(const ReportInput& input) {
  constexpr int kMost = 4;  ///< Of different parts; more would push the facts off the page.
  std::set<std::string> seen;
  std::string out;
  bool has_pile = false;
  for (const StudySetup& setup : input.setups) {
    if (!setup.part || static_cast<int>(seen.size()) >= kMost) continue;
    const Part& part = *setup.part;
    if (!seen.insert(part.name).second) continue;
    const std::string shapes = PartPictureSvg(setup.shapes, part.radius_m);
    out += Figure(shapes,
                  Escaped(part.name) +
                      (setup.shapes.size() > 1 ? ": some of its shapes, drawn as for the rounds"
                                               : ": its shape without load") +
                      "; to scale.");
    if (has_pile || setup.pile_N.empty()) continue;
    has_pile = true;
    out += Figure(PilePictureSvg(setup.pile_N, part.radius_m, setup.bin.value_or(Bin())),
                  "One bin at the start, from above.");
  }
  return out.empty() ? "" : "<div class=\"pictures\">\n" + out + "</div>\n";
}

std::string NotModelledList() {
  std::string out = "<ul class=\"limits\">";
  for (const std::string& item : NotModelled()) out += "<li>" + Escaped(item) + "</li>";
  return out + "</ul>\n";
}

std::string VariantRates(const ReportInput& input) {
  std::string rows;
  for (std::size_t i = 0; i < input.summary.variants.size(); ++i) {
    const VariantSummary& variant = input.summary.variants[i];
    std::string emptied = kDash;
    for (const MetricValue& value : variant.metrics) {
      if (value.metric->name == "emptied") {
        emptied = RateHtml(value.rate, VariantPointer(input, i) / "emptied");
      }
    }
    rows += "<tr><th>" + Escaped(variant.name) + "</th><td>" + RateCell(input, i) + "</td><td>" +
            emptied + "</td></tr>\n";
  }
  return "<div class=\"wide\"><table class=\"variants\"><tr><th>variant</th><th>parts per "
         "hour</th><th>bins emptied</th></tr>\n" +
         rows +
         "</table></div>\n<p class=\"quiet\">95&nbsp;% intervals by bootstraps over rounds. " +
         RateNote(PageRate(input, 0)) + "</p>\n";
}

}  // namespace

std::string FactTable(const ReportInput& input, FactTexts (*facts_of)(const StudySetup&)) {
  std::vector<FactTexts> all;
  for (const StudySetup& setup : input.setups) all.push_back(facts_of(setup));
  std::set<std::string> names;
  std::string rows;
  for (const FactTexts& facts : all) {
    for (const auto& [name, text] : facts) {
      if (!names.insert(name).second) continue;
      std::string value, differing;
      bool same = true;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto found = std::find_if(all[i].begin(), all[i].end(),
                                        [&name = name](const auto& f) { return f.first == name; });
        const std::string here = found == all[i].end() ? std::string(kDash) : found->second;
        same = same && here == text;
        differing += "<div><span class=\"quiet\">" + Escaped(input.setups[i].name) + ":</span> " +
                     Escaped(here) + "</div>";
      }
      rows += "<div><dt>" + Escaped(name) + "</dt><dd>" + (same ? Escaped(text) : differing) +
              "</dd></div>\n";
    }
  }
  return rows.empty() ? "" : "<dl class=\"study\">\n" + rows + "</dl>\n";
}

const PartsPerHour& PageRate(const ReportInput& input, std::size_t variant) {
  const PartsPerHour& with_computing = input.manifest.compute_s.at(variant).parts_per_hour;
  const bool told = input.computing_times && with_computing.value;
  return told ? with_computing : input.summary.variants.at(variant).parts_per_hour;
}

std::string FrontPage(const ReportInput& input, const std::string& cards) {
  const bool several = input.summary.variants.size() > 1;
  std::string out =
      "<div class=\"front\">\n" + HeaderHtml(Eyebrow(input), Title(input), Lead(input));
  out += several ? VariantRates(input)
                 : "<div class=\"cards\">\n" + HeadlineCard(input) + cards + "</div>\n";
  const bool known =
      std::any_of(input.setups.begin(), input.setups.end(),
                  [](const StudySetup& setup) { return setup.part || setup.config.is_object(); });
  if (known) {
    const bool simulated = std::all_of(input.setups.begin(), input.setups.end(), IsSimulated);
    out += "<div class=\"front-columns\">\n<div><h3>What was run</h3>\n" +
           FactTable(input, StudyFacts) + "<h3>Assumptions</h3>\n" +
           FactTable(input, StudyAssumptions) +
           (simulated ? "<h3>Not modelled</h3>\n" + NotModelledList() : std::string()) +
           "</div>\n<div>" + Pictures(input) + "</div>\n</div>\n";
  }
  return out + "</div>\n";
}

}  // namespace tubetwin

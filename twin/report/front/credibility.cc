// How far to trust the rates of a page: short, and honest about what nobody measured.

#include <algorithm>

#include "twin/report/front/front_page.h"
#include "twin/report/parts.h"

namespace tubetwin {
namespace {

/// The tolerance that the rounds were scored with; nothing: they do not say it.
std::optional<PlacementTolerance> ToleranceOf(const ReportInput& input) {
  for (const RoundRecord& record : input.result.records) {
    if (record.summary.tolerance) return record.summary.tolerance;
  }
  return std::nullopt;
}

std::string Line(const std::string& name, const std::string& html) {
  return "<div><dt>" + name + "</dt><dd>" + html + "</dd></div>\n";
}

/// Success and in tolerance of a single variant; several have them in their table.
std::string RatesText(const ReportInput& input) {
  const VariantSummary& variant = input.summary.variants.front();
  const Pointer at = input.is_round ? Pointer() : VariantPointer(input, 0);
  std::string out;
  for (const MetricValue& value : variant.metrics) {
    const std::string& name = value.metric->name;
    if ((name != "success" && name != "in_tolerance") || value.rate.counts.n == 0) continue;
    out += (out.empty() ? "" : "; ") +
           std::string(name == "success" ? "placed " : "in tolerance ") +
           RateHtml(value.rate, at / name);
  }
  return out;
}

std::string Rates(const ReportInput& input) {
  std::string out = input.summary.variants.size() > 1
                        ? "of each variant in the table above, with intervals by rounds"
                        : RatesText(input);
  if (out.empty()) return "";
  if (const auto tolerance = ToleranceOf(input)) {
    out += "; the tolerance is " + PlainNumber(tolerance->position_mm) + "&nbsp;mm and " +
           PlainNumber(tolerance->yaw_deg) + "\xc2\xb0";
  }
  if (input.is_round) out += "; one round cannot say how much rounds differ";
  return out + ".";
}

std::string SeedText(const ReportInput& input) {
  if (input.is_round) {
    const bool known = !input.setups.empty() && input.setups.front().seed;
    return (known ? std::to_string(*input.setups.front().seed) : std::string(kDash)) +
           "; a single round states no rate.";
  }
  const std::string seed = std::to_string(input.summary.seed);
  const std::string& purpose = input.result.identity.purpose;
  if (purpose == "claim") {
    return seed + ", claim: the campaign file says that nothing was run with this seed before.";
  }
  if (purpose == "development") {
    return seed +
           ", development: the program may have been improved on these very rounds, so that the "
           "rates are no claim.";
  }
  return seed + "; its purpose, claim or development, is not said.";
}

}  // namespace

std::string Credibility(const ReportInput& input) {
  const bool simulated = std::all_of(input.setups.begin(), input.setups.end(), IsSimulated);
  std::string lines;
  if (const std::string rates = Rates(input); !rates.empty()) lines += Line("Rates", rates);
  lines += Line("Seed", SeedText(input));
  if (simulated) {
    lines += Line("Checks of the physics",
                  "tests/validation/VALIDATION.md of the program's source: each with what was "
                  "expected, what was measured and its verdict.");
  }
  return FactTable(input, StudyGrounds) + "<dl class=\"study\">\n" + lines + "</dl>\n<p><b>" +
         (simulated ? "Without measured materials and a real cell this verifies the method, not "
                      "your rate."
                    : "Not all of this cell is simulated: its rates are those of this cell, this "
                      "part and this day.") +
         "</b></p>\n";
}

}  // namespace tubetwin

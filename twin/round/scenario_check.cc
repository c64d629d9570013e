#include "twin/round/scenario_check.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/json.h"
#include "planner/cell_check/cell_check.h"
#include "planner/cycle/cycle_config.h"

namespace tubetwin {
namespace {

using Verdict = Finding::Verdict;

std::string Padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string Said(const Finding& finding) {
  return finding.what + ": " + finding.found +
         (finding.allowed.empty() ? "" : "; allowed: " + finding.allowed);
}

}  // namespace

std::vector<Finding> CheckScenario(const Scenario& scenario, const std::string& folder) {
  const CellModel model = ScenarioModel(scenario);
  const bool from_file = !scenario.pile.file.empty();
  Part part;
  Bin bin;
  int count = 0;
  if (from_file) {
    const Pile pile = AskedPile(scenario, folder);
    part = pile.part;
    bin = pile.bin;
    count = static_cast<int>(pile.tubes.size());
  } else {
    part = LoadPart(ScenarioPartName(scenario));
    bin = ScenarioBin(scenario, std::nullopt, folder);
    if (scenario.cell.HasTwin()) count = scenario.pile.count;
  }
  return CheckCell({model, bin, part, ScanPoses(scenario.scan, model, bin), count,
                    scenario.nominal_scanner_pose && !scenario.cell.IsTwin()});
}

std::string FindingsTable(const std::vector<Finding>& findings) {
  std::size_t what = 0, found = 0;
  for (const Finding& finding : findings) {
    what = std::max(what, finding.what.size());
    found = std::max(found, finding.found.size());
  }
  std::string table;
  for (const Finding& finding : findings) {
    table += Padded(ToString(finding.verdict), 11) + Padded(finding.what, what + 2) +
             Padded(finding.found, found + 2) + finding.allowed;
    table.erase(table.find_last_not_of(' ') + 1);
    table += "\n";
    if (!finding.remedy.empty()) table += Padded("", 11) + finding.remedy + "\n";
  }
  return table;
}

Json FindingsJson(const std::vector<Finding>& findings) {
  Json out = Json::array();
  for (const Finding& finding : findings) {
    out.push_back(Json{{"verdict", ToString(finding.verdict)},
                       {"what", finding.what},
                       {"found", finding.found},
                       {"allowed", finding.allowed},
                       {"remedy", finding.remedy}});
  }
  return out;
}

void RequirePossible(const std::vector<Finding>& findings) {
  const Finding* first = nullptr;
  int more = -1;
  for (const Finding& finding : findings) {
    if (finding.verdict != Verdict::kImpossible) continue;
    if (first == nullptr) first = &finding;
    ++more;
  }
  if (first == nullptr) return;
  throw Error(ErrorKind::kConfig,
              "the cell cannot work: " + Said(*first) + "\n" + first->remedy +
                  (more > 0 ? "\n" + std::to_string(more) + " more impossible" : "") +
                  "\nconfig check shows all that was judged");
}

}  // namespace tubetwin

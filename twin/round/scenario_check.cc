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

/// What the scenario asks to be picked, and from where.
struct Asked {
  Part part;
  Bin bin;
  int count = 0;  ///< 0: not known.

  explicit Asked(const Scenario& scenario) {
    if (!scenario.pile.file.empty()) {
      const Pile pile = AskedPile(scenario);
      part = pile.part;
      bin = pile.bin;
      count = static_cast<int>(pile.tubes.size());
      return;
    }
    part = LoadPart(ScenarioPartName(scenario));
    bin = ScenarioBin(scenario, std::nullopt);
    if (scenario.cell.HasTwin()) count = scenario.pile.count;
  }
};

std::string Said(const Finding& finding) {
  return finding.what + ": " + finding.found +
         (finding.allowed.empty() ? "" : "; allowed: " + finding.allowed);
}

}  // namespace

PartFitCell PartFitOf(const Scenario& scenario, const CellModel& model) {
  PartFitCell cell(model);
  cell.grip_force_N = scenario.cycle.grip_force_N;
  cell.carry_acceleration_m_s2 = scenario.cycle.transfer_acceleration_m_s2;
  cell.pad_friction = scenario.physics.pad_friction[0];
  cell.noise_N = scenario.physics.wrench_noise_counts * cell.count_N;
  cell.drift_N = scenario.physics.wrench_bias_walk_N;
  cell.scan_width = SizeOfScan(model.scanner, scenario.scan.resolution).width;
  return cell;
}

std::vector<Finding> CheckScenario(const Scenario& scenario) {
  const CellModel model = ScenarioModel(scenario);
  const Asked asked(scenario);
  ScenarioPhysics(scenario, asked.part);  // Throws for a range that no round can draw from.
  return CheckCell({model, asked.bin, asked.part,
                    ScanPoses(scenario.scan, model, asked.bin, asked.part.radius_m), asked.count,
                    scenario.nominal_scanner_pose && !scenario.cell.IsTwin()});
}

std::vector<Finding> CheckScenarioPart(const Scenario& scenario) {
  return JudgePart(Asked(scenario).part, PartFitOf(scenario, ScenarioModel(scenario)));
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

void RequirePossible(const std::vector<Finding>& findings, const std::string& who, ErrorKind kind) {
  const Finding* first = nullptr;
  int more = -1;
  for (const Finding& finding : findings) {
    if (finding.verdict != Verdict::kImpossible) continue;
    if (first == nullptr) first = &finding;
    ++more;
  }
  if (first == nullptr) return;
  throw Error(kind, who + " cannot work: " + Said(*first) + "\n" + first->remedy +
                        (more > 0 ? "\n" + std::to_string(more) + " more impossible" : "") +
                        "\nconfig check shows all that was judged");
}

}  // namespace tubetwin

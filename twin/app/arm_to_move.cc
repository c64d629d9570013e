#include "twin/app/arm_to_move.h"

#include "models/base/error.h"
#include "models/base/frames.h"
#include "models/base/json.h"
#include "twin/app/command_line/terminal.h"
#include "twin/live/live_cell.h"

namespace tubetwin {

Scenario LoadCellToMove(const std::string& cell_file, const std::string& verb,
                        const Common& common) {
  Scenario scenario = LoadScenario({cell_file}, common);
  scenario.cell.ValidateOrThrow();
  RequireSoundCell(scenario, common);
  const CellConfig::Arm& role = scenario.cell.arm;
  if (!role.IsDevice()) {
    throw Error(ErrorKind::kConfig, "cell.arm.driver: is '" + role.driver + "', " + verb +
                                        " moves a device; allowed is a cell file with one");
  }
  RequireArmed(scenario);
  return scenario;
}

void PrintJoints(const JointVector& q, const Common& common) {
  if (common.json) {
    Json joints = Json::array();
    for (const double angle : q) joints.push_back(Degrees(angle));
    PrintJson(Json{{"joints_deg", joints}});
    return;
  }
  Print("joints");
  for (const double angle : q) Print(" %.3f", Degrees(angle));
  Print(" degrees\n");
}

}  // namespace tubetwin

#include <cstdio>
#include <fstream>

#include <CLI/CLI.hpp>

#include "hw_bridge/cell/wall_clock.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "scenes/engine/engine_error.h"
#include "twin/app/common.h"
#include "twin/live/live_cell.h"
#include "twin/render/gl/egl_context.h"
#include "twin/round/scenario_check.h"

namespace tubetwin {
namespace {

struct Examined {
  std::string what, state, fix;  ///< Empty fix: fine.
};

std::vector<Examined> Examine() {
  std::vector<Examined> out;
  out.push_back({"physics engine", "MuJoCo " + EngineVersion(), ""});
  try {
    const EglContext context;
    out.push_back({"images without a display", "EGL", ""});
  } catch (const Error& e) {
    out.push_back({"images without a display", e.what(),
                   "apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri"});
  }
  std::ifstream cpu("/proc/cpuinfo");
  std::string line;
  bool avx = false;
  while (std::getline(cpu, line)) avx |= line.find(" avx ") != std::string::npos;
  out.push_back(
      {"processor",
       std::to_string(Parallelism::All().threads) + " threads, AVX " + (avx ? "yes" : "no"),
       avx ? "" : "MuJoCo's library needs a processor with AVX"});
  out.push_back({"parts", Join(PartNames()), ""});
  return out;
}

/// Connects to the device of a role; `read` says what it tells, its driver what else there is.
template <class Role, class Read>
void Look(const std::string& what, const Role& role, const DriverContext& context, Read read,
          std::vector<Examined>& out) {
  if (!role.IsDevice()) {
    out.push_back({what, role.driver, ""});
    return;
  }
  try {
    const auto device = role.Connect(context);
    out.push_back({what, role.driver + ": " + read(*device), ""});
    for (const DeviceFinding& finding : role.Chosen().Examine(*device, context)) {
      out.push_back({finding.what, finding.told, finding.fix});
    }
  } catch (const Error& e) {
    out.push_back({what, e.what(), role.Link().fix});
  }
}

/// Doubts are told, but nothing is missing.
Examined AsExamined(const Finding& judged) {
  const bool impossible = judged.verdict == Finding::Verdict::kImpossible;
  std::string state = std::string(ToString(judged.verdict)) + ", " + judged.found;
  if (judged.verdict != Finding::Verdict::kOk) state += "; allowed: " + judged.allowed;
  if (judged.verdict == Finding::Verdict::kDoubtful) state += "; " + judged.remedy;
  return {judged.what, state, impossible ? judged.remedy : ""};
}

std::string Text(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string Said(const ArmState& state) {
  std::string out = std::string(ToString(state.mode)) + ", joints";
  for (double q : state.q) out += Text(" %.2f", Degrees(q));
  return out + " degrees" + (state.fault.empty() ? "" : ", " + state.fault);
}

std::string Said(const GripperState& state) {
  return std::string(state.activated ? "activated" : "not activated") +
         Text(", %.1f mm open", 1e3 * state.opening_m) + ", fault code " +
         std::to_string(state.fault);
}

std::string Said(const WrenchSample& sample) {
  std::string out = "force";
  for (double f : sample.wrench_K.force_N) out += Text(" %.2f", f);
  out += " N, torque";
  for (double t : sample.wrench_K.torque_Nm) out += Text(" %.3f", t);
  return out + " N m" + (sample.saturated ? ", saturated" : "");
}

/// Every device of the scenario's cell, read without moving anything.
std::vector<Examined> ExamineCell(const Scenario& scenario) {
  scenario.cell.ValidateOrThrow();
  const CellConfig& cell = scenario.cell;
  const WallClock clock(scenario.rate);
  const CellModel model = ScenarioModel(scenario);
  DriverContext context = ScenarioContext(scenario, model, clock, CellPurpose::kLook);
  context.believed_X_NS = [] { return RigidTransform::Identity(); };
  std::vector<Examined> out;
  Look(
      "arm", cell.arm, context,
      [&](const Arm& arm) {
        return Said(arm.State()) + (cell.arm.armed ? ", armed in the cell file" : "");
      },
      out);
  Look(
      "gripper", cell.gripper, context,
      [](const Gripper& gripper) { return Said(gripper.State()); }, out);
  Look(
      "force/torque sensor", cell.wrist, context,
      [](const ForceTorqueSensor& wrist) { return Said(wrist.Read()); }, out);
  Look(
      "scanner", cell.scanner, context, [&](const Scanner&) { return cell.scanner.Link().reached; },
      out);
  return out;
}

int Doctor(const std::string& cell_file, const Common& common) {
  std::vector<Examined> findings;
  bool impossible = false;
  if (cell_file.empty()) {
    findings = Examine();
  } else {
    const Scenario scenario = LoadScenario({cell_file}, common);
    const std::vector<Finding> judged = CheckScenario(scenario);
    for (const Finding& finding : judged) findings.push_back(AsExamined(finding));
    impossible = WorstOf(judged) == Finding::Verdict::kImpossible;
    if (!impossible) {
      for (Examined& device : ExamineCell(scenario)) {
        findings.push_back(std::move(device));
      }
    }
  }
  int missing = 0;
  Json json = Json::array();
  for (const Examined& f : findings) {
    missing += !f.fix.empty();
    json.push_back(Json{{"what", f.what}, {"state", f.state}, {"fix", f.fix}});
    if (!common.json) {
      std::printf("%-26s %s%s%s\n", f.what.c_str(), f.state.c_str(),
                  f.fix.empty() ? "" : "\n    fix: ", f.fix.c_str());
    }
  }
  if (common.json) std::printf("%s\n", json.dump(2).c_str());
  if (impossible) return static_cast<int>(ErrorKind::kConfig);
  return missing == 0 ? 0 : static_cast<int>(ErrorKind::kDevice);
}

}  // namespace

void AddDoctorVerb(CLI::App& app, Common& common) {
  CLI::App* verb = app.add_subcommand(
      "doctor",
      "Example: tubetwin doctor --cell cell.toml\n\nWhat is missing on this machine, with the fix; "
      "or, with a cell file, what each of its devices says. Moves nothing.");
  auto cell_file = std::make_shared<std::string>();
  verb->add_option("--cell", *cell_file, "Cell file (TOML): read its devices");
  AddCommonOptions(*verb, common, "", false);
  verb->callback([cell_file, &common] {
    common.action = [cell_file, &common] { return Doctor(*cell_file, common); };
  });
}

}  // namespace tubetwin

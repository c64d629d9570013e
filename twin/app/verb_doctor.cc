// First contact with a cell: what is there, and one joint turned a little.

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>

#include "hw_bridge/cell/left_over.h"
#include "hw_bridge/cell/wall_clock.h"
#include "hw_bridge/drivers/device_lock.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "scenes/engine/engine_error.h"
#include "twin/app/common.h"
#include "twin/live/jog.h"
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

/// Connects to the device of a role, unless another program has it; `read` says what it tells and
/// what speaks against a round, its driver what else there is. `owner`: the role as DeviceLock
/// knows it; empty: more than one program may look.
template <class Role, class Read>
void Look(const std::string& what, const Role& role, const std::string& owner,
          const DriverContext& context, Read read, std::vector<Examined>& out) {
  if (!role.IsDevice()) {
    out.push_back({what, role.driver, ""});
    return;
  }
  try {
    std::optional<DeviceLock> lock;
    if (!owner.empty()) {
      const std::string device = DeviceToOwn(owner, role);
      const std::string holder = DeviceLock::HolderOf(device);
      if (!holder.empty()) {
        out.push_back({what, role.driver + ": in use by " + holder + ", left alone", ""});
        return;
      }
      lock.emplace(device);
    }
    const auto device = role.Connect(context);
    const Examined said = read(*device);
    out.push_back({what, role.driver + ": " + said.state, said.fix});
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

/// What a device says, and what an earlier program left in the fingers by its word.
Examined WithLeftOver(const std::string& said, const std::string& left) {
  if (left.empty()) return {"", said, ""};
  return {"", said + "; " + left,
          "take it out, or let `run` at a terminal put it back into the bin"};
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
  std::optional<JointVector> q;
  const auto arm = [&](const Arm& device) {
    ArmState state = device.State();
    q = state.q;
    // Motion that nobody commands from here is then that program's.
    const std::string holder = DeviceLock::HolderOf(DeviceToOwn("arm", cell.arm));
    if (!holder.empty() && state.mode == ArmMode::kIdle) state.fault = "in use by " + holder;
    return Examined{"", Said(state) + (cell.arm.armed ? ", armed in the cell file" : ""), ""};
  };
  Look("arm", cell.arm, "", context, arm, out);
  const auto gripper = [](const Gripper& device) {
    const GripperState state = device.State();
    return WithLeftOver(Said(state), LeftInFingers(state));
  };
  Look("gripper", cell.gripper, "gripper", context, gripper, out);
  const double mass_kg = LoadPart(ScenarioPartName(scenario)).mass_kg;
  const auto wrist = [&](const ForceTorqueSensor& device) {
    const WrenchSample sample = device.Read();
    const SafetyLimits safety = ScenarioSafety(scenario);
    return WithLeftOver(Said(sample), q ? LeftOnWrist(sample, *q, model, safety, mass_kg) : "");
  };
  Look("force/torque sensor", cell.wrist, "wrist", context, wrist, out);
  const auto scanner = [&](const Scanner&) {
    return Examined{"", cell.scanner.Link().reached, ""};
  };
  Look("scanner", cell.scanner, "scanner", context, scanner, out);
  return out;
}

int Doctor(const std::string& cell_file, const Common& common) {
  std::vector<Examined> findings;
  bool impossible = false;
  if (cell_file.empty()) {
    RequireUsedKeys(common, {}, "without --cell");
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
      Print("%-26s %s%s%s\n", f.what.c_str(), f.state.c_str(),
            f.fix.empty() ? "" : "\n    fix: ", f.fix.c_str());
    }
  }
  if (common.json) PrintJson(json);
  if (impossible) return static_cast<int>(ErrorKind::kConfig);
  return missing == 0 ? 0 : static_cast<int>(ErrorKind::kDevice);
}

struct JogVerb {
  std::string cell;
  JogOptions jog;
  bool yes = false;
};

/// A person at a terminal says "move", or whoever wrote --yes has said so.
void RequireWord(const JogVerb& verb, const std::string& address) {
  if (verb.yes) return;
  if (::isatty(STDIN_FILENO) != 1) {
    throw Error(ErrorKind::kUsage,
                "jog: nobody is at a terminal to say that the arm may move; allowed is a person "
                "there, or --yes from one who sees the arm; nothing was sent");
  }
  std::fprintf(stderr,
               "Joint %d of the arm at %s will turn by %s degrees; nothing looks for collisions. "
               "When nobody is near, type 'move': ",
               verb.jog.joint, ForTerminal(address).c_str(), Number(verb.jog.degrees).c_str());
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "move") throw Error(ErrorKind::kInterrupted, "jog: not moved");
}

int RunJog(const JogVerb& verb, const Common& common) {
  const Scenario scenario = LoadScenario({verb.cell}, common);
  scenario.cell.ValidateOrThrow();
  RequireSoundCell(scenario, common);
  const CellConfig::Arm& role = scenario.cell.arm;
  if (!role.IsDevice()) {
    throw Error(ErrorKind::kConfig, "cell.arm.driver: is '" + role.driver +
                                        "', jog moves a device; allowed is a cell file with one");
  }
  RequireArmed(scenario);
  const DeviceLock lock(DeviceToOwn("arm", role));
  RequireWord(verb, role.Chosen().Address());
  WallClock clock(scenario.rate);
  const CellModel model = ScenarioModel(scenario);
  JogOptions options = verb.jog;
  options.stop_requested = StopOnSignals();
  const auto arm = role.Connect(ScenarioContext(scenario, model, clock, CellPurpose::kRun));
  const JointVector q = Jog(*arm, model.arm, clock, options);
  if (common.json) {
    Json joints = Json::array();
    for (const double angle : q) joints.push_back(Degrees(angle));
    PrintJson(Json{{"joints_deg", joints}});
    return 0;
  }
  Print("joints");
  for (const double angle : q) Print(" %.3f", Degrees(angle));
  Print(" degrees\n");
  return 0;
}

}  // namespace

void AddDoctorVerb(CLI::App& app, Common& common) {
  CLI::App* verb = app.add_subcommand(
      "doctor",
      "Example: tubetwin doctor --cell cell.toml\n\nWhat is missing on this machine, with the fix; "
      "or, with a cell file, what each of its devices says. Moves nothing.");
  auto cell_file = std::make_shared<std::string>();
  verb->add_option("--cell", *cell_file, "Cell file (TOML): read its devices");
  AddCommonOptions(*verb, common, {"cell", "calibration", "bin", "scan", "pile", "part", "rate"},
                   "", false);
  verb->callback([cell_file, &common] {
    common.action = [cell_file, &common] { return Doctor(*cell_file, common); };
  });
}

void AddJogVerb(CLI::App& app, Common& common) {
  auto jog = std::make_shared<JogVerb>();
  CLI::App* verb = app.add_subcommand(
      "jog",
      "Example: tubetwin jog --cell cell.toml --joint 6 --degrees 1\n\nTurns one joint of an armed "
      "arm by up to one degree, at 1 degree/s: first contact. Asks first; looks for no collision.");
  verb->add_option("--cell", jog->cell, "Cell file (TOML)")->required();
  verb->add_option("--joint", jog->jog.joint, "1 (next to the base) to 6")->required();
  verb->add_option("--degrees", jog->jog.degrees, "-1 to 1")->capture_default_str();
  verb->add_flag("--yes", jog->yes, "Do not ask: whoever wrote it sees the arm");
  AddCommonOptions(*verb, common, {"cell", "calibration", "rate"}, "", false);
  verb->callback(
      [jog, &common] { common.action = [jog, &common] { return RunJog(*jog, common); }; });
}

}  // namespace tubetwin

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
#include "twin/app/arm_to_move.h"
#include "twin/app/ask.h"
#include "twin/app/common.h"
#include "twin/live/activate_gripper.h"
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

struct DoctorOptions {
  std::string cell;
  bool activate_gripper = false, yes = false;
};

/// Activates the gripper, after asking, and says what it was like before.
void Activate(const Scenario& scenario, const DoctorOptions& doctor, const Common& common) {
  const auto ask = [&](const std::string& address) {
    RequireWord(
        {"doctor --activate-gripper", "the fingers may move",
         "The fingers of the gripper at " + address + " will open and close once.", "activate"},
        doctor.yes);
  };
  const auto confirm = [&](const std::string& what) {
    if (::isatty(STDIN_FILENO) != 1) return false;
    std::fprintf(stderr, "%s. When nothing is between the fingers, type 'empty': ",
                 ForTerminal(what).c_str());
    std::string answer;
    std::getline(std::cin, answer);
    return answer == "empty";
  };
  const ActivatedGripper done = ActivateGripper(scenario, ask, confirm);
  Say(common, "gripper: was " + Said(done.before) +
                  (done.before.activated ? "; nothing was moved" : "; is " + Said(done.after)));
}

int Doctor(const DoctorOptions& doctor, const Common& common) {
  const std::string& cell_file = doctor.cell;
  if (doctor.activate_gripper && cell_file.empty()) {
    throw Error(ErrorKind::kUsage,
                "--activate-gripper needs --cell CELL.toml, which says where the gripper is");
  }
  if (doctor.yes && !doctor.activate_gripper) {
    throw Error(ErrorKind::kUsage, "--yes answers --activate-gripper; doctor asks nothing else");
  }
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
      if (doctor.activate_gripper) Activate(scenario, doctor, common);
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

int RunJog(const JogVerb& verb, const Common& common) {
  const Scenario scenario = LoadCellToMove(verb.cell, "jog", common);
  const CellConfig::Arm& role = scenario.cell.arm;
  const DeviceLock lock(DeviceToOwn("arm", role));
  RequireWord(
      {"jog", "the arm may move",
       "Joint " + std::to_string(verb.jog.joint) + " of the arm at " + role.Chosen().Address() +
           " will turn by " + Number(verb.jog.degrees) + " degrees; nothing looks for collisions.",
       "move"},
      verb.yes);
  WallClock clock(scenario.rate);
  const CellModel model = ScenarioModel(scenario);
  JogOptions options = verb.jog;
  options.stop_requested = StopOnSignals();
  const auto arm = role.Connect(ScenarioContext(scenario, model, clock, CellPurpose::kRun));
  const JointVector q = Jog(*arm, model.arm, clock, options);
  PrintJoints(q, common);
  return 0;
}

}  // namespace

void AddDoctorVerb(CLI::App& app, Common& common) {
  CLI::App* verb = app.add_subcommand(
      "doctor",
      "Example: tubetwin doctor --cell cell.toml\n\nWhat is missing on this machine, with the fix; "
      "or, with a cell file, what each of its devices says. Moves nothing but, when asked for, the "
      "fingers.");
  auto doctor = std::make_shared<DoctorOptions>();
  verb->add_option("--cell", doctor->cell, "Cell file (TOML): read its devices");
  verb->add_flag("--activate-gripper", doctor->activate_gripper,
                 "Activate the gripper first: its fingers open and close once; asks before");
  verb->add_flag("--yes", doctor->yes, "Do not ask: whoever wrote it sees the gripper");
  AddCommonOptions(*verb, common, {"cell", "calibration", "bin", "scan", "pile", "part", "rate"},
                   "", false);
  verb->callback(
      [doctor, &common] { common.action = [doctor, &common] { return Doctor(*doctor, common); }; });
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

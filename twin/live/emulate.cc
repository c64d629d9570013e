#include "twin/live/emulate.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "hw_bridge/cell/wall_clock.h"
#include "hw_bridge/emulators/background_task.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/live/emulated_cell.h"
#include "twin/live/fault_script.h"
#include "twin/round/folder/result_folder.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

/// A pause of the machine shorter than this is caught up; clients notice nothing worse than jitter.
constexpr TimeNs kMaxLag = std::chrono::milliseconds(40);

/// What an emulation leaves in its folder.
const std::vector<std::string> kEmulationFiles = {"cell.toml",       "events.jsonl", "gripper.tty",
                                                  "start.pile.json", "scans",        "world.json"};

/// One line per event, written by a thread of files as soon as it is free: what is there after a
/// kill is true.
class EventLog {
 public:
  EventLog(const std::string& path, const EmulatedCell& cell)
      : file_(OutputFile::Create(path)), cell_(cell) {}
  void Write(const char* kind, const std::string& what) {
    lines_ += Json{{"at_s", Seconds(cell_.now())}, {kind, what}}.dump() + "\n";
  }
  /// Once per period. Throws Error(kIo) when the disk is full.
  void Tick() {
    if (lines_.empty() || !files_.idle()) return;
    if (failure_) throw Error(*failure_);
    files_.Start([this, lines = std::exchange(lines_, {})] {
      try {
        file_.Write(lines);
      } catch (const Error& error) {
        failure_ = error;
      }
    });
  }
  /// Until all is written.
  void Finish() {
    while (!lines_.empty() || !files_.idle()) {
      Tick();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (failure_) throw Error(*failure_);
  }

 private:
  // Of the thread of files while it works.
  OutputFile file_;
  std::optional<Error> failure_;
  const EmulatedCell& cell_;
  std::string lines_;
  BackgroundTask files_;  ///< Last: ends before what it uses.
};

/// What `run --cell` needs of the scenario to find this cell.
std::string CellFile(const EmulatedCell& cell, const Scenario& scenario, const Pile& pile) {
  Scenario reaching = cell.Reaching();
  reaching.bin.size_m.assign(pile.bin.size_m.begin(), pile.bin.size_m.end());
  reaching.bin.mesh.clear();
  reaching.bin.mesh_units.clear();
  // The file is read from another folder.
  std::string& model = reaching.cell.model;
  if (model.ends_with(".toml")) model = fs::absolute(model).string();
  reaching.part.name = scenario.pile.part.empty() && scenario.part.name.empty()
                           ? pile.part.name
                           : ScenarioPartName(scenario);
  return WriteToml(
      [&](ConfigVisitor& v) {
        v.Field("rate", "times the wall's time", reaching.rate);
        v.Section("bin", "the bin", reaching.bin);
        v.Section("part", "the part", reaching.part);
        v.Section("calibration", "how the tools hang on the flange", reaching.calibration);
        v.Section("cell", "which devices", reaching.cell);
      },
      false);
}

bool Ended(const EmulateOptions& options, const EmulatedCell& cell) {
  if (options.for_s > 0.0 && Seconds(cell.now()) >= options.for_s) return true;
  return options.stop_requested && options.stop_requested();
}

/// What is emulated are the controllers of these devices.
void RequireSpoken(const CellModel& model) {
  const auto refuse = [&](const char* role, const std::string& device, const char* controller) {
    throw Error(ErrorKind::kConfig, "emulate: the cell model's " + std::string(role) + " is a " +
                                        device +
                                        ", whose controller is not emulated; allowed are " + role +
                                        "s whose file says controller = \"" + controller + "\"");
  };
  if (model.arm.controller != "motoros") refuse("arm", model.arm.name, "motoros");
  if (model.gripper.controller != "robotiq") refuse("gripper", model.gripper.name, "robotiq");
}

}  // namespace

EmulateResult Emulate(const Scenario& scenario, const EmulateOptions& options) {
  FaultScript script(options.faults_file.empty() ? std::vector<ScriptedFault>()
                                                 : ReadFaultScript(options.faults_file));
  RequireSpoken(ScenarioModel(scenario));
  const fs::path out = fs::absolute(options.out_folder);
  ResultFolder folder(out.string(), {"emulate", kEmulationFiles, false});
  // Whoever waits for it must not find that of an earlier emulation.
  folder.Begin({});
  const Pile asked = ScenarioPile(scenario);
  const RoundPhysics physics = ScenarioPhysics(scenario, asked.part);
  const Pile pile = StartPile(scenario, asked, physics);
  SavePile(pile, (out / "start.pile.json").string());
  TwinCell twin(pile, ScenarioTwin(scenario, physics, options.parallelism));
  EmulatedCell cell(twin, scenario,
                    {options.listen, options.any_ports, out.string(), options.gige});
  EventLog log((out / "events.jsonl").string(), cell);
  cell.OnMoment([&](const std::string& moment) {
    log.Write("event", moment);
    script.Hear(moment, cell.now());
  });
  WriteFileAtomically((out / "cell.toml").string(), CellFile(cell, scenario, pile));
  if (options.progress) options.progress((out / "cell.toml").string());

  // Faster than real time it may be busy without a pause, and would leave nothing to the others.
  if (scenario.rate <= 1.0) KeepTime();
  const auto began = std::chrono::steady_clock::now();
  Pace pace(scenario.rate, FromSeconds(Seconds(kMaxLag) * scenario.rate));
  while (!Ended(options, cell)) {
    const TimeNs next = cell.now() + kControlPeriod;
    if (pace.Due(cell.now()) < next) {
      cell.Poll();
      std::this_thread::sleep_for(pace.Until(next));
      continue;
    }
    cell.Step();
    log.Tick();
    for (const std::string& line : script.Act(cell, cell.now())) {
      log.Write("fault", line);
      if (options.progress) options.progress(line);
    }
  }
  log.Finish();
  WriteJsonFile(WhatLiesWhere(twin), (out / "world.json").string());
  folder.End(Json{{"schema", "tubetwin/manifest/1"}}, kEmulationFiles);
  EmulateResult result;
  result.cell_s = Seconds(cell.now());
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result.overruns = pace.overruns();
  result.worst_lag_s = Seconds(pace.worst_lag());
  result.stretched_s = Seconds(pace.given_in());
  result.faults = script.done();
  return result;
}

}  // namespace tubetwin

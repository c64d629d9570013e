#pragma once

#include <functional>
#include <string>

#include "models/base/parallel.h"
#include "twin/round/scenario.h"

namespace tubetwin {

struct EmulateOptions {
  std::string out_folder;
  std::string listen = "127.0.0.1";
  bool any_ports = false;   ///< Free ports instead of those of [cell.*].
  bool gige = false;        ///< The scanner on GigE Vision instead of a folder of scans.
  std::string faults_file;  ///< Fault script; empty: nothing happens.
  double for_s = 0.0;       ///< Ends after so much cell time; 0: when asked to.
  Parallelism parallelism = Parallelism::All();
  std::function<bool()> stop_requested;
  std::function<void(const std::string&)> progress;  ///< A line of what happens; may be empty.
};

/// How an emulation went.
struct EmulateResult {
  double cell_s = 0.0, wall_s = 0.0;
  int overruns = 0;          ///< How often the clocks had to stretch.
  double worst_lag_s = 0.0;  ///< Cell time.
  double stretched_s = 0.0;  ///< Cell time by which the clocks are late in the end.
  int faults = 0;            ///< Of the script, that have begun.
};

/// Serves a twin of the scenario on the devices' wire protocols, in real time times its `rate`,
/// until asked to stop. The folder gets events.jsonl (moments of the cycle, motions, faults: one
/// line each as they come), scans/, start.pile.json, cell.toml last, when every port listens, and
/// at the end world.json: what lies where, by truth. When the machine is too slow all clocks
/// stretch together. Throws Error(kDevice) when a port cannot be had, Error(kCannotCreate) when
/// another emulation fills the folder or files there are not an emulation's, and as ScenarioPile
/// and ReadFaultScript do.
EmulateResult Emulate(const Scenario& scenario, const EmulateOptions& options);

}  // namespace tubetwin

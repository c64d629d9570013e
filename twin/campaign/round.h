#pragma once

#include <functional>
#include <string>

#include "hw_bridge/base/json.h"
#include "hw_bridge/base/parallel.h"
#include "twin/campaign/scenario.h"

namespace tubetwin {

struct RoundOptions {
  std::string out_folder;
  std::string scenario_folder = ".";  ///< What relative file names in the scenario refer to.
  Parallelism parallelism = Parallelism::All();
  bool video = false;
  bool force = false;  ///< Replace rows of another configuration.
  std::string program_version;
  std::function<void(const std::string&)>
      progress;  ///< One line of where the round is; may be empty.
  std::function<bool()> stop_requested;
};

/// What a round came to: the content of summary.json.
struct RoundResult {
  Json summary;
  bool interrupted = false;
};

/// Runs one whole round in the twin and writes the result folder (design.md 7): wires cell, cycle
/// and evaluator, and alone scores by truth. Same scenario, same bytes in every file but
/// manifest.json, timings.jsonl and the film. Throws Error(kCannotCreate) when the folder holds
/// rows of another configuration, before anything is written; and what settling, devices and files
/// throw.
RoundResult RunRound(const Scenario& scenario, const RoundOptions& options);

}  // namespace tubetwin

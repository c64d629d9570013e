#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/base/parallel.h"
#include "perception/scene/tube_scene.h"
#include "scenes/pile.h"
#include "twin/app/command_line/terminal.h"
#include "twin/app/command_line/used_keys.h"
#include "twin/round/scenario.h"

namespace CLI {
class App;
}

namespace tubetwin {

/// Options that every verb understands, and what the chosen verb does when parsing is over.
struct Common {
  std::vector<std::string> overrides;  ///< --set a.b=value
  int threads = 0;                     ///< 0: all cores.
  std::optional<std::int64_t> seed;
  std::string out;
  bool json = false, verbose = false, quiet = false;
  std::string verb;             ///< The chosen one, "tubetwin scan".
  UsedKeys used_keys;           ///< Those of it that --set may name.
  std::function<int()> action;  ///< Returns the exit code.

  Parallelism parallelism() const {
    return threads > 0 ? Parallelism{threads} : Parallelism::All();
  }
};

/// Adds --set, --threads, --seed, --out, --json, -v, -q to a verb. `used_keys`: what --set may
/// name, all else is refused (RefuseUnusedKeys). `out_doc` empty: no --out; `out_required`: refused
/// without it.
void AddCommonOptions(CLI::App& verb, Common& common, const UsedKeys& used_keys,
                      const std::string& out_doc, bool out_required);

/// Where a verb uses other keys for one kind of input than for another: refuses all but `used`.
void RequireUsedKeys(const Common& common, const UsedKeys& used, const std::string& for_what);

/// What --part and --bin of a verb that reads a pile say, else the keys of the scenario; where a
/// part replaces what the file says, that is told.
PileOverrides GivenPile(const std::string& part, const std::string& bin, const Scenario& scenario,
                        const Common& common);

/// Scenario from the defaults of its profile, `files` in order, then --set and --seed. `profile`:
/// what
/// --profile says; empty: what the layers say.
Scenario LoadScenario(const std::vector<std::string>& files, const Common& common,
                      const std::string& profile = "");

/// From here on SIGTERM, SIGINT and SIGHUP only ask for an end; the function tells whether they
/// have. SIGHUP stays ignored where it was (nohup).
std::function<bool()> StopOnSignals();
/// Whether more than one has come since: whoever asks twice wants the arm to stand.
bool StopAtOnceOnSignals();

/// A line to stderr unless quiet.
void Say(const Common& common, const std::string& line);

/// Checks the scenario's cell (CheckScenario): doubts are said, an impossible one throws
/// Error(kConfig).
void RequireSoundCell(const Scenario& scenario, const Common& common);

/// One-line progress on a terminal's stderr, overwritten in place; nothing when stderr is no
/// terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool enabled);
  ~ProgressLine();
  void Show(const std::string& text);
  void Clear();  ///< Before something else is written to stderr.
  bool enabled() const { return enabled_; }

 private:
  bool enabled_;
};

/// A pile's own centerlines as a scene: every tube seen whole.
TubeScene SceneOfPile(const Pile& pile);

// The verbs; each adds itself to the program.
void AddRunVerb(CLI::App& app, Common& common);
void AddPileVerb(CLI::App& app, Common& common);
void AddScanVerb(CLI::App& app, Common& common);
void AddPerceiveVerb(CLI::App& app, Common& common);
void AddPlanVerb(CLI::App& app, Common& common);
void AddEvaluateVerb(CLI::App& app, Common& common);
void AddCampaignVerb(CLI::App& app, Common& common);
void AddReproduceVerb(CLI::App& app, Common& common);
void AddEmulateVerb(CLI::App& app, Common& common);
void AddReplayVerb(CLI::App& app, Common& common);
void AddRenderVerb(CLI::App& app, Common& common);
void AddPartVerb(CLI::App& app, Common& common);
void AddDoctorVerb(CLI::App& app, Common& common);
void AddJogVerb(CLI::App& app, Common& common);
void AddHomeVerb(CLI::App& app, Common& common);
void AddCalibrateVerb(CLI::App& app, Common& common);
void AddConfigVerb(CLI::App& app, Common& common);

}  // namespace tubetwin

#include "twin/app/common.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/text.h"
#include "twin/app/command_line/suggest.h"
#include "twin/round/scenario_check.h"

namespace tubetwin {
namespace {

volatile std::sig_atomic_t g_stop = 0;  // Signal handlers may touch nothing else.

}  // namespace

void AddCommonOptions(CLI::App& verb, Common& common, const UsedKeys& used_keys,
                      const std::string& out_doc, bool out_required) {
  verb.preparse_callback([&verb, &common, used_keys](std::size_t) {
    common.verb = FullName(verb);
    common.used_keys = used_keys;
  });
  verb.add_option("--set", common.overrides, "Override a configuration key: a.b=value (repeatable)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--threads", common.threads, "Worker threads; results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  verb.add_option("--seed", common.seed, "Seed of everything random")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{9007199254740991}))
      ->type_name("N");
  if (!out_doc.empty()) {
    auto* option = verb.add_option("--out", common.out, out_doc)->type_name("PATH");
    if (out_required) option->required();
  }
  verb.add_flag("--json", common.json, "Print JSON instead of a table");
  verb.add_flag("-v,--verbose", common.verbose, "Say more");
  verb.add_flag("-q,--quiet", common.quiet, "Say nothing but errors");
}

void RequireUsedKeys(const Common& common, const UsedKeys& used, const std::string& for_what) {
  RefuseUnusedKeys(common.overrides, used, common.verb + " " + for_what);
}

PileOverrides GivenPile(const std::string& part, const std::string& bin, const Scenario& scenario,
                        const Common& common) {
  PileOverrides out = AskedOverrides(scenario);
  if (!part.empty()) out.part = part;
  if (!bin.empty()) out.bin_size_m = ParseBinSize(bin);
  out.tell = [&common](const std::string& text) { Say(common, text); };
  return out;
}

void RequireSoundCell(const Scenario& scenario, const Common& common) {
  std::error_code unknown;  // What cannot be looked at is read, which says why.
  if (!scenario.pile.file.empty() && !std::filesystem::is_directory(scenario.pile.file, unknown)) {
    PileOverrides given = AskedOverrides(scenario);
    given.tell = [&common](const std::string& text) { Say(common, text); };
    LoadPile(scenario.pile.file, given);
  }
  const std::vector<Finding> cell = CheckScenario(scenario);
  const std::vector<Finding> part = CheckScenarioPart(scenario);
  RequirePossible(cell);
  RequirePossible(part, "the part", ErrorKind::kBadData);
  for (const auto* findings : {&cell, &part}) {
    for (const Finding& finding : *findings) {
      if (finding.verdict != Finding::Verdict::kDoubtful) continue;
      Say(common, "doubtful: " + finding.what + ": " + finding.found + "; " + finding.allowed +
                      "; " + finding.remedy);
    }
  }
}

Scenario LoadScenario(const std::vector<std::string>& files, const Common& common,
                      const std::string& profile) {
  ConfigSource source;
  for (const std::string& file : files) source.AddFile(file);
  for (const std::string& text : common.overrides) source.AddOverride(text);
  Scenario scenario = ReadScenario(source, profile);
  if (common.seed) scenario.seed = *common.seed;
  return scenario;
}

std::function<bool()> StopOnSignals() {
  const auto count = [](int) { g_stop = g_stop == 0 ? 1 : 2; };
  std::signal(SIGTERM, count);
  std::signal(SIGINT, count);
  // A terminal that closes asks for an end, and only once however often it says so; unless `nohup`
  // said that it does not.
  const auto hang_up = [](int) { g_stop = g_stop == 0 ? 1 : g_stop; };
  if (std::signal(SIGHUP, hang_up) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return [] { return g_stop != 0; };
}

bool StopAtOnceOnSignals() { return g_stop > 1; }

void Say(const Common& common, const std::string& line) {
  if (!common.quiet) std::fprintf(stderr, "%s\n", ForTerminal(line).c_str());
}

ProgressLine::ProgressLine(bool enabled) : enabled_(enabled && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() { Clear(); }

void ProgressLine::Clear() {
  if (enabled_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::Show(const std::string& text) {
  if (enabled_) std::fprintf(stderr, "\r\033[K%s", Printable(text.substr(0, 120)).c_str());
}

TubeScene SceneOfPile(const Pile& pile) {
  TubeScene scene;
  double radius_m = pile.part.radius_m;
  for (const PileTube& tube : pile.tubes) {
    PerceivedTube seen;
    seen.id = tube.id;
    seen.centerline_N = tube.centerline_N;
    seen.radius_m = tube.radius_m;
    seen.length_m = Length(tube.centerline_N);
    seen.visible_fraction = 1.0;
    seen.confidence = 1.0;
    seen.node_visible.assign(tube.centerline_N.size(), 1);
    radius_m = tube.radius_m;
    scene.tubes.push_back(std::move(seen));
  }
  AssignClasses(scene, radius_m);
  return scene;
}

}  // namespace tubetwin

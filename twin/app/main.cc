#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "twin/app/common.h"
#include "twin/app/suggest.h"

namespace tubetwin {
namespace {

constexpr const char* kDescription =
    "Example: tubetwin run --seed 1 --video --out out/first\n\n"
    "A digital twin of a robotic cell that empties a bin of entangled tubes, and the picking\n"
    "pipeline itself. `tubetwin help VERB` shows a verb with an example.";

int Run(int argc, char** argv) {
  CLI::App app(kDescription, "tubetwin");
  app.set_version_flag("--version", std::string("tubetwin ") + TUBETWIN_VERSION);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default(false);
  Common common;
  AddRunVerb(app, common);
  AddPileVerb(app, common);
  AddScanVerb(app, common);
  AddPerceiveVerb(app, common);
  AddPlanVerb(app, common);
  AddEvaluateVerb(app, common);
  AddCampaignVerb(app, common);
  AddReproduceVerb(app, common);
  AddEmulateVerb(app, common);
  AddReplayVerb(app, common);
  AddRenderVerb(app, common);
  AddPartVerb(app, common);
  AddDoctorVerb(app, common);
  AddJogVerb(app, common);
  AddConfigVerb(app, common);
  std::vector<std::string> words = HelpWords({argv + 1, argv + argc});
  const auto refuse = [](const std::string& why) {
    std::fprintf(stderr, "tubetwin: %s\nTry `tubetwin help`, or `tubetwin help VERB`.\n",
                 why.c_str());
    return static_cast<int>(ErrorKind::kUsage);
  };
  // The parser's own words name neither verbs nor options.
  if (const std::string why = MisspeltVerb(app, words); !why.empty()) return refuse(why);
  try {
    // It takes the last word first.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    const std::string why = MisspeltOption(app, words);
    return refuse(why.empty() ? e.what() : why);
  }
  return common.action();
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  try {
    return tubetwin::Run(argc, argv);
  } catch (const tubetwin::Error& e) {
    std::fprintf(stderr, "tubetwin: %s\n", e.what());
    return static_cast<int>(e.kind());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "tubetwin: internal error: %s\n", e.what());
    return static_cast<int>(tubetwin::ErrorKind::kInternal);
  }
}

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/text.h"
#include "twin/app/common.h"

namespace tubetwin {
namespace {

constexpr const char* kDescription =
    "Example: tubetwin run --seed 1 --video --out out/first\n\n"
    "A digital twin of a robotic cell that empties a bin of entangled tubes, and the picking\n"
    "pipeline itself. `tubetwin VERB --help` shows a verb with an example.";

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
  AddConfigVerb(app, common);
  if (argc > 1 && argv[1][0] != '-') {  // The parser's own words name no verb.
    std::vector<std::string> verbs;
    for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
    if (std::find(verbs.begin(), verbs.end(), argv[1]) == verbs.end()) {
      std::fprintf(stderr, "tubetwin: no verb is called '%s'; nearest: '%s'; there are %s\n",
                   argv[1], NearestName(argv[1], verbs).c_str(), Join(verbs).c_str());
      return static_cast<int>(ErrorKind::kUsage);
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::fprintf(stderr, "tubetwin: %s\nTry `tubetwin --help`, or --help after a verb.\n",
                 e.what());
    return static_cast<int>(ErrorKind::kUsage);
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

#include <cstdio>
#include <fstream>

#include <CLI/CLI.hpp>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/json.h"
#include "hw_bridge/base/text.h"
#include "scenes/engine/engine_error.h"
#include "twin/app/common.h"
#include "twin/render/gl/egl_context.h"

namespace tubetwin {
namespace {

struct Finding {
  std::string what, state, fix;  ///< Empty fix: fine.
};

std::vector<Finding> Examine() {
  std::vector<Finding> out;
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

int Doctor(const Common& common) {
  const std::vector<Finding> findings = Examine();
  int missing = 0;
  Json json = Json::array();
  for (const Finding& f : findings) {
    missing += !f.fix.empty();
    json.push_back(Json{{"what", f.what}, {"state", f.state}, {"fix", f.fix}});
    if (!common.json) {
      std::printf("%-26s %s%s%s\n", f.what.c_str(), f.state.c_str(),
                  f.fix.empty() ? "" : "\n    fix: ", f.fix.c_str());
    }
  }
  if (common.json) std::printf("%s\n", json.dump(2).c_str());
  return missing == 0 ? 0 : static_cast<int>(ErrorKind::kDevice);
}

}  // namespace

void AddDoctorVerb(CLI::App& app, Common& common) {
  CLI::App* verb = app.add_subcommand(
      "doctor", "Example: tubetwin doctor\n\nWhat is missing on this machine, with the fix.");
  AddCommonOptions(*verb, common, "", false);
  verb->callback([&common] { common.action = [&common] { return Doctor(common); }; });
}

void AddConfigVerb(CLI::App& app, Common& common) {
  CLI::App* config = app.add_subcommand(
      "config",
      "Example: tubetwin config dump --set pile.count=10\n\nChecks and shows configuration.");
  config->require_subcommand(1);
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* check = config->add_subcommand("check", "Example: tubetwin config check my.toml");
  check->add_option("file", *files, "Scenario and cell files, later ones override")->required();
  AddCommonOptions(*check, common, "", false);
  check->callback([files, &common] {
    common.action = [files, &common] {
      LoadScenario(*files, common);
      Say(common, "no problem found");
      return 0;
    };
  });
  auto dumped = std::make_shared<std::vector<std::string>>();
  CLI::App* dump = config->add_subcommand("dump",
                                          "Example: tubetwin config dump my.toml\n\nEvery key "
                                          "with its value and meaning, as TOML.");
  dump->add_option("file", *dumped, "Scenario and cell files, later ones override");
  AddCommonOptions(*dump, common, "", false);
  dump->callback([dumped, &common] {
    common.action = [dumped, &common] {
      Scenario scenario = LoadScenario(*dumped, common);
      std::printf("%s", WriteToml([&](ConfigVisitor& v) { scenario.Visit(v); }, true).c_str());
      return 0;
    };
  });
  CLI::App* schema =
      config->add_subcommand("schema", "Example: tubetwin config schema > schema.json");
  AddCommonOptions(*schema, common, "", false);
  schema->callback([&common] {
    common.action = [] {
      Scenario scenario;
      std::printf("%s\n", WriteConfigSchema([&](ConfigVisitor& v) { scenario.Visit(v); }).c_str());
      return 0;
    };
  });
}

}  // namespace tubetwin

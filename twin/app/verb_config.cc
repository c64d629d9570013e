#include <cstdio>
#include <fstream>

#include <CLI/CLI.hpp>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/text.h"
#include "models/gripper_spec.h"
#include "scenes/engine/engine_error.h"
#include "twin/app/common.h"
#include "twin/render/gl/egl_context.h"

namespace tubetwin {
namespace {

int CheckPart(const std::string& file, const Common& common) {
  const Part part = LoadPart(file);
  const GripperSpec gripper;
  if (2 * part.radius_m + 0.008 > gripper.stroke_m) {
    throw Error(ErrorKind::kBadData, file + ": radius_m = " + Number(part.radius_m) +
                                         ": the gripper opens " + Number(gripper.stroke_m) +
                                         " m; at most " + Number(0.5 * (gripper.stroke_m - 0.008)));
  }
  if (common.json) {
    std::printf("%s\n", PartToJson(part).dump(2).c_str());
    return 0;
  }
  const double weight_N = part.mass_kg * kGravity;
  std::printf("%s: %s, radius %s m, length %s m, %s kg\n", part.name.c_str(), part.kind.c_str(),
              Number(part.radius_m).c_str(), Number(part.length_m).c_str(),
              Number(part.mass_kg).c_str());
  std::printf("weight %.3f N = %.0f steps of the force sensor (1/40 N)\n", weight_N,
              weight_N * 40.0);
  if (part.is_hose()) {
    const double half = 0.5 * part.length_m;
    std::printf("held in the middle each half sags %.1f mm (beam, EI %s N m^2)\n",
                1e3 * weight_N / part.length_m * half * half * half * half /
                    (8 * part.bending_stiffness_Nm2),
                Number(part.bending_stiffness_Nm2).c_str());
  }
  if (weight_N < 10.0 / 40.0) {
    std::printf("warning: lighter than 10 sensor steps, one and two tubes may not be told apart\n");
  }
  return 0;
}

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

void AddPartVerb(CLI::App& app, Common& common) {
  CLI::App* part = app.add_subcommand("part",
                                      "Example: tubetwin part check my_tube.toml\n\n"
                                      "A user's own tube.");
  part->require_subcommand(1);
  auto file = std::make_shared<std::string>();
  CLI::App* check = part->add_subcommand(
      "check",
      "Example: tubetwin part check my_tube.toml\n\nReads a part, checks it, says what it "
      "means for sensor and gripper.");
  check->add_option("part", *file, "Part file (TOML) or name")->required();
  AddCommonOptions(*check, common, "", false);
  check->callback(
      [file, &common] { common.action = [file, &common] { return CheckPart(*file, common); }; });
}

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

// First contact with a cell: where scanner and bin are, measured.

#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/config/config_edit.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "twin/app/calibrate/take_view.h"
#include "twin/app/calibrate/views_file.h"
#include "twin/app/command_line/terminal.h"
#include "twin/app/common.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

struct CalibrateOptions {
  std::string cell, views, units, on;
  std::vector<double> tip_m;
  bool in_place = false;
};

/// What a calibration says and where it is written.
struct Found {
  Calibration result;
  TomlNumbers key;
  std::string note;  ///< For stderr; empty: none.
};

std::vector<double> Rounded(const std::vector<double>& values, double per_unit) {
  std::vector<double> out;
  for (const double value : values) out.push_back(std::round(value * per_unit) / per_unit);
  return out;
}

/// Place to a micrometre; the quaternion with w >= 0.
std::vector<double> PoseList(const RigidTransform& X) {
  std::vector<double> out =
      Rounded({X.translation().x(), X.translation().y(), X.translation().z()}, 1e6);
  auto q = QuaternionWxyz(X.linear());
  if (q[0] < 0.0) {
    for (double& part : q) part = -part;
  }
  for (const double part : Rounded({q.begin(), q.end()}, 1e9)) out.push_back(part);
  return out;
}

std::vector<double> LevelPoseList(const RigidTransform& X) {
  std::vector<double> out =
      Rounded({X.translation().x(), X.translation().y(), X.translation().z()}, 1e6);
  out.push_back(Rounded({Degrees(std::atan2(X.linear()(1, 0), X.linear()(0, 0)))}, 1e5)[0]);
  return out;
}

std::string Text(const char* format, double a, double b = 0.0) {
  char text[240];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

CalibrationInput ReadInput(const CalibrateOptions& options, const Scenario& scenario) {
  const CellModel model = ScenarioModel(scenario);
  CalibrationInput input;
  input.on_stand = model.layout.scanner_mount == CellLayout::ScannerMount::kStand;
  input.X_FS = input.on_stand ? model.layout.X_BS : model.layout.X_FS;
  input.bin = ScenarioBin(scenario, std::nullopt);
  ReadViewsFile(options.views, model.arm, options.units, input);
  // A scanner on a stand is where it is, wherever the flange was.
  for (CalibrationView& view : input.views) {
    if (input.on_stand) view.X_BF = RigidTransform::Identity();
  }
  return input;
}

Found FindBin(const CalibrationInput& input, const Common& common) {
  Found out{CalibrateBin(input, common.parallelism()), {"bin", "X_BN", {}}, {}};
  out.key.values = LevelPoseList(out.result.X_BN);
  if (out.result.turned_rad > kDoubtfulTurn_rad) {
    out.note = Text(
        "the bin is turned by %.0f degrees against bin.X_BN of the cell file; half a "
        "turn of it looks the same, so check which way x of N points",
        Degrees(out.result.turned_rad));
  }
  return out;
}

Found FindScanner(const CalibrationInput& input, const Common& common) {
  Found out{CalibrateHandEye(input, common.parallelism()),
            {"calibration", input.on_stand ? "X_BS" : "X_FS", {}},
            {}};
  out.key.values = PoseList(out.result.X_FS);
  const RigidTransform bin_off = input.bin.X_BN.inverse() * out.result.X_BN;
  if (out.result.turned_rad > kDoubtfulTurn_rad) {
    out.note = Text(
        "the scanner is turned by %.0f degrees against the cell file's value: check "
        "that X_BF or the joints are those of the views",
        Degrees(out.result.turned_rad));
  } else if (bin_off.translation().norm() > kMaxResidual_m || out.result.lean_rad > Radians(0.2)) {
    out.note = Text(
        "the bin is seen %.1f mm from bin.X_BN, its floor leaning by %.2f degrees: "
        "`calibrate bin` comes next",
        1e3 * bin_off.translation().norm(), Degrees(out.result.lean_rad));
  }
  return out;
}

Json ToJson(const Found& found, const std::string& written) {
  Json residuals = Json::array();
  for (const PlaneResidual& r : found.result.residuals) {
    residuals.push_back(
        Json{{"of", r.name}, {"plane", r.plane}, {"points", r.points}, {"rms_m", r.rms_m}});
  }
  return Json{{"key", found.key.table + "." + found.key.key},
              {"value", found.key.values},
              {"rms_m", found.result.rms_m},
              {"uncertainty_m", found.result.uncertainty_m},
              {"moved_m", found.result.moved_m},
              {"turned_deg", Degrees(found.result.turned_rad)},
              {"lean_deg", Degrees(found.result.lean_rad)},
              {"residuals", residuals},
              {"written", written.empty() ? Json() : Json(written)}};
}

void PrintFound(const Found& found) {
  for (const PlaneResidual& r : found.result.residuals) {
    Print("%-28s %-8s %6d points  %.3f mm\n", fs::path(r.name).filename().string().c_str(),
          r.plane.c_str(), r.points, 1e3 * r.rms_m);
  }
  std::vector<std::string> values;
  for (const double value : found.key.values) values.push_back(Number(value));
  Print("residual %.3f mm (rms; allowed %.1f mm), known to %.2f mm in the worst direction\n",
        1e3 * found.result.rms_m, 1e3 * kMaxResidual_m, 1e3 * found.result.uncertainty_m);
  Print("moved by %.2f mm and %.3f degrees\n%s.%s = [%s]\n", 1e3 * found.result.moved_m,
        Degrees(found.result.turned_rad), found.key.table.c_str(), found.key.key.c_str(),
        Join(values).c_str());
}

/// Where the result goes: the cell file itself, a new file, or nowhere (empty).
std::string Target(const CalibrateOptions& options, const Common& common) {
  if (options.in_place && !common.out.empty()) {
    throw Error(ErrorKind::kUsage,
                "--in-place changes the cell file, --out writes another: give one of them");
  }
  if (options.in_place) return fs::canonical(options.cell).string();  // Not a link to it.
  if (!common.out.empty() && fs::exists(fs::symlink_status(common.out))) {
    throw Error(ErrorKind::kCannotCreate,
                common.out +
                    ": is there already and is not overwritten; allowed is a new name, or "
                    "--in-place, which changes the cell file alone");
  }
  return common.out;
}

template <class Find>
int Calibrate(const CalibrateOptions& options, const Common& common, Find find) {
  const Scenario scenario = LoadScenario({options.cell}, common);
  const std::string target = Target(options, common);
  const std::string text = ReadFile(options.cell);
  const Found found = [&] {
    try {
      return find(ReadInput(options, scenario), common);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kBadData) throw;
      throw Error(error.kind(), ViewsFileOf(options.views) + ": " + error.what());
    }
  }();
  if (!found.note.empty()) Say(common, "note: " + found.note);
  if (!target.empty()) {
    WriteFileAtomically(target, WithTomlNumbers(text, options.cell, found.key));
    if (!options.in_place &&
        fs::absolute(target).parent_path() != fs::absolute(options.cell).parent_path()) {
      Say(common, "note: names of files in " + target + " are relative to its new folder");
    }
  }
  if (common.json) {
    PrintJson(ToJson(found, target));
    return 0;
  }
  PrintFound(found);
  Say(common, target.empty() ? "nothing was written; --out FILE or --in-place writes the cell file"
                             : "written to " + target);
  return 0;
}

int TakeOneView(const CalibrateOptions& options, const Common& common) {
  const TakenView view = TakeView(LoadScenario({options.cell}, common), common.parallelism());
  const std::string path = AddView(common.out, view.cloud, view.q);
  Print("%s\n", path.c_str());
  return 0;
}

int TakeOneTouch(const CalibrateOptions& options, const Common& common) {
  const Vector3 tip(options.tip_m[0], options.tip_m[1], options.tip_m[2]);
  if (!(tip.norm() < 2.0)) {
    throw Error(ErrorKind::kUsage, "--tip is " + Number(tip.norm()) +
                                       " m from the flange, allowed are 2; is it in millimetres?");
  }
  const Vector3 p_B = TakeTouch(LoadScenario({options.cell}, common), tip);
  AddTouch(common.out, {"", options.on == "floor", p_B});
  Print("%.6f %.6f %.6f\n", p_B.x(), p_B.y(), p_B.z());
  return 0;
}

using Options = std::shared_ptr<CalibrateOptions>;

/// A verb below `calibrate` with --cell.
template <class Run>
CLI::App* AddBelow(CLI::App& above, const char* name, const std::string& help, Common& common,
                   const Options& options, Run run) {
  CLI::App* verb = above.add_subcommand(name, help);
  verb->add_option("--cell", options->cell, "Cell file (TOML)")->required();
  verb->callback([&common, options, run] {
    common.action = [&common, options, run] { return run(*options, common); };
  });
  return verb;
}

template <class Find>
void AddFinding(CLI::App& above, const char* name, const std::string& help, Common& common,
                Find find) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* verb = AddBelow(above, name, help, common, options,
                            [find](const CalibrateOptions& given, const Common& all) {
                              return Calibrate(given, all, find);
                            });
  verb->add_option("--views", options->views, "Folder with views.toml, or such a file")->required();
  verb->add_option("--units", options->units,
                   "Unit of the clouds' lengths; default: what a file says, else metres")
      ->check(CLI::IsMember(LengthUnits()));
  verb->add_flag("--in-place", options->in_place, "Write the value into the cell file itself");
  AddCommonOptions(*verb, common, {"cell.model", "calibration", "bin"},
                   "New cell file with the value in it", false);
}

}  // namespace

void AddCalibrateVerb(CLI::App& app, Common& common) {
  CLI::App* verb = app.add_subcommand(
      "calibrate",
      "Example: tubetwin calibrate hand-eye --cell cell.toml --views out/views --in-place\n\n"
      "Finds where scanner and bin are, from clouds of the empty bin's floor and walls and from "
      "touches; shows the residual, refuses one above 1 mm. Moves nothing.");
  verb->require_subcommand(1);
  AddFinding(*verb, "hand-eye",
             "Example: tubetwin calibrate hand-eye --cell cell.toml --views out/views --in-place"
             "\n\nThe scanner on the flange (calibration.X_FS) from 3 views or more, better 8, at "
             "a differently turned and tilted flange; a scanner on a stand (X_BS) needs touches "
             "besides.",
             common, FindScanner);
  AddFinding(*verb, "bin",
             "Example: tubetwin calibrate bin --cell cell.toml --views out/views --out new.toml"
             "\n\nThe bin in the arm's base (bin.X_BN) from views, with the scanner where the cell "
             "file says, or from 3 touches of the floor and 4 of walls.",
             common, FindBin);
  const auto view = std::make_shared<CalibrateOptions>();
  CLI::App* take = AddBelow(*verb, "view",
                            "Example: tubetwin calibrate view --cell cell.toml --out out/views\n\n"
                            "Scans from where the arm stands and adds cloud and joints to the "
                            "folder's views.toml. Moves nothing.",
                            common, view, TakeOneView);
  AddCommonOptions(
      *take, common,
      {"cell", "calibration", "bin", "pile", "part", "physics", "scan", "seed", "rate"},
      "Folder of views", true);
  const auto touch = std::make_shared<CalibrateOptions>();
  CLI::App* tip = AddBelow(*verb, "touch",
                           "Example: tubetwin calibrate touch --cell cell.toml --tip 0,0,0.2 --on "
                           "floor --out out/views\n\nThe arm's tool touches floor or wall: adds "
                           "where its tip is to the folder's views.toml. Moves nothing.",
                           common, touch, TakeOneTouch);
  tip->add_option("--tip", touch->tip_m, "Tip of the tool on the flange: x,y,z in metres")
      ->delimiter(',')
      ->expected(3)
      ->required();
  tip->add_option("--on", touch->on, "What it touches")
      ->check(CLI::IsMember({"floor", "wall"}))
      ->required();
  AddCommonOptions(*tip, common, {"cell", "rate"}, "Folder of touches", true);
}

}  // namespace tubetwin

// `tubetwin calibrate` as a commissioning engineer meets it: a folder of views, a cell file.

#include <filesystem>

#include "models/base/config/config.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "tests/support/calibration_cell.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::CalibrationCell;

const std::string kCell =
    "# our cell, set up on Monday\n[calibration]\nX_FS = [0.004, 0.112, 0.031, 1, 0, 0, 0]  # by "
    "the drawing\n\n[bin]\nX_BN = [0.61, -0.01, 0.105, 88.0] # by tape\n";

std::string PoseText(const RigidTransform& X) {
  std::string out = "[";
  for (const double p : X.translation()) out += Number(p) + ", ";
  const auto q = QuaternionWxyz(X.linear());
  return out + Number(q[0]) + ", " + Number(q[1]) + ", " + Number(q[2]) + ", " + Number(q[3]) + "]";
}

/// A folder "views" of `count` clouds and a cell file that is off.
void WriteViews(const TemporaryFolder& folder, const CalibrationInput& input) {
  std::string text;
  fs::create_directories(folder / "views");
  for (const CalibrationView& view : input.views) {
    WritePcd(view.cloud, folder / ("views/" + view.name));
    text += "[[view]]\ncloud = \"" + view.name + "\"\nX_BF = " + PoseText(view.X_BF) + "\n";
  }
  WriteFileAtomically(folder / "views/views.toml", text);
  WriteFileAtomically(folder / "cell.toml", kCell);
}

std::vector<double> NumbersOf(const std::string& file, const std::string& table,
                              const std::string& key) {
  ConfigSource source;
  source.AddFile(file);
  std::vector<double> out;
  for (const auto& [name, value] : source.Texts()) {
    if (name != table + "." + key) continue;
    ConfigSource list;
    list.AddText("v = " + value, "list");
    list.Read([&](ConfigVisitor& v) { v.Field("v", "", out); });
  }
  return out;
}

TEST_CASE("Scanner and bin are calibrated into the cell file, whose comments stay", "[app]") {
  const TemporaryFolder folder;
  const CalibrationCell cell(11);
  WriteViews(folder, cell.Views(6, 20.0));
  const Outcome shown = RunProgram(folder, "calibrate hand-eye --cell cell.toml --views views");
  INFO(shown.out << shown.err);
  REQUIRE(shown.code == 0);
  CHECK_THAT(shown.out, Contains("view_0.pcd") && Contains("floor") && Contains("residual 0.0") &&
                            Contains("calibration.X_FS = ["));
  CHECK_THAT(shown.err, Contains("nothing was written") && Contains("`calibrate bin` comes next"));
  CHECK(ReadFile(folder / "cell.toml") == kCell);

  REQUIRE(RunProgram(folder, "calibrate hand-eye --cell cell.toml --views views --in-place").code ==
          0);
  constexpr double kClose_m = 0.0003;
  const std::vector<double> X_FS = NumbersOf(folder / "cell.toml", "calibration", "X_FS");
  REQUIRE(X_FS.size() == 7);
  for (int i = 0; i < 3; ++i) {
    CHECK(X_FS[static_cast<std::size_t>(i)] == Approx(cell.X_FS.translation()[i]).margin(kClose_m));
  }
  const Outcome bin = RunProgram(
      folder, "calibrate bin --cell cell.toml --views views/views.toml --out new.toml --json");
  INFO(bin.err);
  REQUIRE(bin.code == 0);
  const Json told = Json::parse(bin.out);
  CHECK(told["key"] == "bin.X_BN");
  CHECK(told["rms_m"].get<double>() < 0.0002);
  CHECK(told["turned_deg"].get<double>() == Approx(2.0).margin(0.05));
  CHECK(told["residuals"].size() >= 12);
  const std::vector<double> X_BN = NumbersOf(folder / "new.toml", "bin", "X_BN");
  REQUIRE(X_BN.size() == 4);
  CHECK(X_BN == told["value"].get<std::vector<double>>());
  CHECK(X_BN[0] == Approx(0.60).margin(kClose_m));
  CHECK(X_BN[2] == Approx(0.10).margin(kClose_m));
  CHECK(X_BN[3] == Approx(90.0).margin(0.05));
  const std::string text = ReadFile(folder / "new.toml");
  CHECK_THAT(text, Catch::StartsWith("# our cell, set up on Monday\n[calibration]\nX_FS = [") &&
                       Contains("]  # by the drawing\n\n[bin]\nX_BN = [") &&
                       Catch::EndsWith("] # by tape\n"));
  CHECK(RunProgram(folder, "config check new.toml").code == 0);

  CheckRefused(folder, "calibrate bin --cell cell.toml --views views --out new.toml", 73,
               "new.toml: is there already");
  CheckRefused(folder, "calibrate bin --cell cell.toml --views views --out x --in-place", 64,
               "give one of them");
}

TEST_CASE("Bad views are refused, and leave the cell file as it was", "[app]") {
  const TemporaryFolder folder;
  CalibrationCell cell(12);
  cell.wall_off_m = 0.004;
  WriteViews(folder, cell.Views(4, 20.0));
  const std::string all = ReadFile(folder / "views/views.toml");
  const auto refused = [&](const std::string& verb, int code, const std::string& why) {
    CheckRefused(folder, "calibrate " + verb + " --cell cell.toml --in-place --views views", code,
                 why);
    CHECK(ReadFile(folder / "cell.toml") == kCell);
  };
  refused("bin", 65, "views.toml: ");
  refused("hand-eye", 65, "views.toml: ");
  const auto with = [&](const std::string& text) {
    WriteFileAtomically(folder / "views/views.toml", text);
  };
  with(all.substr(0, all.find("[[view]]", 1)));
  refused("hand-eye", 65, "there are 1 views, at least 3");
  with("[[view]]\ncloud = \"view_0.pcd\"\nX_FB = [1]\n");
  refused("bin", 78, "X_FB");
  with("[[view]]\ncloud = \"view_0.pcd\"\n");
  refused("bin", 78, "neither joints_deg nor X_BF is given");
  with("[[view]]\ncloud = \"view_0.pcd\"\njoints_deg = [0, 400, 0, 0, 0, 0]\n");
  refused("bin", 78, "joint 2 is at 400");
  with("[[view]]\ncloud = \"no.pcd\"\njoints_deg = [0, 0, 0, 0, 0, 0]\n");
  refused("bin", 66, "no.pcd: no such file");
  with("[[touch]]\non = \"flor\"\np_BTip = [0, 0, 0]\n");
  refused("bin", 78, "views.toml:2:6");
  with("[view]\ncloud = 1\n");
  refused("bin", 78, "view");
  with("");
  refused("bin", 65, "neither a view nor a touch");
  fs::remove(folder / "views/views.toml");
  refused("bin", 66, "views.toml");
  CheckRefused(folder, "calibrate bin --cell no.toml --views views", 66, "no.toml");
  CheckRefused(folder, "calibrate bni", 64, "nearest: 'bin'");
  CheckRefused(folder, "calibrate", 64, "");
}

TEST_CASE("The bin is calibrated by touches; an arm of the twin's touches nothing", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "cell.toml", "[bin]\nsize_m = [0.4, 0.3, 0.1]\nX_BN = [0.6, 0.0, 0.1, 0.0]\n");
  std::string touches;
  const auto touch = [&](const std::string& on, double x, double y, double z) {
    touches += "[[touch]]\non = \"" + on + "\"\np_BTip = [" + Number(0.605 + x) + ", " +
               Number(-0.01 + y) + ", " + Number(0.098 + z) + "]\n";
  };
  touch("floor", 0.15, 0.1, 0.0);
  touch("floor", -0.15, 0.1, 0.0);
  touch("floor", 0.0, -0.1, 0.0);
  touch("wall", 0.2, 0.1, 0.05);
  touch("wall", 0.2, -0.1, 0.05);
  touch("wall", 0.1, 0.15, 0.05);
  touch("wall", -0.1, 0.15, 0.05);
  Write(folder, "touches.toml", touches);
  const Outcome found =
      RunProgram(folder, "calibrate bin --cell cell.toml --views touches.toml --in-place");
  INFO(found.err);
  REQUIRE(found.code == 0);
  CHECK_THAT(found.out, Contains("bin.X_BN = [0.605, -0.01, 0.098, 0]"));
  CHECK_THAT(ReadFile(folder / "cell.toml"), Contains("X_BN = [0.605, -0.01, 0.098, 0]"));
  CheckRefused(folder, "calibrate touch --cell cell.toml --tip 0,0,0.2 --on floor --out t", 78,
               "cell.arm.driver: is 'twin'");
  CheckRefused(folder, "calibrate touch --cell cell.toml --tip 0,0,200 --on floor --out t", 64,
               "millimetres");
  CheckRefused(folder, "calibrate touch --cell cell.toml --tip 0,0,0.2 --on flor --out t", 64,
               "flor");
  CheckRefused(folder, "home --cell cell.toml", 78, "home moves a device");
  CheckRefused(folder, "doctor --activate-gripper", 64, "needs --cell");
  CheckRefused(folder, "doctor --cell cell.toml --yes", 64, "--yes answers");
  CheckRefused(folder, "doctor --cell cell.toml --activate-gripper --yes", 78,
               "which needs no activation");
}

}  // namespace
}  // namespace tubetwin

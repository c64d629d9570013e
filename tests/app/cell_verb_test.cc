// Cells as a user meets them: what is judged before anything runs, and files of one's own.

#include <filesystem>

#include "models/base/files.h"
#include "models/base/json.h"
#include "models/cell_model.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("A cell that cannot work is refused before anything is simulated", "[app]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& set, int code, const std::string& why) {
    CheckRefused(folder, "run --out o " + set, code, why);
    CHECK_FALSE(std::filesystem::exists(folder / "o"));
  };
  refused("--set bin.X_BN=[0.3,-0.6,0.1,90]", 78, "bin and tray: reach");
  refused("--set bin.X_BN=[0.6,0,-0.5,90]", 78, "bin and cell plate");
  refused("--set bin.size_m=[2.5,2.5,0.09]", 78, "the cell cannot work");
  refused("--set calibration.X_FE=[0,0,177,1,0,0,0]", 78, "millimetres: write 0, 0, 0.177");
  refused("--set bin.X_BN=[600,0,100,90]", 78, "millimetres: write 0.6, 0, 0.1");
  refused("--set calibration.X_FS=[0,0.115,0.03,2,0,0,0]", 78, "quaternion has length 2");
  CheckRefused(folder, "pile generate --part pvc_a --count 40 --bin 0.3,0.3,0.05 --out p.json", 78,
               "fill of the bin");
  CheckRefused(folder, "config check --set bin.X_BN=[600,0,100,90]", 78, "millimetres");
  CheckRefused(folder, "config check --set physics.tube_friction=[0.9,0.1]", 78,
               "the first number must not be above the second");
  CheckRefused(folder, "config check --set physics.tube_friction=[0.3]", 78, "none or two");
  CheckRefused(folder, "part check .", 66, ".: is a folder, a file is needed");
}

TEST_CASE("A part that no gripper holds is refused with 65", "[app]") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "thick.toml",
                      "name = \"thick\"\nradius_m = 0.038\nlength_m = 0.5\nmass_kg = 0.4\n");
  CheckRefused(folder, "run --part thick.toml --out o", 65, "stroke of");
  CHECK_FALSE(std::filesystem::exists(folder / "o"));
}

TEST_CASE("Shipped cells are checked with a table and no complaint", "[app]") {
  const TemporaryFolder folder;
  for (const std::string& name : CellModelNames()) {
    const Outcome outcome = RunProgram(folder, "config check --set cell.model=" + name);
    INFO(name << outcome.out << outcome.err);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.out, Contains("bin's floor reached upright"));
    CHECK_THAT(outcome.err, Contains("no problem found"));
  }
}

TEST_CASE("A shipped cell is printed, and is a cell of one's own", "[app]") {
  const TemporaryFolder folder;
  const Outcome text = RunProgram(folder, "config model ur10e");
  REQUIRE(text.code == 0);
  std::filesystem::create_directories(folder / "cells");
  WriteFileAtomically(folder / "cells/my.toml", text.out);
  WriteFileAtomically(folder / "round.toml", "[cell]\nmodel = \"cells/my.toml\"\n");
  // Relative to the file that names it, wherever the program is run; --set to where it is run.
  std::filesystem::create_directories(folder / "elsewhere");
  CHECK(RunProgram(folder, "config check round.toml").code == 0);
  CHECK(RunProgram(folder, "config check --set cell.model=cells/my.toml").code == 0);
  CheckRefused(folder, "config check --set cell.model=my.toml", 66, "my.toml: no such file");
  CheckRefused(folder, "config check cells/my.toml", 78,
               "use it by --set cell.model=cells/my.toml");
  CheckRefused(folder, "run --cell cells/my.toml --out o", 78, "is a cell model");
  CheckRefused(folder, "config model leao2002", 66, "nearest is 'leao2020'");
  CheckRefused(folder, "config check --set cell.model=leao2002", 66, "leao2020");
}

TEST_CASE("A round of one's own part and cell runs again wherever its folder is", "[app]") {
  const TemporaryFolder folder;
  const std::string cell = RunProgram(folder, "config model leao2020").out;
  const std::string arm = RunProgram(folder, "config model hc10").out;
  std::filesystem::create_directories(folder / "mine/arms");
  WriteFileAtomically(folder / "mine/arms/arm.toml", arm);
  const auto at = cell.find("arm = \"hc10\"");
  REQUIRE(at != std::string::npos);
  WriteFileAtomically(folder / "mine/cell.toml",
                      std::string(cell).replace(at, 12, "arm = \"arms/arm.toml\""));
  WriteFileAtomically(folder / "mine/part.toml",
                      "name = \"mine\"\nradius_m = 0.0125\nlength_m = 0.5\nmass_kg = 0.055\n");
  const std::string run =
      "run --part mine/part.toml --set cell.model=mine/cell.toml "
      "--set pile.count=1 --set cycle.attempts_per_tube=1 --out first -q";
  REQUIRE(RunProgram(folder, run).code == 0);
  std::filesystem::rename(folder / "first", folder / "moved");
  std::filesystem::remove_all(folder / "mine");
  const Outcome again = RunProgram(folder, "run moved/config.resolved.toml --out again -q");
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(ReadFile(folder / "moved/picks.jsonl") == ReadFile(folder / "again/picks.jsonl"));
  CHECK(ReadFile(folder / "moved/config.resolved.toml") ==
        ReadFile(folder / "again/config.resolved.toml"));
}

}  // namespace
}  // namespace tubetwin

#include "models/cell_model.h"

#include <fstream>

#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/shipped.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

/// `text` with `from`, which must be there once, replaced.
std::string With(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(from, at + 1) == std::string::npos);
  return text.replace(at, from.size(), to);
}

/// What is said about a cell file with that text.
std::string Refused(const std::string& text, ErrorKind kind = ErrorKind::kConfig) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "cell.toml", text);
  try {
    LoadCellModel(folder / "cell.toml");
  } catch (const Error& error) {
    CHECK(error.kind() == kind);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Every shipped cell is read, and its copy in a folder of its own is the same", "[unit]") {
  const std::vector<std::string> names = CellModelNames();
  CHECK(names.size() >= 3);
  for (const std::string& name : names) {
    INFO(name);
    const CellModel model = LoadCellModel(name);
    const TemporaryFolder folder;
    WriteFileAtomically(folder / "my_arm.toml", model.files.arm.text);
    const std::string arm = model.files.arm.path;  // "models/arms/NAME.toml"
    const auto slash = arm.rfind('/');
    const std::string arm_name = arm.substr(slash + 1, arm.size() - slash - 6);
    WriteFileAtomically(folder / "cell.toml",
                        With(model.files.cell.text, "arm = \"" + arm_name, "arm = \"my_arm.toml"));
    const CellModel own = LoadCellModel(folder / "cell.toml");
    CHECK(own.arm.name == model.arm.name);
    CHECK(own.layout.X_BN.matrix() == model.layout.X_BN.matrix());
    CHECK(own.gripper.stroke_m == model.gripper.stroke_m);
    const CellModel again = ReadCellModel(own.files);
    CHECK(again.layout.X_BT.matrix() == model.layout.X_BT.matrix());
    CHECK(again.scanner.name == model.scanner.name);
  }
}

TEST_CASE("The paper's cell has the paper's devices", "[unit]") {
  const CellModel model = LoadCellModel("leao2020");
  CHECK(model.arm.name == "HC10");
  CHECK(model.gripper.stroke_m == 0.085);
  CHECK(model.wrist.count[2] == 1.0 / 40.0);
  CHECK(model.wrist.count[3] == 10.0 / 13333.0);
  CHECK(model.scanner.full_width == 2064);
  CHECK(model.layout.X_FE.translation().z() == 0.177);
}

TEST_CASE("What a cell file lacks or has wrong is named with its place", "[unit]") {
  const std::string good = Shipped("cells/leao2020.toml");
  CHECK(Refused(good).empty());
  CHECK_THAT(Refused(With(good, "height_m = 0.45", "")), Contains("carry.height_m is missing"));
  CHECK_THAT(Refused(With(good, "zone_m = 0.40", "zone = 0.40")),
             Contains("cell.toml:") && Contains("tray.zone") && Contains("zone_m"));
  CHECK_THAT(Refused(With(good, "gripper = \"robotiq_2f85\"", "gripper = \"robotiq_2f58\""),
                     ErrorKind::kMissing),
             Contains("no gripper is named 'robotiq_2f58'") && Contains("robotiq_2f85"));
  CHECK_THAT(Refused(With(good, "0.115, 0.030, 1.0, 0.0, 0.0, 0.0", "0.115, 0.030, 2.0, 0, 0, 0")),
             Contains("X_FS") && Contains("length 2"));
  CHECK_THAT(Refused(With(good, "on = \"flange\"", "on = \"stand\"")), Contains("X_FS"));
  CHECK_THAT(Refused(good + "\n[[keep_out]]\nname = \"post\"\nsize_m = [1, 1, 1]\n"),
             Contains("centre_m is missing"));
  CHECK_THAT(Refused(With(good, "scanner = \"phoxi_s\"", "scanner = \"nowhere.toml\""),
                     ErrorKind::kMissing),
             Contains("nowhere.toml"));
}

TEST_CASE("A linkage stands where its rows say, mirrored for the other finger", "[unit]") {
  const GripperSpec gripper = LoadCellModel("gp12_stand").gripper;
  REQUIRE(gripper.links.size() == 1);
  const GripperSpec::Link& crank = gripper.links.front();
  for (const auto& row : crank.rows) {
    const RigidTransform X_E = LinkPose(crank, row.opening_m, +1);
    CHECK(X_E.translation().isApprox(Vector3(0, row.y_m, row.z_m)));
    const RigidTransform X_EOther = LinkPose(crank, row.opening_m, -1);
    CHECK(X_EOther.translation().isApprox(Vector3(0, -row.y_m, row.z_m)));
    // Pivots stay: 50 mm back along each crank.
    CHECK((X_E * Vector3(0, 0, -0.05) - Vector3(0, 0.0306, -0.1461)).norm() < 2e-4);
    CHECK((X_EOther * Vector3(0, 0, -0.05) - Vector3(0, -0.0306, -0.1461)).norm() < 2e-4);
  }
  const auto between = LinkPose(crank, 0.01, +1).translation();
  CHECK(between.y() == Approx(0.5 * (crank.rows[0].y_m + crank.rows[1].y_m)));
}

TEST_CASE("A scanner on a stand looks from there and does not hang on the flange", "[unit]") {
  const CellModel model = LoadCellModel("gp12_stand");
  const JointVector q = JointVector::Constant(0.3);
  CHECK(PoseOfScanner(model, q).matrix() == model.layout.X_BS.matrix());
  CHECK(ScanPosesOf(model, Bin()).size() == 1);
  for (const Shape& shape : MovingShapes(model)) CHECK_FALSE(shape.scanner);
  CHECK(StandingShapes(model).front().scanner);
}

}  // namespace tubetwin

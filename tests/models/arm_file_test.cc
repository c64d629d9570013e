#include <algorithm>

#include "models/arm/arm.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/shipped.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

/// The first `from` becomes `to`.
std::string Changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Line of the first place of `what` in the text, counted from 1.
std::string LineOf(const std::string& text, const std::string& what) {
  return std::to_string(1 + std::count(text.begin(), text.begin() + text.find(what), '\n'));
}

std::string Refusal(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder / "own.toml";
  WriteFileAtomically(path, text);
  try {
    LoadArm(path);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kConfig);
    const std::string message = error.what();
    CHECK(std::count(message.begin(), message.end(), '\n') < 4);
    CHECK(message.find(path) == 0);
    return message.substr(path.size());
  }
  FAIL("not refused");
  return "";
}

TEST_CASE("Arms that ship are found by name, others by path, and are then the same", "[unit]") {
  CHECK(ArmNames() == std::vector<std::string>{"gp12", "hc10", "ur10e"});
  const TemporaryFolder folder;
  for (const std::string& name : ArmNames()) {
    WriteFileAtomically(folder / "own.toml", Shipped("arms/" + name + ".toml"));
    const ArmModel own = LoadArm(folder / "own.toml"), shipped = LoadArm(name);
    CHECK(own.name == shipped.name);
    CHECK(FlangePose(own, own.working.q).matrix() ==
          FlangePose(shipped, shipped.working.q).matrix());
    CHECK(own.shapes.size() == shipped.shapes.size());
    CHECK(own.self_pairs == shipped.self_pairs);
  }
  CHECK(LoadArm("hc10").name == "HC10");
}

TEST_CASE("An unknown arm is refused with the nearest name", "[unit]") {
  try {
    LoadArm("ur10");
    FAIL("found");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kMissing);
    CHECK_THAT(error.what(), Catch::Matchers::Contains("nearest is 'ur10e'"));
  }
  try {
    LoadArm("nowhere/ur10e.toml");
    FAIL("found");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kMissing);
  }
}

TEST_CASE("A working posture points the tool down", "[unit]") {
  for (const std::string& name : ArmNames()) {
    const ArmModel arm = LoadArm(name);
    INFO(name);
    CHECK((FlangePose(arm, arm.working.q).linear().col(2) + Vector3::UnitZ()).norm() < 1e-12);
  }
}

TEST_CASE("Bodies that can meet are those three apart, but for those that a file says", "[unit]") {
  const std::vector<std::array<int, 2>> hc10 = {{7, 0}, {7, 1}, {7, 2}, {7, 3}, {7, 4},
                                                {6, 0}, {6, 1}, {6, 2}, {5, 0}, {5, 1},
                                                {5, 2}, {4, 0}, {4, 1}, {3, 0}};
  CHECK(LoadArm("hc10").self_pairs == hc10);
  const auto ur = LoadArm("ur10e").self_pairs;
  CHECK(std::count(ur.begin(), ur.end(), std::array{3, 1}) == 1);
  CHECK(std::count(ur.begin(), ur.end(), std::array{6, 3}) == 1);
  CHECK(ur.size() == hc10.size() + 2);
}

TEST_CASE("Figures of a shape reach its half sizes and its pose", "[unit]") {
  const ArmModel arm = LoadArm("gp12");
  const auto shape = std::find_if(arm.shapes.begin(), arm.shapes.end(),
                                  [](const Shape& s) { return s.name == "wrist"; });
  REQUIRE(shape != arm.shapes.end());
  CHECK(shape->kind == Shape::Kind::kCylinder);
  CHECK(shape->link == 5);
  CHECK(shape->size_m == Vector3(0.072, 0.075, 0));
  // Turned about y by a quarter: its axis lies along the link's x.
  CHECK((shape->X_LinkShape.linear().col(2) - Vector3::UnitX()).norm() < 1e-12);
  CHECK(arm.shapes.front().size_m == 0.5 * Vector3(0.44, 0.306, 0.175));
}

TEST_CASE("Rotations are about x, then y, then z of the frame outside", "[unit]") {
  const std::string text =
      Changed(Shipped("arms/gp12.toml"), "flange_rpy_deg = [180.0, -90.0, 0.0]",
              "flange_rpy_deg = [30.0, 40.0, 50.0]");
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "own.toml", text);
  const Matrix3 R = LoadArm(folder / "own.toml").X_6F.linear();
  const Matrix3 expected = Matrix3(Eigen::AngleAxisd(Radians(50), Vector3::UnitZ()) *
                                   Eigen::AngleAxisd(Radians(40), Vector3::UnitY()) *
                                   Eigen::AngleAxisd(Radians(30), Vector3::UnitX()));
  CHECK((R - expected).norm() < 1e-12);
}

TEST_CASE("A wrong figure is refused with its line and what is allowed", "[unit]") {
  struct Case {
    const char* from;
    const char* to;
    const char* message;
  };
  const Case cases[] = {
      {"range_deg = [-170.0, 170.0]", "range_deg = [170.0, -170.0]",
       "joint 1 (joint_1_s): range_deg is [170, -170]; the first has to be below the second"},
      {"axis = [0, 0, 1]", "axis = [0, 0, 0.9]", "axis has length 0.9, a unit vector has 1"},
      {"axis = [0, 0, 1]", "axis = [0, 1]", "axis: 3 numbers are needed, found 2"},
      {"mass_kg = 48.541", "mass_kg = 0.0", "mass_kg: is 0, allowed is 0.001 to 2000"},
      {"inertia_kgm2 = [0.4004,", "inertia_kgm2 = [-0.4004,",
       "link 0 (base_link): inertia_kgm2 has the main moments"},
      {"inertia_kgm2 = [0.4004, 0.6808, 0.8783", "inertia_kgm2 = [0.4004, 0.6808, 1.8783",
       "none is above the sum of the others"},
      {"inverse = \"spherical_wrist\"", "inverse = \"offset_wrist\"",
       "does not solve this geometry"},
      {"inverse = \"spherical_wrist\"", "inverse = \"sperical_wrist\"",
       "nearest is 'spherical_wrist'"},
      {"never_meet = [6, 3]", "never_meet = [6]", "never_meet has to hold pairs"},
      {"never_meet = [6, 3]", "never_meet = [6, 2.5]", "never_meet has to hold pairs"},
      {"kind = \"cylinder\"", "kind = \"tube\"", "kind: is \"tube\""},
      {"link = \"link_3_u\"", "link = \"link_3\"", "the nearest is 'link_3_u'"},
      {"length_m = 0.33", "size_m = [1, 1, 1]", "a cylinder has no size_m"},
      {"speed_deg_s = 260.0", "speed_rad_s = 4.5", "speed_rad_s: unknown key"}};
  for (const Case& c : cases) {
    const std::string text = Changed(Shipped("arms/gp12.toml"), c.from, c.to);
    const std::string message = Refusal(text);
    INFO(c.to);
    CHECK_THAT(message, Catch::Matchers::Contains(c.message));
    CHECK(message.find(":" + LineOf(text, c.to) + ":") == 0);
  }
}

TEST_CASE("What a file leaves out is named", "[unit]") {
  const std::string text = Shipped("arms/gp12.toml");
  CHECK_THAT(Refusal(Changed(text, "effort_Nm = 1029.0\n", "")),
             Catch::Matchers::Contains("joint 2 (joint_2_l) lacks the key effort_Nm"));
  CHECK_THAT(Refusal(Changed(text, "working_deg", "# ")),
             Catch::Matchers::Contains("the arm lacks the key working_deg"));
  CHECK_THAT(Refusal(Changed(text, "radius_m = 0.112\n", "")),
             Catch::Matchers::Contains("shape 'elbow': a cylinder needs the key radius_m"));
  const std::size_t last = text.rfind("[[joint]]");
  CHECK_THAT(Refusal(text.substr(0, last)),
             Catch::Matchers::Contains("the arm has 5 [[joint]], but 6 are needed"));
  CHECK_THAT(Refusal(Changed(text, "name = \"joint_2_l\"", "name = \"joint_1_s\"")),
             Catch::Matchers::Contains("two joints are named 'joint_1_s'"));
}

}  // namespace
}  // namespace tubetwin

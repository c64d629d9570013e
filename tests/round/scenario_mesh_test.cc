#include "twin/round/scenario.h"

#include <fstream>

#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tube_mesh.h"
#include "twin/round/archive.h"

namespace tubetwin {
namespace {

void Write(const TemporaryFolder& folder, const std::string& name, const Mesh& mesh, double scale) {
  std::ofstream(folder / name, std::ios::binary) << BinaryStl(mesh, scale);
}

/// Of a scenario file in the folder.
Scenario Read(const TemporaryFolder& folder, const std::string& toml) {
  WriteFileAtomically(folder / "test.toml", toml);
  ConfigSource source;
  source.AddFile(folder / "test.toml");
  Scenario scenario;
  source.ReadInto(scenario);
  return scenario;
}

std::string MessageOf(const Scenario& scenario, ErrorKind kind) {
  try {
    ScenarioBin(scenario, Bin().size_m);
  } catch (const Error& error) {
    CHECK(static_cast<int>(error.kind()) == static_cast<int>(kind));
    return error.what();
  }
  FAIL("no error");
  return "";
}

TEST_CASE("A bin's mesh gives the bin its size", "[campaign]") {
  const TemporaryFolder folder;
  Write(folder, "bin.stl", MakeBinMesh({0.4, 0.7, 0.12}, 0.01), 1000.0);
  const Scenario scenario = Read(folder, "[bin]\nmesh = \"bin.stl\"\nmesh_units = \"mm\"\n");
  const Bin bin = ScenarioBin(scenario, Bin().size_m);
  constexpr double kExact_m = 0.0005;
  CHECK(bin.size_m[0] == Approx(0.7).margin(kExact_m));
  CHECK(bin.size_m[1] == Approx(0.4).margin(kExact_m));
  CHECK(bin.size_m[2] == Approx(0.12).margin(kExact_m));
}

TEST_CASE("A mesh that is no bin, asks for its unit or meets a size is refused", "[campaign]") {
  const TemporaryFolder folder;
  Write(folder, "bin.stl", MakeBinMesh({0.7, 0.4, 0.12}, 0.01), 1000.0);
  Write(folder, "box.stl", MakeBoxMesh(Vector3::Zero(), {0.3, 0.2, 0.1}), 1.0);
  CHECK_THAT(MessageOf(Read(folder, "[bin]\nmesh = \"box.stl\"\n"), ErrorKind::kBadData),
             Catch::Contains("this is no bin for the cell"));
  CHECK_THAT(MessageOf(Read(folder, "[bin]\nmesh = \"bin.stl\"\n"), ErrorKind::kBadData),
             Catch::Contains("bin.mesh_units"));
  CHECK_THAT(MessageOf(Read(folder, "[bin]\nmesh = \"none.stl\"\n"), ErrorKind::kMissing),
             Catch::Contains("none.stl"));
  CHECK_THAT(MessageOf(Read(folder, "[bin]\nmesh = \"box.stl\"\nsize_m = [0.7, 0.4, 0.1]\n"),
                       ErrorKind::kConfig),
             Catch::Contains("leave one out"));
}

TEST_CASE("Meshes stand in pictures where bin and links stand", "[campaign]") {
  const TemporaryFolder folder;
  Write(folder, "bin.stl", MakeBinMesh({0.4, 0.7, 0.12}, 0.01), 1.0);
  Write(folder, "link.stl", MakeBoxMesh(Vector3::Zero(), {0.05, 0.05, 0.2}), 100.0);
  Scenario scenario =
      Read(folder,
           "[bin]\nmesh = \"bin.stl\"\n[cell.arm]\nvisual_meshes = [\"\", \"\", \"link.stl\"]\n"
           "visual_units = \"cm\"\n");
  const std::vector<Recording::Visual> visuals = ScenarioVisuals(scenario);
  REQUIRE(visuals.size() == 2);
  CHECK(visuals[0].body == "world");
  const Bin bin = ScenarioBin(scenario, std::nullopt);
  double lowest = 1.0, widest = 0.0;
  for (const Vector3& v_B : visuals[0].mesh.vertices) {
    const Vector3 v_N = bin.X_BN.inverse() * v_B;
    lowest = std::min(lowest, v_N.z());
    widest = std::max(widest, v_N.x());
  }
  constexpr double kExact_m = 0.0005;
  CHECK(lowest == Approx(-0.01).margin(kExact_m));
  CHECK(widest == Approx(0.36).margin(kExact_m));
  CHECK(visuals[1].body == "arm_link2");
  CHECK(visuals[1].mesh.BoxSize().z() == Approx(0.4));
  const std::vector<ArchivedFile> files = ArchiveInputs(scenario);
  REQUIRE(files.size() == 2);
  CHECK(scenario.bin.mesh == "given.bin.stl");
  CHECK(scenario.cell.arm.visual_meshes[2] == "given.arm_2.stl");
  CHECK(files[1].text == ReadFile(folder / "link.stl"));
  scenario.cell.arm.visual_meshes.assign(8, "");
  CHECK_THROWS_AS(ScenarioVisuals(scenario), Error);
}

}  // namespace
}  // namespace tubetwin

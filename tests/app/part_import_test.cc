// `part import` as a user meets it.

#include <filesystem>

#include "models/base/files.h"
#include "models/base/json.h"
#include "models/part.h"
#include "scenes/pile.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

Polyline ShapeOf(const Part& part) {
  RandomStream stream(3, 0, "shape");
  return DrawShape(part, stream);
}

TEST_CASE("A mesh becomes a part that check and pile take, with a picture", "[app]") {
  const TemporaryFolder folder;
  const Part pvc = LoadPart("pvc_a");
  const Polyline line = ShapeOf(pvc);
  TubeMeshOptions hollow;
  hollow.bore_m = 0.011;
  const Mesh mesh = MakeTubeMesh(line, pvc.radius_m, hollow);
  Write(folder, "mm.stl", BinaryStl(mesh, 1000.0));
  Write(folder, "cm.obj", Obj(mesh, 100.0));
  Write(folder, "in.ply", BinaryPly(mesh, 1.0 / 0.0254));
  Write(folder, "m.ply", TextPly(mesh));
  for (const std::string file : {"mm.stl", "cm.obj", "in.ply", "m.ply"}) {
    const std::string units = file.substr(0, file.find('.'));
    const Outcome outcome =
        RunProgram(folder, "part import " + file + " --json --out p.toml" +
                               (units == "m" ? "" : " --units " + units) + " --name mine");
    INFO(file << "\n" << outcome.err);
    REQUIRE(outcome.code == 0);
    const Json said = Json::parse(outcome.out);
    CHECK(said["length_m"].get<double>() == Approx(0.5).epsilon(0.01));
    CHECK(said["radius_m"].get<double>() == Approx(0.0125).epsilon(0.02));
    CHECK(said["hollow"] == true);
    CHECK(said["rms_m"].get<double>() < 0.0002);
    const Part part = LoadPart(folder / "p.toml");
    CHECK(part.name == "mine");
    CHECK(part.friction == pvc.friction);
    CHECK(part.mass_kg == Approx(pvc.mass_kg).epsilon(0.05));
    CHECK(ReadFile(folder / "p.png").substr(1, 3) == "PNG");
  }
  CHECK(RunProgram(folder, "part check p.toml").code == 0);
  const Outcome made =
      RunProgram(folder, "pile generate --part p.toml --count 3 --seed 1 --out pile.json");
  INFO(made.err);
  REQUIRE(made.code == 0);
  const Pile pile = LoadPile(folder / "pile.json");
  REQUIRE(pile.tubes.size() == 3);
  // All are bent as the mesh is: their ends are as far apart.
  const double apart_m = (line.front() - line.back()).norm();
  for (const PileTube& tube : pile.tubes) {
    const Polyline& l = tube.centerline_N;
    CHECK((l.front() - l.back()).norm() == Approx(apart_m).epsilon(0.01));
    CHECK(tube.radius_m == pile.part.radius_m);
  }
}

TEST_CASE("A hose's mesh becomes a hose", "[app]") {
  const TemporaryFolder folder;
  const Part hose = LoadPart("hose_b");
  Write(folder, "hose.stl", BinaryStl(MakeTubeMesh(ShapeOf(hose), hose.radius_m)));
  const Outcome outcome =
      RunProgram(folder, "part import hose.stl --material hose_b --mass 0.12 --out deep/p.toml");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const Part part = LoadPart(folder / "deep/p.toml");
  CHECK(part.is_hose());
  CHECK(part.name == "hose");
  CHECK(part.mass_kg == 0.12);
  CHECK(part.length_m == Approx(hose.length_m).epsilon(0.01));
  RandomStream stream(1, 0, "any");
  CHECK(DrawShape(part, stream).size() == static_cast<std::size_t>(part.links) + 1);
}

TEST_CASE("What cannot be imported is refused and nothing is written", "[app]") {
  const TemporaryFolder folder;
  const Mesh tube = MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.4, 0, 0)}, 0.01);
  Write(folder, "tube.stl", BinaryStl(tube));
  Write(folder, "mm.stl", BinaryStl(tube, 1000.0));
  Write(folder, "ball.stl", BinaryStl(MakeSphereMesh(Vector3::Zero(), 0.035)));
  Write(folder, "noise.ply", "ply\nno mesh");
  Write(folder, "fat.stl", BinaryStl(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.5, 0, 0)}, 0.06)));
  const auto refused = [&](const std::string& arguments, int code, const std::string& said) {
    CheckRefused(folder, "part import " + arguments, code, said);
  };
  refused("mm.stl --out p.toml", 65, "--units");
  refused("ball.stl --out p.toml", 65, "this is no tube: it is round with a radius of 3");
  refused("noise.ply --out p.toml", 65, "noise.ply");
  refused("fat.stl --out p.toml", 65, "3 to 40 mm");
  refused("none.stl --out p.toml", 66, "none.stl: no such file");
  refused("tube.stl --material pvc_b --out p.toml", 66, "pvc_a");
  refused("tube.stl --units km --out p.toml", 64, "km");
  refused("tube.stl --mass 0 --out p.toml", 64, "mass");
  refused("tube.stl --out p.txt", 64, ".toml");
  refused("tube.stl", 64, "--out");
  Write(folder, "taken", "a file\n");
  refused("tube.stl --out taken/p.toml", 73, "taken");
  std::filesystem::create_directories(folder / "p.png");
  refused("tube.stl --out p.toml", 73, "p.png");
  CHECK_FALSE(std::filesystem::exists(folder / "p.toml"));
}

}  // namespace
}  // namespace tubetwin

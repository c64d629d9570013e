// `part import` as a user meets it.

#include <filesystem>

#include "models/base/files.h"
#include "models/base/json.h"
#include "models/part.h"
#include "models/part_fit/cantilever.h"
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
    // Tubes of one batch differ.
    CHECK(tube.radius_m == Approx(pile.part.radius_m).epsilon(0.0041));
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

/// Runs `part import ARGUMENTS --out p.toml` and gives what it says as JSON.
Json Imported(const TemporaryFolder& folder, const std::string& arguments) {
  const Outcome outcome = RunProgram(folder, "part import " + arguments + " --json --out p.toml");
  INFO(arguments << "\n" << outcome.err);
  REQUIRE(outcome.code == 0);
  return Json::parse(outcome.out);
}

TEST_CASE("A mesh may have any name", "[app]") {
  const TemporaryFolder folder;
  const std::string stl = BinaryStl(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.4, 0, 0)}, 0.01));
  for (const std::string& name :
       {std::string("l\xe4tin"), std::string("two\nlines = 1"), std::string("tab\tquote\"s"),
        std::string("back\\slash\\u12"), std::string("# [[x]]"), std::string("\xe7\xae\xa1"),
        std::string("nul\x01\x7f\xc2\x85"), std::string("'"), std::string("pvc_a"),
        std::string("...")}) {
    Write(folder, name + ".stl", stl);
    std::string quoted;
    for (const char c : name) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    INFO(name);
    Imported(folder, "'" + quoted + ".stl'");
    const Part part = LoadPart(folder / "p.toml");
    CHECK(part.radius_m == Approx(0.01).epsilon(0.01));
    CHECK_FALSE(part.name.empty());
    CHECK(RunProgram(folder, "part check p.toml").code == 0);
  }
  CheckRefused(folder, "part import pvc_a.stl --out p.toml --name 'l\xe4tin'", 64,
               "--name 'l\\xE4tin'");
}

TEST_CASE("The lightest tubes are imported, and said to be too light for the sensor", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "straw.stl",
        BinaryStl(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.06, 0, 0)}, 0.0032), 1000.0));
  Imported(folder, "straw.stl --units mm");
  const Part part = LoadPart(folder / "p.toml");
  CHECK(part.mass_kg < 0.001);
  CHECK(part.mass_kg ==
        Approx(0.055 * 0.06 / 0.5 * 0.0032 * 0.0032 / 0.0125 / 0.0125).epsilon(0.02));
  const Outcome check = RunProgram(folder, "part check p.toml");
  CHECK(check.code == 65);
  CHECK_THAT(check.out, Catch::Contains("impossible  weight on the sensor"));
  CheckRefused(folder, "part import straw.stl --units mm --out q.toml --density 11 --wall-mm 0.02",
               65, "say it with --mass");
}

TEST_CASE("A mass comes from a density and the mesh's volume or a wall", "[app]") {
  const TemporaryFolder folder;
  const Polyline line = {Vector3(0, 0, 0), Vector3(0.4, 0, 0)};
  TubeMeshOptions options;
  options.sides = 48;
  options.bore_m = 0.008;
  Write(folder, "pipe.stl", BinaryStl(MakeTubeMesh(line, 0.01, options)));
  options.ends = TubeMeshOptions::Ends::kOpen;
  options.bore_m = 0.0;
  Write(folder, "open.stl", BinaryStl(MakeTubeMesh(line, 0.01, options)));
  Write(folder, "rod.stl", BinaryStl(MakeTubeMesh(line, 0.01)));
  const auto mass = [&](const std::string& arguments) {
    const Json said = Imported(folder, arguments);
    CHECK(LoadPart(folder / "p.toml").mass_kg == said["part"]["mass_kg"]);
    return said["part"]["mass_kg"].get<double>();
  };
  const double pipe_kg = 1000.0 * kPi * (0.01 * 0.01 - 0.008 * 0.008) * 0.4;
  const double rod_kg = 1000.0 * kPi * 0.01 * 0.01 * 0.4;
  constexpr double kFacets = 0.02;  // 32 sides enclose 0.6 % less than a circle.
  CHECK(mass("pipe.stl --density 1000") == Approx(pipe_kg).epsilon(kFacets));
  CHECK(mass("open.stl --density 1000 --wall-mm 2") == Approx(pipe_kg).epsilon(kFacets));
  CHECK(mass("rod.stl --density 1000 --wall-mm 2") == Approx(pipe_kg).epsilon(kFacets));
  CHECK(mass("rod.stl --density 1000") == Approx(rod_kg).epsilon(kFacets));
  CHECK_THAT(ReadFile(folder / "p.toml"),
             Catch::Contains("mass_kg: by density, 1000 kg/m3") && Catch::Contains("a full rod"));
  CHECK(mass("pipe.stl --density 1000 --wall-mm 2.1") > pipe_kg);
  const auto refused = [&](const std::string& arguments, const std::string& said) {
    CheckRefused(folder, "part import --out q.toml " + arguments, 64, said);
  };
  refused("open.stl --density 1000", "--wall-mm");
  refused("pipe.stl --density 1000 --wall-mm 3", "wall of 1.99 mm itself");
  refused("rod.stl --density 1000 --wall-mm 11", "radius is");
  refused("rod.stl --density 1000 --mass 0.1", "give one of them");
  refused("rod.stl --wall-mm 2", "needs --density");
  refused("rod.stl --density 3", "density");
  CHECK_FALSE(std::filesystem::exists(folder / "q.toml"));
}

TEST_CASE("A hose's stiffness comes from how far it sags", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "hose.stl",
        BinaryStl(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.55, 0, 0)}, 0.011)));
  const double weight_N_m = 0.18 * kGravity / 0.55;
  const auto sag = [&](double overhang_m, double stiffness_Nm2) {
    return " --sag-mm " +
           std::to_string(1e3 * CantileverSag(weight_N_m, overhang_m, stiffness_Nm2)) +
           " --overhang-m " + std::to_string(overhang_m);
  };
  const std::string hose = "hose.stl --material hose_b --mass 0.18";
  const Json one = Imported(folder, hose + sag(0.4, 0.08))["part"];
  CHECK(one["bending_stiffness_Nm2"].get<double>() == Approx(0.08).epsilon(0.02));
  const auto low = one["bending_stiffness_range_Nm2"][0].get<double>();
  const auto high = one["bending_stiffness_range_Nm2"][1].get<double>();
  CHECK(low < 0.08);
  CHECK(high > 0.08);
  CHECK(high < 1.1 * low);
  CHECK_THAT(ReadFile(folder / "p.toml"), Catch::Contains("bending_stiffness_Nm2: from a sag of") &&
                                              Catch::Contains("readings +-1 mm"));
  const Json two = Imported(folder, hose + sag(0.4, 0.08) + sag(0.3, 0.11))["part"];
  CHECK(two["bending_stiffness_Nm2"].get<double>() > 0.08);
  CHECK(two["bending_stiffness_range_Nm2"][1].get<double>() > 0.11);
  const auto refused = [&](const std::string& arguments, const std::string& said, int code = 64) {
    CheckRefused(folder, "part import --out q.toml " + arguments, code, said);
  };
  refused(hose + " --sag-mm 20", "--overhang-m 0");
  refused(hose + " --overhang-m 0.3", "--sag-mm is given 0 times");
  refused(hose + sag(0.4, 0.08) + sag(0.3, 0.08) + sag(0.2, 0.08), "3 times");
  refused(hose + sag(0.4, 0.08) + sag(0.4, 0.09), "twice");
  refused(hose + sag(0.4, 0.05) + sag(0.3, 0.4), "measure again");
  refused(hose + sag(0.56, 0.08), "0.55 m long");
  refused(hose + " --sag-mm 290 --overhang-m 0.3", "0.9 of the overhang");
  refused(hose + " --sag-mm 0.9 --overhang-m 0.3", "above the reading error");
  refused(hose + " --sag-error-mm 2", "--sag-error-mm needs");
  refused("hose.stl --material hose_b" + sag(0.4, 0.08), "needs --mass or --density");
  refused("hose.stl --mass 0.18" + sag(0.4, 0.08), "rigid");
  refused(hose + " --sag-mm 250 --overhang-m 0.3", "allowed are 0.005 to 50", 65);
  CHECK_FALSE(std::filesystem::exists(folder / "q.toml"));
}

TEST_CASE("Check says what the devices make of a part, and ends with 65 where one cannot",
          "[app]") {
  const TemporaryFolder folder;
  const Outcome good = RunProgram(folder, "part check pvc_a");
  CHECK(good.code == 0);
  CHECK_THAT(good.out, Catch::Contains("ok          diameter in the gripper: 25 mm of 85 mm") &&
                           Catch::Contains("not measured for this part"));
  Write(folder, "thick.toml", "name = \"thick\"\nradius_m = 0.038\n");
  const Outcome bad = RunProgram(folder, "part check thick.toml --json");
  CHECK(bad.code == 65);
  const Json said = Json::parse(bad.out);
  CHECK(said["verdict"] == "impossible");
  CHECK(said["part"]["radius_m"] == 0.038);
  CHECK(said["findings"][0]["verdict"] == "impossible");
  CHECK_THAT(said["findings"][0]["remedy"].get<std::string>(), Catch::Contains("stroke"));
  Write(folder, "wrong.toml", "[search]\nextra_min = 0.5\nextra_max = 0.4\n");
  CheckRefused(folder, "part check wrong.toml", 78, "search.extra_min");
}

}  // namespace
}  // namespace tubetwin

// Files given to the wrong verb: the refusal says what takes them.

#include <filesystem>

#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

TEST_CASE("A file given to the wrong verb is refused with what takes it", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "mesh.stl", BinaryStl(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.4, 0, 0)}, 0.01)));
  Write(folder, "mesh.ply", TextPly(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.4, 0, 0)}, 0.01)));
  Write(folder, "cloud.pcd",
        "# .PCD v0.7\nFIELDS x y z\nPOINTS 2\nDATA ascii\n.1 .1 .5\n.1 .2 .5\n");
  Write(folder, "pile.csv", "tube,index,x,y,z\n1,0,0,0,0.02\n1,1,0.1,0,0.02\n");
  Write(folder, "pile.json", R"({"schema": "tubetwin/pile/1"})");
  Write(folder, "tubes.json", R"({"schema": "tubetwin/tubes/1"})");
  Write(folder, "part.txt", "name = \"p\"\n");
  const struct {
    const char *arguments, *said;
  } cases[] = {
      {"perceive mesh.stl --part pvc_a --out t.json", "tubetwin part import FILE"},
      {"perceive pile.csv --part pvc_a --out t.json", "tubetwin scan FILE --out DIR"},
      {"perceive pile.json --part pvc_a --out t.json", "tubetwin scan FILE --out DIR"},
      {"perceive tubes.json --part pvc_a --out t.json", "tubetwin plan FILE"},
      {"plan mesh.stl --part pvc_a --out t.json", "tubetwin part import FILE"},
      {"plan pile.json --part pvc_a --out t.json", "tubetwin scan FILE --out DIR"},
      {"pile show cloud.pcd", "tubetwin perceive FILE"},
      {"pile import mesh.stl --out p.json", "tubetwin part import FILE"},
      {"pile show tubes.json", "tubetwin plan FILE"},
      {"scan cloud.pcd --out s", "tubetwin perceive FILE"},
      {"evaluate mesh.stl --out e.json", "tubetwin part import FILE"},
      {"render mesh.stl --out a.png", "tubetwin part import FILE"},
      {"render cloud.pcd --out a.png", "--labelled F.pcd"},
      {"part check mesh.stl", "is a mesh; allowed: a part's name or a part file (.toml)"},
      {"part check cloud.pcd", "is no part file, whose name ends in .toml"},
      {"part check part.txt", "is no part file, whose name ends in .toml"},
      {"perceive cloud.pcd --part mesh.ply --out t.json", "tubetwin part import MESH"},
      {"pile generate --part mesh.stl --count 2 --out p.json", "tubetwin part import MESH"},
      {"part import cloud.pcd --out p.toml", "(the file is a PCD cloud)"},
      {"part import pile.csv --out p.toml", "(the file is a pile in CSV)"},
  };
  for (const auto& c : cases) {
    INFO(c.arguments);
    CheckRefused(folder, c.arguments, 65, c.said);
  }
  for (const char* out : {"t.json", "p.json", "s", "e.json", "a.png", "p.toml"}) {
    CHECK_FALSE(std::filesystem::exists(folder / out));
  }
}

TEST_CASE("A TOML file of another kind is refused with what it is and what takes it", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "camp.toml", "rounds = 2\n[[variant]]\npart = \"pvc_a\"\ncount = 2\n");
  Write(folder, "cell.toml", RunProgram(folder, "config model leao2020").out);
  Write(folder, "part.toml", "name = \"p\"\nradius_m = 0.0125\nlength_m = 0.5\nmass_kg = 0.05\n");
  Write(folder, "faults.toml", "[[fault]]\nat_s = 1.0\n");
  Write(folder, "views.toml", "[[view]]\ncloud = \"view_0.pcd\"\n");
  Write(folder, "scenario.toml", "[pile]\ncount = 3\n");
  const std::string camp = "(camp.toml is a campaign: tubetwin campaign run camp.toml)";
  const std::string cell = "(cell.toml is a cell model: use it by --set cell.model=cell.toml";
  const std::string part = "(part.toml is a part: --part part.toml";
  const std::string faults = "(faults.toml is a script of faults: tubetwin emulate --faults";
  const std::string views = "(views.toml is a list of views: tubetwin calibrate hand-eye --views";
  const std::string scenario = "(scenario.toml is a scenario or cell file: tubetwin run scenario";
  const struct {
    std::string arguments, said;
  } cases[] = {
      {"campaign run cell.toml --out o", cell},
      {"campaign run part.toml --out o", part},
      {"campaign run scenario.toml --out o", scenario},
      {"run camp.toml --out o", camp},
      {"run part.toml --out o", part},
      {"run faults.toml --out o", faults},
      {"run --part camp.toml --out o", camp},
      {"run --part=cell.toml --out o", cell},
      {"run --set cell.model=camp.toml --out o", camp},
      {"config check camp.toml", camp},
      {"config dump views.toml", views},
      {"part check cell.toml", cell},
      {"part check scenario.toml", scenario},
      {"doctor --cell views.toml", views},
      {"emulate --faults camp.toml --out o", camp},
  };
  for (const auto& c : cases) {
    INFO(c.arguments);
    CheckRefused(folder, c.arguments, 78, c.said);
  }
  CheckRefused(folder, "render camp.toml --out a.png", 65, camp);
  CHECK_FALSE(std::filesystem::exists(folder / "o"));
}

TEST_CASE("A faulty TOML file of the right kind is not told what it is", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "camp.toml", "rounds = 2\nbogus = 1\n[[variant]]\ncount = 2\n");
  Write(folder, "scenario.toml", "[pile]\nbogus = 3\n");
  Write(folder, "part.toml", "radius_m = 0.0125\nlength_m = 0.5\nbogus = 0.05\n");
  Write(folder, "faults.toml", "[[fault]]\nbogus = 1.0\n");
  for (const char* arguments :
       {"campaign run camp.toml --out o", "run scenario.toml --out o",
        "doctor --cell scenario.toml", "part check part.toml", "run --part part.toml --out o",
        "run --set pile.part=part.toml --out o", "emulate --faults faults.toml --out o"}) {
    INFO(arguments);
    CheckRefused(folder, arguments, 78, "bogus");
    CHECK_THAT(RunProgram(folder, arguments).err, !Catch::Contains(" is a "));
  }
}

TEST_CASE("A recording given to the other verb of recordings is told which takes it", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "recording.bin", "of motions");
  Write(folder, "cell.rec.zst", "of a cell");
  CheckRefused(folder, "replay recording.bin", 65, "tubetwin render FILE");
  CheckRefused(folder, "replay recording.bin --mcap a.mcap", 65, "tubetwin render FILE");
  CheckRefused(folder, "render cell.rec.zst --out a.png", 65, "tubetwin replay FILE");
  CHECK_THAT(RunProgram(folder, "replay cell.rec.zst").err, !Catch::Contains("are for"));
}

TEST_CASE("Options of render that say nothing of what is drawn are refused by name", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kPile);
  Write(folder, "t.json", R"({"schema": "tubetwin/tubes/1"})");
  Write(folder, "c.pcd", "");
  Write(folder, "recording.bin", "");
  const struct {
    const char *arguments, *said;
  } cases[] = {
      {"p.json --frame 5", "p.json: --frame is for recordings"},
      {"p.json --speed 3", "p.json: --speed is for recordings"},
      {"p.json --speed 1", "p.json: --speed is for recordings"},
      {"t.json --frame 0", "t.json: --frame is for recordings"},
      {"t.json --part hose_b", "t.json: --part is for piles"},
      {"c.pcd --part hose_b", "c.pcd: --part is for piles"},
      {"c.pcd --speed 2", "c.pcd: --speed is for recordings"},
      {"recording.bin --part hose_b", "recording.bin: --part is for piles"},
      {"recording.bin --bin 0.8,0.6,0.09", "recording.bin: --bin is for piles, tubes.json and"},
      {"recording.bin --units mm", "recording.bin: --units is for clouds"},
      {"recording.bin --speed 3", "recording.bin: --speed is for films"},
      {"p.json --units mm", "p.json: --units is for clouds"},
  };
  for (const auto& c : cases) {
    INFO(c.arguments);
    CheckRefused(folder, std::string("render --out a.png ") + c.arguments, 64, c.said);
  }
  CheckRefused(folder, "render --out a.mp4 recording.bin --frame 3", 64, "--frame is for pictures");
}

}  // namespace
}  // namespace tubetwin

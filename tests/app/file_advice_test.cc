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

}  // namespace
}  // namespace tubetwin

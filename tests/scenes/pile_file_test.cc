#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "models/base/error.h"
#include "models/base/files.h"
#include "scenes/pile.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

// A folder of its own for the files of one test case, removed afterwards.
class Folder {
 public:
  explicit Folder(const std::string& name) : path_("pile_file_test_" + name) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ + "/" + name, std::ios::binary) << text;
    return path_ + "/" + name;
  }
  std::string Path(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

std::string MessageOf(const std::function<void()>& call, ErrorKind kind) {
  try {
    call();
  } catch (const Error& error) {
    INFO(error.what());
    CHECK(static_cast<int>(error.kind()) == static_cast<int>(kind));
    return error.what();
  }
  FAIL("no error");
  return "";
}

Pile TwoTubes() {
  Pile pile;
  pile.part = LoadPart("pvc_a");
  for (int i = 0; i < 2; ++i) {
    PileTube tube;
    tube.id = 7 + 5 * i;
    tube.centerline_N = {{-0.2, 0.1 * i, 0.0125}, {0.1 / 3.0, 0.1 * i, 0.0125}, {0.2, 0.05, 0.02}};
    tube.radius_m = 0.0125;
    tube.mass_kg = 0.055;
    pile.tubes.push_back(tube);
  }
  pile.seed = 12;
  pile.settled = true;
  return pile;
}

TEST_CASE("A pile is read back as it was written, and written again byte for byte", "[unit]") {
  const Folder folder("round_trip");
  for (const std::string part : {"pvc_a", "hose_b"}) {
    Pile pile = TwoTubes();
    pile.part = LoadPart(part);
    if (pile.part.is_hose()) pile.tubes[0].rest_centerline_N = pile.tubes[1].centerline_N;
    SavePile(pile, folder.Path("a.json"));
    const Pile back = LoadPile(folder.Path("a.json"));
    REQUIRE(back.tubes.size() == 2);
    CHECK(back.tubes[0].id == 7);
    CHECK(back.tubes[0].centerline_N == pile.tubes[0].centerline_N);
    CHECK(back.tubes[0].rest_centerline_N == pile.tubes[0].rest_centerline_N);
    CHECK(back.seed == 12);
    CHECK(back.settled);
    CHECK(back.part.name == part);
    SavePile(back, folder.Path("b.json"));
    CHECK(ReadFile(folder.Path("a.json")) == ReadFile(folder.Path("b.json")));
  }
}

TEST_CASE("A CSV and the public set's text of the same tubes give the same pile", "[unit]") {
  const Folder folder("formats");
  const std::string csv = folder.Write("p.csv",
                                       "tube,index,x,y,z\r\n3,0,0,0,0.02\r\n3,1,0.1,0,0.02\r\n"
                                       "3,2,0.2,0.1,0.0125\r\n9,0,0,0.2,0.01\n9,1,0.1,0.25,0.01\n");
  // Nodes out of order; the chain follows the edges' order: 1, 4, 2.
  const std::string text =
      folder.Write("p.txt",
                   "2\n3 3 2\n2 0.2 0.1 0.0125 0.0125\n4 0.1 0 0.02 0.0125\n1 0 0 0.02 0.0125\n"
                   "e_4_2 4 2 2 0.0125 0 0 0 1 0 0 0 0.1\ne_1_4 1 4 1 0.0125 0 0 0 1 0 0 0 0.1\n"
                   "9 2 1\n1 0 0.2 0.01 0.0125\n2 0.1 0.25 0.01 0.0125\n"
                   "e_1_2 1 2 1 0.0125 0 0 0 1 0 0 0 0.1\n");
  const Pile a = LoadPile(csv), b = LoadPile(text);
  CHECK(a.part.name == "leao2022");
  CHECK(a.bin.size_m == std::array<double, 3>{0.80, 0.60, 0.20});
  REQUIRE(a.tubes.size() == 2);
  REQUIRE(b.tubes.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(a.tubes[i].id == b.tubes[i].id);
    CHECK(a.tubes[i].centerline_N == b.tubes[i].centerline_N);
    CHECK(a.tubes[i].radius_m == b.tubes[i].radius_m);
    CHECK(a.tubes[i].mass_kg == b.tubes[i].mass_kg);
  }
  // A tube's own length wins: it weighs as much of the part as it is long.
  CHECK(a.tubes[1].mass_kg == Approx(0.055 * std::hypot(0.1, 0.05) / 0.5));
  PileOverrides overrides;
  overrides.part = "hose_b";
  overrides.bin_size_m = {0.7, 0.5, 0.1};
  const Pile c = LoadPile(csv, overrides);
  CHECK(c.part.is_hose());
  CHECK(c.bin.size_m[0] == 0.7);
  CHECK(c.tubes[0].radius_m == 0.010);
  CHECK(static_cast<int>(c.tubes[0].centerline_N.size()) == c.part.links + 1);
}

TEST_CASE("The public set's own file is read where the data is", "[unit]") {
  const char* folder = std::getenv("TUBETWIN_DATA");
  const std::string data = folder != nullptr ? folder : TUBETWIN_SOURCE_DIR "/../shared/data";
  const std::string path = data + "/leao2022/A2_1_original_format.txt";
  if (!std::filesystem::exists(path)) {
    WARN("skipped: " << path << " is not here (set TUBETWIN_DATA to the data folder)");
    return;
  }
  const Pile pile = LoadPile(path);
  REQUIRE(pile.tubes.size() == 2);
  const double kPrinted_m = 2e-5;  // Six digits per coordinate over ten pieces.
  for (const PileTube& tube : pile.tubes) {
    CHECK(Length(tube.centerline_N) == Approx(0.5).margin(kPrinted_m));
  }
  CHECK(pile.tubes[0].centerline_N.front() == Vector3(0.275257, -0.154805, 0.0119009));
  CHECK(pile.tubes[0].centerline_N.back() == Vector3(-0.126595, 0.10497, 0.0359598));
}

TEST_CASE("A CSV in millimetres is read so when that is said, else refused by that name",
          "[unit]") {
  const Folder folder("millimetres");
  const std::string csv =
      folder.Write("p.csv", "tube,index,x,y,z\n1,0,-163.4,31.4,12.5\n1,1,49.07,-23.95,12.5\n");
  CHECK_THAT(MessageOf([&] { LoadPile(csv); }, ErrorKind::kBadData),
             Catch::Contains("the largest is 163.4") && Catch::Contains("--units mm"));
  PileOverrides overrides;
  overrides.unit_m = 0.001;
  const Pile pile = LoadPile(csv, overrides);
  CHECK(pile.tubes[0].centerline_N[0].isApprox(Vector3(-0.1634, 0.0314, 0.0125)));
  const std::string text = folder.Write("p.txt",
                                        "\xef\xbb\xbf"
                                        "1\n9 2 1\n1 0 200 10 11\n2 +100 250 10 11\n"
                                        "e_1_2 1 2 1 11 0 0 0 1 0 0 0 112\n");
  CHECK_THAT(MessageOf([&] { LoadPile(text); }, ErrorKind::kBadData),
             Catch::Contains("--units mm"));
  const PileTube tube = LoadPile(text, overrides).tubes[0];
  CHECK(tube.centerline_N[1].isApprox(Vector3(0.1, 0.25, 0.01)));
  CHECK(tube.radius_m == Approx(0.011));
  SavePile(TwoTubes(), folder.Path("a.json"));
  MessageOf([&] { LoadPile(folder.Path("a.json"), overrides); }, ErrorKind::kUsage);
}

struct Case {
  std::string text;
  std::vector<std::string> says;
};

std::vector<Case> BadFiles() {
  const std::string csv = "tube,index,x,y,z\n";
  const std::string head =
      "{\"schema\": \"tubetwin/pile/1\", \"bin\": {\"size_m\": [0.8,0.6,0.2]}, "
      "\"part\": \"pvc_a\", \"tubes\": ";
  return {
      {"", {"is empty"}},
      {"\x89PNG\r\n", {"no pile: it is a PNG picture"}},
      {"\x01\x02\n", {"byte 0: '\\x01' begins no pile"}},
      {"x,y,z\n", {"line 1", "header is 'x,y,z' and lacks 'tube'", "tube,index,x,y,z"}},
      {"tubes,index,x,y,z\n", {"line 1", "'tubes,index,x,y,z' and lacks 'tube'"}},
      {"pile\n", {"byte 0: 'p' begins no pile"}},
      {"\x1f\x8b\x08", {"is packed by gzip"}},
      {"# .PCD v.7\nVERSION .7\n", {"no pile: it is a PCD cloud"}},
      {"solid tube\nfacet", {"no pile: it is an STL mesh"}},
      {csv, {"has 0 tubes", "1 to 200"}},
      {csv + "1,0,0,0,0.1\n1,1,nan,0,0.1\n", {"line 3", "x is 'nan'", "finite"}},
      {csv + "1,0,0,0,inf\n", {"line 2", "z is 'inf'"}},
      {csv + "1,0,0,0,0.1\n1,1,0.1,0\n", {"line 3", "has 4 fields; the header has 5"}},
      {csv + "1,0,0,0,0.1\n1,2,0.1,0,0.1\n",
       {"line 3", "index of tube 1 is 2, and it has no 1", "each from 0 on once"}},
      {csv + "1,0,0,0,0.1\n1,1,0.1,0,0.1\n2,0,0,0,0\n1,1,0,0,0\n",
       {"line 5", "index of tube 1 is 1, which it had before"}},
      {csv + "one,0,0,0,0.1\n", {"line 2", "tube is 'one'"}},
      {csv + "1,0,0,0,0.1\n", {"tubes[0] (id 1)", "has 1 nodes", "2 to 2000"}},
      {csv + "1,0,0,0,0.1\n1,1,0,0,0.1\n", {"centerline_m[1]", "at least 0.001"}},
      {csv + "1,0,-0.6,0,0.1\n1,1,0.6,0,0.1\n", {"is 1.2 m long", "diagonal, 1.0198"}},
      {csv + "1,0,0,0,0.1\n1,1,5,0,0.1\n", {"centerline_m[1] is at 5 m", "-3 to 3"}},
      {"2\n1 2 1\n1 0 0 0 0.01\n", {"line 3", "the file ends where a node is needed"}},
      {"0\n", {"has 0 tubes"}},
      {"1\n1 2 1\n1 0 0 0 0.01\n2 0.1 0 0 nan\n", {"line 4", "radius is 'nan'"}},
      {"1\n1 2 1\n1 0 0 0 0.01\n2 0.1 0 0 0.01\ne 1 3 1 0 0 0 0 0 0 0 1 0\n",
       {"line 5", "node 3, which the tube lacks"}},
      {"1000000000000\n", {"line 1", "number of tubes is '1000000000000'", "0 to 1000"}},
      {head + "[]}", {"has 0 tubes"}},
      {head, {"byte"}},
      {head + "[{\"id\": 1}]}", {"tubes[0]", "centerline_m", "missing"}},
      {head + "[{\"id\": 1, \"centerline_m\": [[0,0,0],[0.1,0]]}]}", {"tubes[0].centerline_m[1]"}},
      {head + "[{\"id\": 1, \"centerline_m\": [[0,0,0],[0.1,0,\"high\"]]}]}", {"high", "number"}},
      {head + "[{\"id\": 1.5, \"centerline_m\": [[0,0,0],[0.1,0,0]]}]}", {"tubes[0].id"}},
      {head + "[{\"id\": 1, \"radius_m\": -1, \"centerline_m\": [[0,0,0],[0.1,0,0]]}]}",
       {"tubes[0] (id 1)", "radius_m is -1", "0.003 to 0.04"}},
      {head + "[{\"id\": 1, \"mass_kg\": 0, \"centerline_m\": [[0,0,0],[0.1,0,0]]}]}",
       {"mass_kg is 0"}},
      {head + "[{\"id\": 1, \"centerline_m\": [[0,0,0],[0.1,0,0]], "
              "\"rest_centerline_m\": [[0,0,0],[0.1,0,0]]}]}",
       {"rest_centerline_m", "hoses only"}},
      {head + "[{\"id\": 1, \"centerline_m\": [[0,0,0],[0.1,0,0]]}, "
              "{\"id\": 1, \"centerline_m\": [[0,0,0],[0.1,0,0]]}]}",
       {"tubes[1] (id 1)", "id comes twice"}},
      {head + "7}", {"tubes", "list"}},
      {"{\"schema\": \"tubetwin/tubes/1\"}", {"tubetwin/tubes/1", "tubetwin/pile/1"}},
      {"{\"tubes\": []}", {"schema"}},
      {"[1, 2]", {"object"}},
  };
}

TEST_CASE("A bad pile file is refused with its place, value and what is allowed", "[unit]") {
  const Folder folder("bad");
  for (const Case& c : BadFiles()) {
    const std::string path = folder.Write("bad", c.text);
    const std::string message = MessageOf([&] { LoadPile(path); }, ErrorKind::kBadData);
    CHECK_THAT(message, Catch::StartsWith(path));
    for (const std::string& part : c.says) CHECK_THAT(message, Catch::Contains(part));
    CHECK(std::count(message.begin(), message.end(), '\n') < 4);
  }
  MessageOf([&] { LoadPile(folder.Path("none.json")); }, ErrorKind::kMissing);
  const std::string unknown = folder.Write(
      "unknown.json",
      "{\"schema\": \"tubetwin/pile/1\", \"bin\": {\"size_m\": [1,1,1]}, \"part\": \"pvc_c\"}");
  CHECK_THAT(MessageOf([&] { LoadPile(unknown); }, ErrorKind::kMissing), Catch::Contains("pvc_a"));
}

/// A pile of one straight tube in the bin of the paper.
Pile OneTube(const Vector3& from_N, const Vector3& to_N) {
  Pile pile;
  pile.part = LoadPart("pvc_a");
  pile.tubes.push_back({7, {from_N, to_N}, 0.0125, 0.055, std::nullopt});
  return pile;
}

TEST_CASE("A tube is in the bin over its floor, over a wall and above it, and nowhere else",
          "[unit]") {
  for (const auto& [from, to] : std::vector<std::pair<Vector3, Vector3>>{
           {{-0.2, 0, 0.0125}, {0.2, 0, 0.0125}},
           {{-0.2, 0, 1e-6}, {0.2, 0, 1e-6}},  // Half of it in the floor: pushed out.
           {{0, 0, 0.3}, {0.5, 0, 0.05}},      // Leans over the wall and hangs outside.
           {{0.3849, -0.2, 0.05}, {0.3849, 0.2, 0.05}},
           {{0, 0, 1.0}, {0.4, 0, 1.0}}}) {
    CHECK_NOTHROW(RequireInBin(OneTube(from, to), "p"));
  }
  struct Misplaced {
    Vector3 from_N, to_N;
    std::string said;
  };
  for (const Misplaced& c : std::vector<Misplaced>{
           {{0.2, 0, 0.02}, {0.6, 0, 0.3}, "its middle is at (0.4, 0, 0.16) m, 0.015 m outside"},
           {{1.0, 0.69, 0.02}, {1.2, 0.69, 0.02}, "(1.1, 0.69, 0.02) m, 0.8193 m outside the bin"},
           {{-0.2, 0, 0.02},
            {0.2, 0, -0.01},
            "floor or under it at (0.2, 0, -0.01) m, 0.01 m too low"},
           {{0, 0, 0.3}, {0.5, 0, -0.03}, "under it at (0.5, 0, -0.03) m, 0.01 m too low"},
           {{-0.2, 0, 0.02}, {0.42, 0, 0.02}, "inside the bin's wall at (0.4"},
           {{0, 0, 2.6},
            {0.3, 0, 2.7},
            "its lowest point is 2.51 m over the bin's rim at (0, 0, 2.6) m"},
           {{0, -0.2, 0.02},
            {0, 0.3, 0.02},
            "wall at (0, 0.3, 0.02) m, 0.01 m beyond its inner face"}}) {
    const std::string message =
        MessageOf([&] { RequireInBin(OneTube(c.from_N, c.to_N), "p.csv"); }, ErrorKind::kBadData);
    CHECK_THAT(message, Catch::StartsWith("p.csv: tubes[0] (id 7): its "));
    CHECK_THAT(message, Catch::Contains(c.said));
    CHECK_THAT(message, Catch::Contains("allowed: tubes in the bin, 0.77 x 0.58 x 0.09 m"));
  }
}

TEST_CASE("A part tells which of a file's figures it replaces, and only those", "[unit]") {
  const Folder folder("replaced");
  const std::string path = folder.Path("p.json");
  SavePile(OneTube({-0.2, 0, 0.02}, {0.2, 0, 0.02}), path);
  std::vector<std::string> told;
  PileOverrides overrides;
  overrides.tell = [&](const std::string& text) { told.push_back(text); };
  LoadPile(path, overrides);
  CHECK(told.empty());
  overrides.part = "leao2022";
  LoadPile(path, overrides);  // Its mass for 0.4 m, the same radius.
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0],
             Catch::Contains("p.json: part leao2022 replaces what the file says: mass 0.055"));
  told.clear();
  const std::string csv =
      folder.Write("p.csv", "tube,index,x,y,z\n0,0,-0.2,0,0.02\n0,1,0.2,0,0.02\n");
  overrides.part = "hose_b";
  LoadPile(csv, overrides);  // It says no radius and no mass.
  CHECK(told.empty());
}

}  // namespace
}  // namespace tubetwin

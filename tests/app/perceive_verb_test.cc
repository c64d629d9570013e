// The verb `perceive` as a user meets it: clouds that are bad in every way we know, poses, labels.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "models/base/cloud/cloud.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

const std::string kPose = "VIEWPOINT 0 0 0.5 0 1 0 0\n";

/// A binary PCD of `points` records of x y z; `bytes` is the data.
std::string Pcd(const std::string& width, const std::string& height, const std::string& points,
                const std::string& bytes, const std::string& view = kPose) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
         width + "\nHEIGHT " + height + "\n" + view + "POINTS " + points + "\nDATA binary\n" +
         bytes;
}

std::string Floats(std::size_t count, float value) {
  std::string out(4 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) std::memcpy(out.data() + 4 * i, &value, 4);
  return out;
}

/// A picture of 20 x 20 points of a flat floor 0.5 m below the scanner.
std::string FlatFloor() {
  std::string out;
  for (int i = 0; i < 400; ++i) {
    const float p[3] = {0.01f * static_cast<float>(i % 20 - 10),
                        0.01f * static_cast<float>(i / 20 - 10), 0.5f};
    out.append(reinterpret_cast<const char*>(p), 12);
  }
  return out;
}

/// Exit 65, one sentence that names the file and `said`, nothing written, little memory taken.
void CheckBadCloud(const TemporaryFolder& folder, const std::string& name,
                   const std::string& content, const std::string& said,
                   const std::string& more = "") {
  Write(folder, name, content);
  const std::string arguments =
      "perceive " + name + " --part pvc_a --labelled l.pcd --out t.json " + more;
  CheckRefused(folder, arguments, 65, said, "ulimit -v 1048576; ");
  CheckRefused(folder, arguments, 65, name);
  CHECK_FALSE(fs::exists(folder.path() + "/t.json"));
  CHECK_FALSE(fs::exists(folder.path() + "/l.pcd"));
}

TEST_CASE("A bad cloud ends with 65, costs no memory and leaves nothing", "[app]") {
  const TemporaryFolder folder;
  const std::string good = Pcd("20", "20", "400", FlatFloor());
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 100000000\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  const struct {
    const char* name;
    std::string content;
    const char* said;
  } cases[] = {
      {"empty.pcd", "", "is empty"},
      {"empty.ply", "", "is empty"},
      {"nan.pcd", Pcd("20", "20", "400", Floats(1200, std::nanf(""))),
       "x y z: 0 of 400 points are valid"},
      {"zero.pcd", Pcd("20", "20", "400", Floats(1200, 0.0f)), "0 of 400 points are valid"},
      {"pixel.pcd", Pcd("1", "1", "1", Floats(3, 0.4f)), "1 of 1 points are valid"},
      {"nopose.pcd", Pcd("20", "20", "400", FlatFloor(), ""), "no pose"},
      {"identity.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 0 1 0 0 0\n"), "no pose"},
      {"nanpose.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 nan 0 1 0 0\n"),
       "VIEWPOINT holds 'nan'"},
      {"infpose.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 inf 0 1 0 0\n"),
       "VIEWPOINT holds 'inf'"},
      {"zeropose.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 1 0 0 0 0\n"), "norm 0"},
      {"unknown.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 0 0 0 0 0\n"), "no pose"},
      {"cut.pcd", good.substr(0, good.size() - 5), "4795 bytes of data"},
      {"header.pcd", good.substr(0, 40), "the file ends inside its header"},
      {"million.pcd", Pcd("10000", "10000", "100000000", "1234"), "POINTS 100000000"},
      {"billion.pcd", Pcd("1000000", "1000000", "1000000000000", "1234"), "POINTS 1000000000000"},
      {"wrap.pcd", Pcd("2147483647", "2147483647", "4611686014132420609", "1234"),
       "POINTS 4611686014132420609"},
      {"million.ply", ply, "100000000"},
      {"negative.pcd", Pcd("-4", "2", "-8", "1234"), "WIDTH is '-4'"},
      {"nothing.pcd", Pcd("0", "0", "0", ""), "WIDTH is '0'"},
      {"garbage.pcd", std::string("GIF89a\x01\x02\x03 garbage\n"), "garbage.pcd"},
      {"text.pcd", "tube,index,x,y,z\n1,0,0.1,0.1,0.02\n", "it is a pile in CSV"},
      {"packed.pcd", "\x1f\x8b\x08", "is packed by gzip; unpack it first"},
      {"text.ply", "solid bin\n", "no PLY file"},
  };
  for (const auto& c : cases) CheckBadCloud(folder, c.name, c.content, c.said);
  auto changed = [&good](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  CheckBadCloud(folder, "fields.pcd", changed("FIELDS x y z", "FIELDS x y q"), "FIELDS lacks 'z'");
  CheckBadCloud(folder, "type.pcd", changed("TYPE F F F", "TYPE F X F"), "field 'y' has TYPE X");
  CheckBadCloud(folder, "size.pcd", changed("SIZE 4 4 4", "SIZE 4 4 -4"), "SIZE of field 'z'");
  CheckBadCloud(folder, "half.pcd", changed("SIZE 4 4 4", "SIZE 4 4 2"), "field 'z' has TYPE F");
  CheckBadCloud(folder, "zip.pcd", changed("DATA binary", "DATA binary_compressed"),
                "the compressed data");
  CheckBadCloud(folder, "ascii.pcd", changed("DATA binary", "DATA ascii"), "no number");
  CheckBadCloud(folder, "points.pcd", changed("POINTS 400", "POINTS 401"), "WIDTH x HEIGHT");
  CheckBadCloud(folder, "a.xyz", "1 2 3\n", "allowed are .pcd, .ply");
  // One bad cloud among good ones is as bad.
  Write(folder, "good.pcd", good);
  CheckBadCloud(folder, "second.pcd", Pcd("1", "1", "1", Floats(3, 0.4f)), "1 of 1 points",
                "good.pcd");
}

TEST_CASE("The pose that a user gives wins over the file's, and a note says so", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "none.pcd", Pcd("20", "20", "400", FlatFloor(), ""));
  Write(folder, "has.pcd", Pcd("20", "20", "400", FlatFloor()));
  Write(folder, "axes.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 0 0 1 0 0\n"));
  Write(folder, "other.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0.2 0 0.5 0 1 0 0\n"));
  const std::string pose = " --part pvc_a --pose -0.1,0,0.5,0,1,0,0 --out t.json ";
  const Outcome outcome =
      RunProgram(folder, "perceive none.pcd has.pcd axes.pcd --labelled l.pcd" + pose);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.err.find("has.pcd: --pose is used, not the file's own pose 0,0,0.5,0,1,0,0, which "
                         "is 0.1 m and 0 degrees off") != std::string::npos);
  CHECK(outcome.err.find("axes.pcd: --pose is used") != std::string::npos);
  CHECK(outcome.err.find("none.pcd") == std::string::npos);
  const Json tubes = Json::parse(ReadFile(folder.path() + "/t.json"));
  CHECK(tubes["tubes"].empty());
  for (const char* labelled : {"/l.pcd", "/l_1.pcd", "/l_2.pcd"}) {
    const OrganizedCloud cloud = ReadCloud(folder.path() + labelled);
    CHECK(cloud.X_NS.translation().isApprox(Vector3(-0.1, 0, 0.5)));
    CHECK(std::count(cloud.label.begin(), cloud.label.end(), kLabelCell) == 400);
  }
  CHECK(ReadFile(folder / "l.pcd").starts_with("# .PCD"));
  // What is said twice needs no note.
  const Outcome same = RunProgram(
      folder, "perceive has.pcd --part pvc_a --pose 0,0,0.50002,0,1,0,0.00001 --out t.json");
  CHECK(same.code == 0);
  CHECK(same.err.find("--pose is used") == std::string::npos);
  // One pose cannot be right for views that were taken from two.
  CheckRefused(folder, "perceive has.pcd none.pcd other.pcd" + pose, 64,
               "has.pcd and other.pcd say that they were taken from different ones");
}

TEST_CASE("A pose that is none is refused with what to write", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "none.pcd", Pcd("20", "20", "400", FlatFloor(), ""));
  Write(folder, "mm.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 500 0 1 0 0\n"));
  Write(folder, "axes.pcd", Pcd("20", "20", "400", FlatFloor(), "VIEWPOINT 0 0 0 0 1 0 0\n"));
  const auto refused = [&](const std::string& cloud, const std::string& pose, int code,
                           const std::string& said) {
    CheckRefused(folder, "perceive " + cloud + " --part pvc_a --out u.json " + pose, code, said);
  };
  refused("none.pcd", "--pose 0,0,0.5", 64, "tx,ty,tz,qw,qx,qy,qz is needed");
  refused("none.pcd", "--pose 0,0,nan,0,1,0,0", 64, "tx,ty,tz,qw,qx,qy,qz is needed");
  refused("none.pcd", "--pose 100,-145.2,515,0,1,0,0", 64,
          "is it in millimetres? In metres it is 0.1, -0.1452, 0.515");
  refused("none.pcd", "--pose 0,0,0.5,0,2,0,0", 64, "1 is needed; of that direction: 0,1,0,0");
  refused("none.pcd", "--pose 0,0,0.5,0,0,0,0", 64, "has length 0, 1 is needed");
  refused("mm.pcd", "", 65, "In metres it is 0, 0, 0.5: give that with --pose");
  refused("axes.pcd", "", 65, "turns the axes only: the file has no pose");
  CHECK_FALSE(fs::exists(folder.path() + "/u.json"));
  CHECK(
      RunProgram(folder, "perceive mm.pcd --part pvc_a --out u.json --pose 0,0,0.5,0,1,0,0").code ==
      0);
}

TEST_CASE("Clouds that show nothing of the bin are refused, an empty bin is not", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "none.pcd", Pcd("20", "20", "400", FlatFloor(), ""));
  const auto pose = [](const std::string& p) {
    return "perceive none.pcd --part pvc_a --out u.json --pose " + p + ",0,1,0,0 ";
  };
  const std::string said = "0 of 400 points lie in the bin of 0.77 x 0.58 x 0.09 m";
  for (const char* p : {"1.5,0,0.5", "0,-1,0.5", "0,0,0.4", "0,0,1.2", "0,0,-0.5"}) {
    INFO(p);
    CheckRefused(folder, pose(p), 65, said);
  }
  CheckRefused(folder, "perceive none.pcd --part pvc_a --out u.json --pose 0,0,0.5,1,0,0,0", 65,
               said);
  CHECK_FALSE(fs::exists(folder.path() + "/u.json"));
  CHECK(RunProgram(folder, pose("0,0,0.5")).code == 0);
  // Another bin than the one that is seen: its walls would hide what lies around it.
  const Outcome outcome = RunProgram(folder, pose("0,0,0.5") + "--bin 0.1,0.1,0.3");
  INFO(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(
      outcome.err.find("of 400 points are seen where the bin would hide them, 0 below its floor") !=
      std::string::npos);
}

TEST_CASE("Labels are written in the format that the name says", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "a.pcd", Pcd("20", "20", "400", FlatFloor()));
  for (const std::string name : {"l.ply", "l.PCD", "l.pcd.zst"}) {
    const Outcome outcome = RunProgram(
        folder, "perceive a.pcd a.pcd --part pvc_a --labelled deep.er/" + name + " --out t.json");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    for (const std::string& file : {name, "l_1" + name.substr(1)}) {
      INFO(file);
      const std::string path = folder / ("deep.er/" + file);
      const OrganizedCloud labelled = ReadCloud(path);
      CHECK(labelled.height == 20);
      CHECK(std::count(labelled.label.begin(), labelled.label.end(), kLabelCell) == 400);
      CHECK(labelled.X_NS.translation().isApprox(Vector3(0, 0, 0.5)));
      CHECK(ReadFile(path).starts_with(name == "l.ply"   ? "ply\n"
                                       : name == "l.PCD" ? "# .PCD"
                                                         : "\x28\xb5"));
    }
  }
  for (const std::string name : {"l.txt", "l", ".ply", "l.ply.zst"}) {
    CheckRefused(folder, "perceive a.pcd --part pvc_a --labelled " + name + " --out u.json", 64,
                 "--labelled '" + name + "'");
  }
  CHECK_FALSE(fs::exists(folder / "u.json"));
}

TEST_CASE("--units says what a cloud's numbers are, for each verb that takes clouds",
          "[app][render]") {
  const TemporaryFolder folder;
  std::string rows;
  for (int i = 0; i < 400; ++i) {
    rows +=
        std::to_string(10 * (i % 20 - 10)) + " " + std::to_string(10 * (i / 20 - 10)) + " 500\n";
  }
  Write(folder, "mm.pcd",
        "FIELDS x y z\nWIDTH 20\nHEIGHT 20\nVIEWPOINT 0 0 500 0 1 0 0\n"
        "DATA ascii\n" +
            rows);
  CheckRefused(folder, "perceive mm.pcd --part pvc_a --out t.json", 65, "--units mm");
  CheckRefused(folder, "plan mm.pcd --part pvc_a --out t.json", 65, "--units mm");
  CheckRefused(folder, "render mm.pcd --out t.png", 65, "--units mm");
  for (const std::string verb :
       {"perceive mm.pcd --part pvc_a --labelled l.pcd --out t.json",
        "plan mm.pcd --part pvc_a --out p.json", "render mm.pcd --out t.png"}) {
    const Outcome outcome = RunProgram(folder, verb + " --units mm");
    INFO(outcome.err);
    CHECK(outcome.code == 0);
  }
  const OrganizedCloud cloud = ReadCloud(folder / "l.pcd");
  CHECK((cloud.p_SP[0] - Eigen::Vector3f(-0.1f, -0.1f, 0.5f)).norm() < 1e-6f);  // Float rounding.
  CHECK(cloud.X_NS.translation().isApprox(Vector3(0, 0, 0.5)));
  CheckRefused(folder, "perceive mm.pcd --part pvc_a --units km --out t.json", 64, "--units");
  CheckRefused(folder, "plan t.json --units mm --out p.json", 64, "--units is for clouds");
  CheckRefused(folder, "render t.json --units mm --out t.png", 64, "--units is for clouds");
}

TEST_CASE("What was perceived is drawn, and --pose floor gives the same bin", "[app][render]") {
  const TemporaryFolder folder;
  Write(folder, "p.json",
        R"({"schema": "tubetwin/pile/1", "bin": {"size_m": [0.77, 0.58, 0.09]}, "part": "pvc_a",
 "tubes": [{"id": 4, "centerline_m": [[-0.24, 0, 0.0125], [0.26, 0, 0.0125]], "radius_m": 0.0125,
 "mass_kg": 0.055}], "seed": 1, "settled": false})");
  REQUIRE(RunProgram(folder, "scan p.json --out s").code == 0);
  const Outcome outcome =
      RunProgram(folder, "perceive s/view_*.pcd --part pvc_a --labelled l.pcd --out t.json");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const Json tubes = Json::parse(ReadFile(folder.path() + "/t.json"));
  CHECK(tubes["tubes"].size() == 1);
  CHECK(tubes["bin_content"] == "not_empty");
  CHECK(tubes["timing_ms"]["load"].get<double>() > 0.0);
  const OrganizedCloud labelled = ReadCloud(folder.path() + "/l_4.pcd");
  CHECK(std::count(labelled.label.begin(), labelled.label.end(), kLabelFirstTube) > 1000);
  REQUIRE(RunProgram(folder, "render t.json --out t.png").code == 0);
  CHECK(fs::file_size(folder.path() + "/t.png") > 10000);
  // What single views show of the walls may be either of two corners.
  std::string names;
  std::vector<RigidTransform> X_NS;
  for (int k = 0; k < 8; ++k) {
    OrganizedCloud view = ReadCloud(folder.path() + "/s/view_" + std::to_string(k) + ".pcd");
    X_NS.push_back(view.X_NS);
    // Where they are in another frame they know.
    view.X_NS = MakeTransform(RotZ(1.0), Vector3(0.3, 0.2, 0.1)) * view.X_NS;
    const std::string name = "other_" + std::to_string(k) + ".pcd";
    WritePcd(view, folder.path() + "/" + name);
    names += name + " ";
  }
  const std::string options = " --part pvc_a --pose floor --labelled c_l.pcd --out c.json";
  CheckRefused(folder, "perceive s/view_0.pcd" + options, 65,
               "view_0.pcd: --pose floor: the pose is ambiguous");
  const Outcome fitted = RunProgram(folder, "perceive " + names + options);
  INFO(fitted.err);
  REQUIRE(fitted.code == 0);
  CHECK(fitted.err.find("half a turn of the bin looks the same") != std::string::npos);
  CHECK(fitted.err.find("other_3.pcd: --pose floor is used, not the file's own pose") !=
        std::string::npos);
  const Json pose = Json::parse(ReadFile(folder.path() + "/c.json"))["pose"];
  CHECK(pose["from"] == "floor");
  CHECK_THAT(pose["walls"].get<std::string>(), Catch::Contains("-x, +x"));
  CHECK(pose["open"] == "half a turn of the bin");
  CHECK(pose["X_NS"].size() == 8);
  const Vector3 found = ReadCloud(folder.path() + "/c_l_3.pcd").X_NS.translation();
  constexpr double kShift_m = 0.003;
  CHECK(found.z() == Approx(X_NS[3].translation().z()).margin(kShift_m));
  CHECK(std::min((found - X_NS[3].translation()).norm(),
                 (RotZ(kPi) * found - X_NS[3].translation()).norm()) < kShift_m);
}

}  // namespace
}  // namespace tubetwin

#include "models/part.h"

#include <filesystem>
#include <fstream>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/bin.h"
#include "models/physics.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

std::string MessageOf(const std::function<void()>& call, ErrorKind kind) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(static_cast<int>(error.kind()) == static_cast<int>(kind));
    return error.what();
  }
  FAIL("no error");
  return "";
}

// A part file in a folder of its own, removed afterwards.
class PartFile {
 public:
  explicit PartFile(const std::string& text) {
    std::filesystem::create_directories(folder_);
    std::ofstream(path()) << text;
  }
  ~PartFile() { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ + "/mine.toml"; }

 private:
  std::string folder_ = "part_test_files";
};

TEST_CASE("The shipped parts are the ones of the design", "[unit]") {
  CHECK(PartNames() == std::vector<std::string>{"hose_b", "leao2022", "pvc_a"});
  const Part pvc = LoadPart("pvc_a");
  CHECK(pvc.radius_m == 0.0125);
  CHECK(pvc.length_m == 0.5);
  CHECK(pvc.mass_kg == 0.055);
  CHECK_FALSE(pvc.is_hose());
  const Part hose = LoadPart("hose_b");
  CHECK(hose.is_hose());
  CHECK(hose.mass_kg == 0.110);
  CHECK(hose.friction_range == std::vector<double>{0.8, 1.2});
  CHECK(hose.shape == "hooks");
  const Part leao = LoadPart("leao2022");
  CHECK(leao.friction == pvc.friction);
  CHECK(leao.mass_kg == pvc.mass_kg);
  CHECK(leao.shape == "polyline");
}

TEST_CASE("An unknown part name is missing and names the nearest", "[unit]") {
  const std::string text = MessageOf([] { LoadPart("pvc_b"); }, ErrorKind::kMissing);
  CHECK_THAT(text, Catch::Contains("'pvc_b'") && Catch::Contains("nearest is 'pvc_a'"));
  MessageOf([] { LoadPart(""); }, ErrorKind::kMissing);
  MessageOf([] { LoadPart("no/such/file.toml"); }, ErrorKind::kMissing);
}

TEST_CASE("A user's part file is read strictly", "[unit]") {
  {
    const PartFile file("name = \"mine\"\nradius_m = 0.02\nlength_m = 1.0\n");
    const Part part = LoadPart(file.path());
    CHECK(part.name == "mine");
    CHECK(part.radius_m == 0.02);
  }
  const auto refused = [](const std::string& text) {
    const PartFile file(text);
    return MessageOf([&] { LoadPart(file.path()); }, ErrorKind::kConfig);
  };
  CHECK_THAT(refused("radius_m = 0.05\n"), Catch::Contains("radius_m") && Catch::Contains("0.04"));
  CHECK_THAT(refused("radius = 0.02\n"), Catch::Contains("radius_m"));
  CHECK_THAT(refused("mass_kg = \"heavy\"\n"), Catch::Contains("mass_kg"));
  CHECK_THAT(refused("kind = \"rope\"\n"), Catch::Contains("rope") && Catch::Contains("hose"));
  CHECK_THAT(refused("source = \"weighed\\nhere\"\n"),
             Catch::Contains("source is 'weighed\\x0Ahere'; allowed: UTF-8 without line breaks"));
  CHECK_THAT(refused("bend_deg = [70, 10]\n"), Catch::Contains("bend_deg is [70, 10]"));
  CHECK_THAT(refused("length_m = 0.06\nradius_m = 0.03\n"), Catch::Contains("four radii"));
  CHECK_THAT(refused("shape = \"hooks\"\nlength_m = 0.2\nbend_deg = [90, 150]\n"),
             Catch::Contains("too short for hooks"));
}

TEST_CASE("A part goes to JSON and back, by name when it is a shipped one", "[unit]") {
  for (const std::string& name : PartNames()) {
    const Json json = PartToJson(LoadPart(name));
    REQUIRE(json.is_string());
    CHECK(PartToJson(PartFromJson(JsonView(json, "x"))) == json);
    CHECK_FALSE(LoadPart(name).source.empty());  // Whoever reads a report wants to know.
  }
  Part mine = LoadPart("hose_b");
  mine.radius_m = 0.012;
  const Json json = PartToJson(mine);
  REQUIRE(json.is_object());
  const Part back = PartFromJson(JsonView(json, "x"));
  CHECK(back.radius_m == 0.012);
  CHECK(PartToJson(back) == json);
}

TEST_CASE("A bad part in a pile file is named", "[unit]") {
  const auto refused = [](const char* text, ErrorKind kind) {
    const Json json = Json::parse(text);
    return MessageOf([&] { PartFromJson(JsonView(json, "p.json")); }, kind);
  };
  CHECK_THAT(refused(R"("pvc")", ErrorKind::kMissing), Catch::Contains("p.json: part: "));
  CHECK_THAT(refused("7", ErrorKind::kBadData), Catch::Contains("name or an object"));
  CHECK_THAT(refused(R"({"raduis_m": 0.01})", ErrorKind::kBadData), Catch::Contains("'radius_m'"));
  CHECK_THAT(refused(R"({"radius_m": 1})", ErrorKind::kBadData), Catch::Contains("0.003 to 0.04"));
  CHECK_THAT(refused(R"({"links": 9.5})", ErrorKind::kBadData), Catch::Contains("links"));
  CHECK_THAT(refused(R"({"shape": "spiral"})", ErrorKind::kBadData), Catch::Contains("'spiral'"));
}

TEST_CASE("A bin size is three numbers in range", "[unit]") {
  CHECK(ParseBinSize("0.80,0.60,0.09") == std::array<double, 3>{0.8, 0.6, 0.09});
  for (const char* text : {"", "0.8,0.6", "0.8,0.6,0.09,1", "0.8;0.6;0.09", "nan,0.6,0.09",
                           "0.8,0.6,9", "-0.8,0.6,0.09", "0.8, 0.6,0.09", "0.8,0.6,0.09x"}) {
    const std::string message = MessageOf([&] { ParseBinSize(text); }, ErrorKind::kUsage);
    CHECK_THAT(message, Catch::Contains(std::string("'") + text + "'"));
  }
  Bin bin;
  bin.size_m = {0.8, 0.6, 0.2};
  const Json json = ToJson(bin);
  const Bin back = BinFromJson(JsonView(json, "x"));
  CHECK(back.size_m == bin.size_m);
  CHECK(back.X_BN.isApprox(bin.X_BN, 1e-15));
}

TEST_CASE("Drawn physics stays in its ranges, spans them and depends on the stream alone",
          "[unit]") {
  const Part hose = LoadPart("hose_b");
  double low = 1e9, high = 0;
  for (std::uint64_t round = 0; round < 200; ++round) {
    const RoundPhysics physics = DrawPhysics({}, hose, RandomStream(1, round, "physics"));
    CHECK(physics.tube_friction >= 0.8);
    CHECK(physics.tube_friction < 1.2);
    CHECK(physics.bending_stiffness_Nm2 >= 0.05);
    CHECK(physics.bending_stiffness_Nm2 < 0.30);
    CHECK(physics.X_SbelievedS.translation().norm() < 6 * 0.0003);
    low = std::min(low, physics.tube_friction);
    high = std::max(high, physics.tube_friction);
  }
  CHECK(low < 0.82);
  CHECK(high > 1.18);
  const RoundPhysics a = DrawPhysics({}, hose, RandomStream(1, 5, "physics"));
  const RoundPhysics b = DrawPhysics({}, hose, RandomStream(1, 5, "physics"));
  CHECK(a.mass_scale == b.mass_scale);
  CHECK(a.X_SbelievedS.matrix() == b.X_SbelievedS.matrix());
  PhysicsRanges nominal;
  nominal.randomize = false;
  CHECK(DrawPhysics(nominal, hose, RandomStream(1, 5, "physics")).tube_friction == 0.9);
  PhysicsRanges bad;
  bad.tube_friction = {0.5};
  CHECK_THAT(
      MessageOf([&] { DrawPhysics(bad, hose, RandomStream(1, 5, "physics")); }, ErrorKind::kConfig),
      Catch::Contains("physics.tube_friction has 1"));
}

TEST_CASE("Friction of each pair is drawn apart, and given ranges win", "[unit]") {
  const Part hose = LoadPart("hose_b");
  const RoundPhysics drawn = DrawPhysics({}, hose, RandomStream(1, 5, "physics"));
  CHECK(drawn.bin_friction != drawn.tube_friction);
  CHECK(drawn.tray_friction != drawn.bin_friction);
  CHECK(drawn.loss_factor >= hose.loss_factor_range[0]);
  CHECK(drawn.loss_factor < hose.loss_factor_range[1]);
  PhysicsRanges ranges;
  ranges.bin_friction = {0.1, 0.1};
  ranges.tray_friction = {0.2, 0.2};
  ranges.loss_factor = {0.3, 0.3};
  const RoundPhysics given = DrawPhysics(ranges, hose, RandomStream(1, 5, "physics"));
  CHECK(given.tube_friction == drawn.tube_friction);
  CHECK(given.bin_friction == 0.1);
  CHECK(given.tray_friction == 0.2);
  CHECK(given.loss_factor == 0.3);
}

TEST_CASE("Tubes of one batch differ within their shares, each the same whoever asks", "[unit]") {
  const Part hose = LoadPart("hose_b");
  PhysicsRanges ranges;
  ranges.specimen = {0.03, 0.01, 0.02, 0.2, 0.1, 0.3};
  const RoundPhysics physics = DrawPhysics(ranges, hose, RandomStream(1, 5, "physics"));
  double widest_mass = 0.0, widest_loss = 0.0;
  for (int id = 0; id < 200; ++id) {
    const Specimen one = physics.SpecimenOf(id);
    CHECK(one.mass == physics.SpecimenOf(id).mass);
    CHECK(std::abs(one.radius - 1.0) <= 0.01);
    CHECK(std::abs(one.length - 1.0) <= 0.02);
    CHECK(std::abs(one.stiffness - 1.0) <= 0.2);
    CHECK(std::abs(one.friction - 1.0) <= 0.1);
    widest_mass = std::max(widest_mass, std::abs(one.mass - 1.0));
    widest_loss = std::max(widest_loss, std::abs(one.loss - 1.0));
  }
  CHECK(widest_mass > 0.027);
  CHECK(widest_mass <= 0.03);
  CHECK(widest_loss > 0.27);
  CHECK(NominalPhysics(hose).SpecimenOf(7).mass == 1.0);
}

}  // namespace
}  // namespace tubetwin

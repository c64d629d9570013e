#include "perception/scene/tube_scene.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

/// The rule is sampled every millimetre, so positions along a curve are this exact.
constexpr double kSampleTolerance_m = 0.0011;

TubeScene SceneOf(const std::vector<Polyline>& lines_N) {
  TubeScene scene;
  for (std::size_t i = 0; i < lines_N.size(); ++i) {
    PerceivedTube tube;
    tube.id = static_cast<int>(10 * (i + 1));
    tube.centerline_N = lines_N[i];
    tube.radius_m = kRadius;
    tube.length_m = Length(lines_N[i]) + 2 * kRadius;
    tube.visible_fraction = 0.5;
    tube.confidence = 0.75;
    tube.node_visible.assign(lines_N[i].size(), 1);
    tube.node_visible[0] = 0;
    scene.tubes.push_back(tube);
  }
  AssignClasses(scene, kRadius);
  return scene;
}

/// A straight tube along x at height z, from x = -0.2 to 0.2, at y.
Polyline AlongX(double y, double z) { return {{-0.2, y, z}, {0.2, y, z}}; }

TEST_CASE("Two crossing tubes give one crossing at the place where they cross", "[unit]") {
  const Polyline low = AlongX(0.0, kRadius);
  const Polyline high = {{0.05, -0.1, 3 * kRadius}, {0.05, 0.3, 3 * kRadius}};
  const auto crossings = FindCrossings({low, high}, kRadius);
  REQUIRE(crossings.size() == 1);
  CHECK(crossings[0].over == 1);
  CHECK(crossings[0].under == 0);
  CHECK(crossings[0].at_under_m == Approx(0.25).margin(kSampleTolerance_m));
  CHECK(crossings[0].at_over_m == Approx(0.10).margin(kSampleTolerance_m));
  CHECK(crossings[0].gap_m == Approx(0.0).margin(1e-12));
}

TEST_CASE("A hook is under its partner and over it", "[unit]") {
  const Polyline wave = {{-0.2, 0, 0.01}, {0.0, 0, 0.05}, {0.2, 0, 0.09}};
  const Polyline bridge = {
      {-0.1, -0.1, 0.05}, {-0.1, 0.1, 0.05}, {0.1, 0.1, 0.05}, {0.1, -0.1, 0.05}};
  const TubeScene scene = SceneOf({wave, bridge});
  REQUIRE(scene.crossings.size() == 2);
  CHECK(scene.tubes[0].tube_class == TubeClass::kWeak);
  CHECK(scene.tubes[1].tube_class == TubeClass::kWeak);
  CHECK(scene.tubes[0].over == std::vector<int>{20});
  CHECK(scene.tubes[0].under == std::vector<int>{20});
  CHECK(scene.tubes[1].over == std::vector<int>{10});
  CHECK(scene.tubes[1].under == std::vector<int>{10});
  CHECK(scene.tubes[0].hooked == std::vector<int>{20});
  CHECK(scene.tubes[1].hooked == std::vector<int>{10});
}

TEST_CASE("A crossing is visible where both tubes are seen, else inferred", "[unit]") {
  const Polyline low = Resample(AlongX(0.0, kRadius), 0.005);
  const Polyline high = Resample({{0.05, -0.1, 3 * kRadius}, {0.05, 0.3, 3 * kRadius}}, 0.005);
  TubeScene scene = SceneOf({low, high});
  const auto hide = [&](int tube, double from_x, double to_x) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      if (tube == 0 && low[i].x() > from_x && low[i].x() < to_x) scene.tubes[0].node_visible[i] = 0;
      if (tube == 1 && std::abs(high[i].y()) < 0.01) scene.tubes[1].node_visible[i] = 0;
    }
    AssignClasses(scene, kRadius);
    REQUIRE(scene.crossings.size() == 1);
    return scene.crossings[0].visible;
  };
  // What the upper tube itself covers may be unseen: 25 mm across, and half that on either side.
  CHECK(hide(0, 0.03, 0.07));
  CHECK(scene.crossings[0].under_to_m - scene.crossings[0].under_from_m ==
        Approx(2 * kRadius).margin(2 * kSampleTolerance_m));
  CHECK_FALSE(hide(0, -0.01, 0.07));
  scene.tubes[0].node_visible.assign(low.size(), 1);
  CHECK_FALSE(hide(1, 0, 0));
  CHECK_FALSE(TubeSceneFromJson(JsonView(ToJson(scene), "text")).crossings[0].visible);
}

TEST_CASE("A tube that another crosses twice is strong", "[unit]") {
  const Polyline low = AlongX(0.0, kRadius);
  const Polyline u = {{-0.1, -0.1, 0.05}, {-0.1, 0.1, 0.05}, {0.1, 0.1, 0.05}, {0.1, -0.1, 0.05}};
  const TubeScene scene = SceneOf({low, u});
  REQUIRE(scene.crossings.size() == 2);
  CHECK(scene.tubes[0].tube_class == TubeClass::kStrong);
  CHECK(scene.tubes[0].under == std::vector<int>{20});
  CHECK(scene.tubes[1].tube_class == TubeClass::kFree);
}

TEST_CASE("Tubes that touch side by side are both free", "[unit]") {
  const TubeScene scene = SceneOf({AlongX(0.0, kRadius), AlongX(2 * kRadius, kRadius)});
  CHECK(scene.crossings.empty());
  CHECK(scene.tubes[0].tube_class == TubeClass::kFree);
  CHECK(scene.tubes[1].tube_class == TubeClass::kFree);
}

TEST_CASE("A tube stacked on another covers it in a single run", "[unit]") {
  const auto crossings =
      FindCrossings({AlongX(0.0, 0.03), AlongX(0.002, 0.03 + 2 * kRadius)}, kRadius);
  REQUIRE(crossings.size() == 1);
  CHECK(crossings[0].under == 0);
}

TEST_CASE("The limits of the rule are one radius sideways and one radius up", "[unit]") {
  const Polyline low = AlongX(0.0, 0.02);
  CHECK(FindCrossings({low, AlongX(0.99 * kRadius, 0.02 + 1.01 * kRadius)}, kRadius).size() == 1);
  CHECK(FindCrossings({low, AlongX(1.01 * kRadius, 0.02 + 1.01 * kRadius)}, kRadius).empty());
  CHECK(FindCrossings({low, AlongX(0.99 * kRadius, 0.02 + 0.99 * kRadius)}, kRadius).empty());
}

TEST_CASE("A tube that crosses itself is not under another", "[unit]") {
  const Polyline loop = {
      {-0.2, 0, 0.01}, {0.1, 0, 0.01}, {0.1, 0.1, 0.03}, {0, 0.1, 0.05}, {0, -0.1, 0.05}};
  const TubeScene scene = SceneOf({loop, AlongX(0.3, kRadius)});
  CHECK(scene.crossings.empty());
  CHECK(scene.tubes[0].tube_class == TubeClass::kFree);
}

TEST_CASE("A steep end that stands over a tube covers it only where it is high enough", "[unit]") {
  const Polyline low = AlongX(0.0, 0.02);
  const Polyline steep = {{0.0, 0.0, 0.021}, {0.005, 0.0, 0.2}};
  const auto crossings = FindCrossings({low, steep}, kRadius);
  REQUIRE(crossings.size() == 1);
  CHECK(crossings[0].at_over_m > 0.01);
}

TEST_CASE("A scene survives writing and reading", "[unit]") {
  TubeScene scene = SceneOf({AlongX(0.0, kRadius), {{0.05, -0.1, 0.04}, {0.05, 0.3, 0.04}}});
  scene.unseen_m3 = 0.0125;
  scene.unseen_floor_m2 = 0.25;
  scene.radius_estimate_m = 0.0131;
  scene.warnings = {"the part is another"};
  scene.unseen_floor = {3, 2, 0.25, 0.5, {0, 1, 1, 0, 0, 1}};
  scene.unexplained_N = {{0.1, 0.2, 0.03}, {0.1, 0.2, 0.035}};
  scene.bin_content = BinContent::kNotEmpty;
  scene.bin_content_reason = "two tubes";
  scene.timing_ms.total = 12.5;
  scene.threads = 2;
  const Json json = ToJson(scene);
  CHECK(json["schema"] == "tubetwin/tubes/1");
  CHECK(json["frame"] == "bin");
  CHECK(json["bin_content"] == "not_empty");
  CHECK(json["unexplained_points"] == 2);
  CHECK(json["unseen_floor"]["rows"] == Json{".##", "..#"});
  CHECK(json["unseen_floor"]["first_corner_m"] == Json{-0.375, -0.5});
  CHECK(json["tubes"][0]["class"] == "weak");
  const TubeScene back = TubeSceneFromJson(JsonView(json, "scene"));
  CHECK(ToJson(back) == json);
  REQUIRE(back.tubes.size() == 2);
  CHECK(back.tubes[0].id == 10);
  CHECK(back.tubes[0].node_visible[0] == 0);
  CHECK(back.crossings[0].over == 20);
  CHECK(back.crossings[0].confidence == scene.crossings[0].confidence);
}

/// What TubeSceneFromJson says about a document, or "".
std::string MessageOf(const Json& json) {
  try {
    TubeSceneFromJson(JsonView(json, "t.json"));
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kBadData);
    return e.what();
  }
  return "";
}

TEST_CASE("Wrong scene files are refused with the field, the value and what is allowed", "[unit]") {
  const Json good =
      ToJson(SceneOf({AlongX(0.0, kRadius), {{0.05, -0.1, 0.04}, {0.05, 0.3, 0.04}}}));
  Json bad = good;
  bad["tubes"][1]["class"] = "loose";
  CHECK(MessageOf(bad) == "t.json: tubes[1].class: is 'loose', allowed are free, weak, strong");
  bad = good;
  bad["tubes"][1]["id"] = 10;
  CHECK(MessageOf(bad) == "t.json: tubes[1].id: is 10, which another tube has already");
  bad = good;
  bad["crossings"][0]["under"] = 5;
  CHECK(MessageOf(bad) == "t.json: crossings[0].under: names no tube of this file");
  bad = good;
  bad["frame"] = "base";
  CHECK(MessageOf(bad) == "t.json: frame: is 'base', 'bin' is needed");
  bad = good;
  bad["tubes"][0]["centerline_m"] = Json::array({Json::array({0, 0, 0})});
  CHECK(MessageOf(bad) == "t.json: tubes[0].centerline_m: two points are needed");
}

TEST_CASE("A scene file's numbers stay within what a bin holds", "[unit]") {
  const Json good =
      ToJson(SceneOf({AlongX(0.0, kRadius), {{0.05, -0.1, 0.04}, {0.05, 0.3, 0.04}}}));
  REQUIRE(MessageOf(good) == "");
  const auto said = [&](const char* pointer, const Json& value) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    return MessageOf(bad);
  };
  CHECK(said("/tubes/1/centerline_m/0/0", 1e300) ==
        "t.json: tubes[1].centerline_m[0][0]: is 1e+300, allowed are -100 to 100");
  CHECK(said("/tubes/1/centerline_m/0/2", -3.5) ==
        "t.json: tubes[1].centerline_m[0][2]: is -3.5, allowed are -3 to 3");
  CHECK(said("/tubes/1/centerline_m/1", Json::array({0.05, -0.1, 0.04})) ==
        "t.json: tubes[1].centerline_m[1]: is 0 m from the point before, allowed are 1e-06 m and "
        "more");
  CHECK(said("/tubes/1/radius_m", 0.0) ==
        "t.json: tubes[1].radius_m: is 0, allowed are 0.001 to 0.1");
  CHECK(said("/tubes/1/length_m", 11.0) ==
        "t.json: tubes[1].length_m: is 11, allowed are 1e-06 to 10");
  CHECK(said("/tubes/1/id", -1) == "t.json: tubes[1].id: is -1, allowed are 0 to 2147483647");
  CHECK(said("/tubes/1/over", Json::array({"x"})) ==
        "t.json: tubes[1].over[0]: a whole number is needed, found \"x\"");
  CHECK(said("/crossings/0/gap_m", 1e9) ==
        "t.json: crossings[0].gap_m: is 1e+09, allowed are -10 to 10");
  Json zigzag = Json::array();
  for (int i = 0; i < 10; ++i) zigzag.push_back(Json::array({i % 2 == 0 ? -2.5 : 2.5, 0, 0.02}));
  CHECK(said("/tubes/0/centerline_m", zigzag) ==
        "t.json: tubes[0].centerline_m: is 45 m long, allowed are up to 10 m");
  Json many = Json::array();
  for (int i = 0; i <= 2000; ++i) many.push_back(Json::array({0.001 * i, 0, 0.02}));
  CHECK(said("/tubes/0/centerline_m", many) ==
        "t.json: tubes[0].centerline_m: has 2001 entries, allowed are up to 2000");
}

}  // namespace
}  // namespace tubetwin

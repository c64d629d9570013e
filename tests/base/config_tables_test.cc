#include "models/base/config/config.h"
#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

struct TestCell {
  int views = 1;
  std::string driver = "a";
  std::vector<double> size_m = {1.0, 2.0};
  struct Inner {
    double share = 0.5;
    void Visit(ConfigVisitor& v) { v.Field("share", "A share.", share, {0, 1}); }
  } inner;
  void Visit(ConfigVisitor& v) {
    v.Field("views", "Views.", views, {1, 64});
    v.Choice("driver", "Driver.", driver, {"a", "b"});
    v.Field("size_m", "Size.", size_m);
    v.Section("inner", "Inner.", inner);
  }
};

ConfigSource Source(const std::string& toml) {
  ConfigSource source;
  source.AddText(toml, "f.toml");
  return source;
}

std::vector<TestCell> Expand(const std::string& toml) {
  TestCell any;
  std::vector<TestCell> out;
  for (const ConfigSource& point :
       Source(toml).ExpandLists([&any](ConfigVisitor& v) { any.Visit(v); })) {
    point.ReadInto(out.emplace_back());
  }
  return out;
}

std::string Refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kConfig);
    return e.what();
  }
  return "nothing was refused";
}

TEST_CASE("a misspelt table that is taken apart is told the name of the right one") {
  ConfigSource source;
  source.AddText("[[vieww]]\n", "views.toml");
  CHECK(source.TakeTables("view").empty());
  source.TakeTables("touch");
  CHECK_THROWS_WITH(source.Read([](ConfigVisitor&) {}),
                    "views.toml:1:3: vieww: unknown key; the nearest known is 'view'");
}

TEST_CASE("a quaternion that is none is told where it stands") {
  struct Places {
    std::vector<double> X_FS;
    std::array<double, 7> X_FK{0, 0, 0, 1, 0, 0, 0};
    void Visit(ConfigVisitor& v) {
      v.PoseOrNone("X_FS", "one or none", X_FS);
      v.Pose("X_FK", "one", X_FK);
    }
  };
  const auto error = [](const std::string& toml) {
    ConfigSource source;
    source.AddText(toml, "c.toml");
    Places places;
    try {
      source.ReadInto(places);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(error("") == "");
  CHECK(error("X_FS = []\nX_FK = [1, 2, 3, 0.7071, 0.7071, 0, 0]") == "");
  const std::string needed = "; a quaternion w x y z of length 1 is needed, as in [1, 0, 0, 0]";
  CHECK(error("\nX_FS = [0, 0, 1, 2, 0, 0, 0]") ==
        "c.toml:2:8: X_FS: its quaternion has length 2" + needed);
  CHECK(error("X_FK = [0, 0, 1, 0, 0, 0, 0]") ==
        "c.toml:1:8: X_FK: its quaternion has length 0" + needed);
  CHECK(error("X_FK = []").starts_with("c.toml:1:8: X_FK: 7 numbers are needed"));
}

TEST_CASE("Letters beyond ASCII stand in quotes and comments alone") {
  const auto refused = [](const std::string& toml) { return Refusal([&] { Source(toml); }); };
  CHECK_THAT(refused("a = 1\ngr\xC3\xB6\xC3\x9F"
                     "e = 2"),
             Contains("f.toml:2:3: not valid TOML") && Contains("saw '\xC3\xB6'"));
  CHECK_THAT(refused("a = \"\xC3\xB6\" \xD2\x8F"), Contains("f.toml:1:9: not valid TOML"));
  CHECK_THAT(refused("a = 5Q\"\xC3\xB6\""), Contains("not valid TOML"));
  CHECK_THAT(refused("\xFF"), Contains("f.toml:1:1: not valid TOML"));
  const auto texts = Source("\xEF\xBB\xBF# \xC3\xB6\n\"\xC3\xB6\" = '\xD2\x8F' # \xC3\xB6").Texts();
  REQUIRE(texts.size() == 1);
  CHECK(texts.front() == std::pair<std::string, std::string>("\xC3\xB6", "\xD2\x8F"));
  ConfigSource source;
  source.AddOverride(
      "driver=gr\xC3\xB6\xC3\x9F"
      "e.toml");
  CHECK(source.Texts().front().second ==
        "gr\xC3\xB6\xC3\x9F"
        "e.toml");
}

}  // namespace

TEST_CASE("tables of a list become sources of their own and leave the rest") {
  ConfigSource source = Source("views = 3\n[[one]]\nviews = 4\n[[one]]\nviews = 5\n");
  const std::vector<ConfigSource> tables = source.TakeTables("one");
  REQUIRE(tables.size() == 2);
  TestCell whole, second;
  source.ReadInto(whole);  // An unknown key "one" would throw.
  tables[1].ReadInto(second);
  CHECK(whole.views == 3);
  CHECK(second.views == 5);
  CHECK(source.TakeTables("one").empty());
  CHECK_THAT(Refusal([] { Source("one = 4\n").TakeTables("one"); }), Contains("f.toml:1:1: one"));
}

TEST_CASE("a table's keys may be written with dots, in quotes or as tables") {
  ConfigSource source =
      Source("set = {views = 2, \"inner.share\" = 0.25}\nother = {inner.share = 0.75}\n");
  TestCell sample;
  source.TakeTable("set").ReadInto(sample);
  CHECK(sample.views == 2);
  CHECK(sample.inner.share == 0.25);
  source.TakeTable("other").ReadInto(sample);
  CHECK(sample.inner.share == 0.75);
  source.TakeTable("absent").ReadInto(sample);
  CHECK_THAT(Refusal([] { Source("set = {\"a b\" = 1}\n").TakeTable("set"); }),
             Contains("'a b' is no key"));
}

TEST_CASE("a moved key keeps its place in messages and is refused when it is there already") {
  ConfigSource from = Source("part = 7\n"), to = Source("views = 2\n");
  from.MoveKey("part", to, "inner.share");
  from.MoveKey("absent", to, "inner.share");
  TestCell sample;
  CHECK_THAT(Refusal([&] { to.ReadInto(sample); }), Contains("f.toml:1:8: inner.share: is 7"));
  ConfigSource again = Source("part = 3\n");
  CHECK_THAT(Refusal([&] { again.MoveKey("part", to, "views"); }), Contains("given twice"));
}

TEST_CASE("lists where a key takes one value span a grid, lists of a list key do not") {
  const std::vector<TestCell> grid =
      Expand("views = [2, 3]\nsize_m = [4.0, 5.0]\n[inner]\nshare = [0.0, 0.5, 1.0]\n");
  REQUIRE(grid.size() == 6);
  CHECK(grid[0].inner.share == 0.0);
  CHECK(grid[0].views == 2);
  CHECK(grid[1].views == 3);
  CHECK(grid[5].inner.share == 1.0);
  for (const TestCell& point : grid) CHECK(point.size_m == std::vector<double>{4.0, 5.0});
  CHECK(Expand("size_m = [[1.0], [2.0, 3.0]]\n").at(1).size_m == std::vector<double>{2.0, 3.0});
  CHECK(Expand("views = 2\n").size() == 1);
  CHECK_THAT(Refusal([] { Expand("views = []\n"); }), Contains("empty list"));
  CHECK_THAT(Refusal([] { Expand("views = [2, 99]\n"); }), Contains("f.toml:1:13: views: is 99"));
}

TEST_CASE("keys are told with their values as a person writes them") {
  const auto texts = Source("driver = \"b\"\nsize_m = [0.5, 2]\n[inner]\nshare = 0.25\n").Texts();
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"driver", "b"}, {"inner.share", "0.25"}, {"size_m", "[0.5, 2]"}};
  CHECK(texts == expected);
}

TEST_CASE("places of keys and tables are told, of missing keys none") {
  ConfigSource source = Source("views = 2\n[[point]]\nx = 1\n[[point]]\ny = 2\n");
  CHECK(source.place() == "f.toml");
  CHECK(source.PlaceOf("views") == "f.toml:1:1");
  CHECK(source.PlaceOf("size_m").empty());
  const std::vector<ConfigSource> points = source.TakeTables("point");
  REQUIRE(points.size() == 2);
  CHECK(points[0].place().rfind("f.toml:2:", 0) == 0);
  CHECK(points[1].place().rfind("f.toml:4:", 0) == 0);
  CHECK(points[1].PlaceOf("y") == "f.toml:5:1");
  CHECK(points[1].PlaceOf("x").empty());
}

}  // namespace tubetwin

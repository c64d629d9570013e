#include "models/base/json.h"

#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json_text.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

std::string JsonError(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kBadData);
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("errors in a document name file, path, value and what is needed") {
  const Json json = Json::parse(R"({"tubes": [{"id": 1, "radius_m": 0.01}, {"id": "two"}],
                                    "flag": 1, "line": [[0, 1, 2], [0, 1]], "big": 18446744073709551615})");
  const JsonView view(json, "pile.json");
  const JsonView tubes = view.Field("tubes");
  CHECK(JsonError([&] { tubes.Item(1).Field("id").AsInteger(); }) ==
        "pile.json: tubes[1].id: a whole number is needed, found \"two\"");
  CHECK(JsonError([&] { tubes.Item(0).Field("radius"); }) ==
        "pile.json: tubes[0]: field 'radius' is missing (nearest present: 'radius_m')");
  CHECK(JsonError([&] { tubes.Item(2); }) == "pile.json: tubes: has no item 2");
  CHECK(JsonError([&] { tubes.Item(0).Field("radius_m").AsNumber(0.02, 0.5); }) ==
        "pile.json: tubes[0].radius_m: is 0.01, allowed are 0.02 to 0.5");
  CHECK(JsonError([&] { view.Field("flag").AsBool(); }) ==
        "pile.json: flag: true or false is needed, found 1");
  CHECK(JsonError([&] { view.Field("big").AsInteger(); }) ==
        "pile.json: big: a whole number below 2^63 is needed, found 18446744073709551615");
  CHECK(JsonError([&] { view.Field("line").AsPolyline(); }) ==
        "pile.json: line[1]: three numbers are needed, found 2");
  CHECK(JsonError([&] { view.Field("flag").Size(); }) ==
        "pile.json: flag: a list is needed, found number");
  CHECK(JsonError([&] { view.Field("flag").Field("x"); }) ==
        "pile.json: flag: an object is needed, found number");
}

TEST_CASE("an absent or null optional field is nothing, a present one is read") {
  const Json json = {{"none", nullptr}, {"some", 2.5}};
  const JsonView view(json, "f");
  CHECK_FALSE(view.Optional("none").has_value());
  CHECK_FALSE(view.Optional("absent").has_value());
  CHECK(view.Optional("some")->AsNumber() == 2.5);
}

TEST_CASE("a schema line of another kind or version is refused") {
  const Json json = {{"schema", "tubetwin/pile/2"}};
  CHECK(JsonError([&] { RequireSchema(JsonView(json, "f"), "pile"); }) ==
        "f: schema is 'tubetwin/pile/2', 'tubetwin/pile/1' is needed here");
  const Json good = {{"schema", "tubetwin/pile/1"}};
  CHECK_NOTHROW(RequireSchema(JsonView(good, "f"), "pile"));
}

TEST_CASE("broken JSON names the file and the byte") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "a.json", "{\"a\": 1,, }");
  CHECK(JsonError([&] { ReadJsonFile(folder / "a.json"); }) ==
        (folder / "a.json") + ": not valid JSON at byte 9 of 11");
  WriteFileAtomically(folder / "a.json", "[1e999]");
  CHECK(JsonError([&] { ReadJsonFile(folder / "a.json"); }) ==
        (folder / "a.json") + ": holds a number too large for any field");
}

TEST_CASE("numbers survive a file bit by bit and keys keep their order") {
  const TemporaryFolder folder;
  const Json json = {{"z", 0.1 + 0.2}, {"a", 1e-300}, {"m", {1, 2.5, -0.0}}};
  WriteJsonFile(json, folder / "sub/a.json");
  const Json back = ReadJsonFile(folder / "sub/a.json");
  CHECK(back.dump() == json.dump());
  CHECK(back["z"].get<double>() == 0.1 + 0.2);
}

TEST_CASE("a pose survives JSON and a quaternion that is none is refused") {
  const RigidTransform X_AB = MakeTransform(RotationFromWxyz(0.5, 0.5, -0.5, 0.5), {1, 2, 3});
  const Json json = ToJson(X_AB);
  CHECK(TransformFromJson(JsonView(json, "f")).isApprox(X_AB, 1e-15));
  const Json bad = {{"p_m", {0, 0, 0}}, {"q_wxyz", {1, 1, 0, 0}}};
  CHECK_THAT(JsonError([&] { TransformFromJson(JsonView(bad, "f")); }),
             Catch::StartsWith("f: q_wxyz: is no unit quaternion"));
}

TEST_CASE("JSON nested deeper than any file of ours is refused before it is parsed") {
  const auto nested = [](int deep) {
    return std::string(static_cast<std::size_t>(deep), '[') +
           std::string(static_cast<std::size_t>(deep), ']');
  };
  CHECK(ParseJson(nested(kDeepestJson), "f.json").is_array());
  CHECK(ParseJson("{\"a\": \"" + nested(1000) + "\\\"[\"}", "f.json").is_object());
  for (const int deep : {kDeepestJson + 1, 1000000}) {
    CHECK_THROWS_WITH(
        ParseJson(nested(deep), "f.json"),
        "f.json: byte 65: lists and objects nest more than 64 deep; allowed: up to that");
  }
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  CHECK_THROWS_WITH(ParseJson(objects, "f.json"), Catch::Matchers::Contains("byte 321: lists"));
}

TEST_CASE("whole numbers, lines and poses outside of their range are refused by name") {
  const Json json = ParseJson(
      R"({"n": 4294967296, "line": [[0, 0, 0], [1e300, 0, 0]],
          "pose": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1],
          "skewed": [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1],
          "mirrored": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0.5, 0, 0, 1]})",
      "f.json");
  const JsonView view(json, "f.json");
  CHECK(IntegerIn(view.Field("pose").Item(0), 0, 7) == 1);
  CHECK_THROWS_WITH(IntegerIn(view.Field("n"), -1, 7),
                    "f.json: n: is 4294967296, allowed are -1 to 7");
  CHECK_THROWS_WITH(CountFromJson(view.Field("n")),
                    "f.json: n: is 4294967296, allowed are 0 to 2147483647");
  CHECK_THROWS_WITH(view.Field("line").AsPolyline(),
                    "f.json: line[1][0]: is 1e+300, allowed are -100 to 100");
  CHECK(TransformOfColumns(view.Field("pose")).translation().x() == 0.5);
  for (const char* name : {"skewed", "mirrored", "line"}) {
    CHECK_THROWS_AS(TransformOfColumns(view.Field(name)), Error);
  }
}

TEST_CASE("texts of a file stay one line in messages, without control characters") {
  const Json json = ParseJson(R"({"a": "x\n\u001b[2Jy"})", "f.json");
  CHECK_THROWS_WITH(
      JsonView(json, "f.json").Field("a").Fail("is '" + json["a"].get<std::string>() + "'"),
      "f.json: a: is 'x\\x0A\\x1B[2Jy'");
}

}  // namespace tubetwin

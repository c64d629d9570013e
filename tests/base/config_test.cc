#include "models/base/config/config.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

struct ArmConfig {
  std::string driver = "twin";
  double speed_m_per_s = 0.25;
  void Visit(ConfigVisitor& v) {
    v.Choice("driver", "Who moves.", driver, {"twin", "simple_message", "replay"});
    v.Field("speed_m_per_s", "Of the tool.", speed_m_per_s, Range{0.0, 1.0});
  }
};

struct SampleConfig {
  std::int64_t seed = 1;
  int views = 8;
  bool exclude_free = false;
  double gain = 0.1;
  std::string part = "pvc_a";
  std::vector<double> pulses;
  std::array<double, 3> size_m = {0.77, 0.58, 0.09};
  std::vector<std::string> files;
  ArmConfig arm;
  void Visit(ConfigVisitor& v) {
    v.Field("seed", "Of everything random.", seed);
    v.Section("bin", "The bin.", [this](ConfigVisitor& b) {
      b.Field("size_m", "Long side, short side, height.", size_m, Range{0.01, 2.0});
    });
    v.Field("views", "Number of scans.", views, Range{1, 64});
    v.Field("exclude_free", "Never choose free tubes.", exclude_free);
    v.Field("gain", "Any number.", gain);
    v.Field("part", "Name of the part.", part);
    v.Field("pulses", "A list of any length.", pulses);
    v.Field("files", "Texts.", files);
    v.Section("cell", "Devices.", [this](ConfigVisitor& c) { c.Section("arm", "The arm.", arm); });
  }
};

std::string ToToml(SampleConfig config, bool with_docs = false) {
  return WriteToml([&config](ConfigVisitor& v) { config.Visit(v); }, with_docs);
}

SampleConfig ReadText(const std::string& toml) {
  ConfigSource source;
  source.AddText(toml, "bad.toml");
  SampleConfig config;
  source.ReadInto(config);
  return config;
}

/// The message of the configuration error that `toml` causes.
std::string ConfigError(const std::string& toml) {
  try {
    ReadText(toml);
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kConfig);
    return e.what();
  }
  return "no error";
}

std::string OverrideError(const std::string& text) {
  try {
    ConfigSource source;
    source.AddText("[cell.arm]\nspeed_m_per_s = 0.5\n", "good.toml");
    source.AddOverride(text);
    SampleConfig config;
    source.ReadInto(config);
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kConfig);
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("an empty configuration keeps every default") {
  CHECK(ToToml(ReadText("")) == ToToml(SampleConfig{}));
}

TEST_CASE("every type of value is read") {
  const SampleConfig c = ReadText(
      "seed = 9007199254740993\nviews = 3\nexclude_free = true\ngain = 2\npart = 'hose_b'\n"
      "pulses = [1, 2.5]\nfiles = ['a', 'b']\nbin.size_m = [0.8, 0.6, 0.2]\n"
      "[cell.arm]\ndriver = 'replay'\n");
  CHECK(c.seed == 9007199254740993);  // Not representable as a double.
  CHECK(c.views == 3);
  CHECK(c.exclude_free);
  CHECK(c.gain == 2.0);
  CHECK(c.part == "hose_b");
  CHECK(c.pulses == std::vector<double>{1.0, 2.5});
  CHECK(c.files == std::vector<std::string>{"a", "b"});
  CHECK(c.size_m == std::array<double, 3>{0.8, 0.6, 0.2});
  CHECK(c.arm.driver == "replay");
  CHECK(c.arm.speed_m_per_s == 0.25);
}

TEST_CASE("later layers win key by key, lists are replaced whole") {
  ConfigSource source;
  source.AddText("views = 2\npulses = [1, 2, 3]\n[cell.arm]\ndriver = 'replay'\n", "a.toml");
  source.AddText("pulses = [4]\n[cell.arm]\nspeed_m_per_s = 0.75\n", "b.toml");
  source.AddOverride("views=5");
  SampleConfig c;
  source.ReadInto(c);
  CHECK(c.views == 5);
  CHECK(c.pulses == std::vector<double>{4.0});
  CHECK(c.arm.driver == "replay");
  CHECK(c.arm.speed_m_per_s == 0.75);
}

TEST_CASE("overrides reach nested keys and take bare texts") {
  ConfigSource source;
  source.AddOverride("cell.arm.driver=simple_message");
  source.AddOverride("part = out/my tube.toml");
  source.AddOverride("bin.size_m=[0.5, 0.4, 0.1]");
  source.AddOverride("cell={arm={speed_m_per_s=0.5}}");
  SampleConfig c;
  source.ReadInto(c);
  CHECK(c.arm.driver == "simple_message");
  CHECK(c.part == "out/my tube.toml");
  CHECK(c.size_m[1] == 0.4);
  CHECK(c.arm.speed_m_per_s == 0.5);
}

TEST_CASE("an override of a text may look like a number, a truth value or a date") {
  for (const char* text : {"123", "1e3", "true", "2020-01-01", "007", ""}) {
    ConfigSource source;
    source.AddOverride(std::string("part=") + text);
    SampleConfig c;
    source.ReadInto(c);
    CHECK(c.part == text);
  }
}

TEST_CASE("an unknown key is an error with its place and the nearest name") {
  CHECK(ConfigError("seed = 2\nviewz = 3\n") ==
        "bad.toml:2:1: viewz: unknown key; the nearest known is 'views'");
  CHECK(ConfigError("[cell.arm]\n  drive = 'twin'\n") ==
        "bad.toml:2:3: cell.arm.drive: unknown key; the nearest known is 'cell.arm.driver'");
  CHECK(ConfigError("[cell.army]\n") ==
        "bad.toml:1:7: cell.army: unknown key; the nearest known is 'cell.arm'");
}

TEST_CASE("a key in the wrong table is told where it belongs") {
  CHECK(ConfigError("driver = 'twin'\n") ==
        "bad.toml:1:1: driver: unknown key; there is 'cell.arm.driver'");
}

TEST_CASE("a value of the wrong type is an error with its place") {
  CHECK(ConfigError("views = 'many'\n") ==
        "bad.toml:1:9: views: a whole number is needed, found the text \"many\"");
  CHECK(ConfigError("views = 3.0\n") ==
        "bad.toml:1:9: views: a whole number is needed, found the real number 3");
  CHECK(ConfigError("exclude_free = 1\n") ==
        "bad.toml:1:16: exclude_free: true or false is needed, found 1");
  CHECK(ConfigError("gain = true\n") == "bad.toml:1:8: gain: a number is needed, found true");
  CHECK(ConfigError("gain = nan\n") == "bad.toml:1:8: gain: a finite number is needed, found nan");
  CHECK(ConfigError("part = 5\n") == "bad.toml:1:8: part: a text is needed, found 5");
  CHECK(ConfigError("part = 2020-01-01\n") ==
        "bad.toml:1:8: part: a text is needed, found a date or time");
  CHECK(ConfigError("pulses = 5\n") ==
        "bad.toml:1:10: pulses: a list of numbers is needed, found 5");
  CHECK(ConfigError("files = ['a', 7]\n") == "bad.toml:1:15: files[1]: a text is needed, found 7");
  CHECK(ConfigError("cell = 5\n") == "bad.toml:1:8: cell: a table is needed, found 5");
  CHECK(ConfigError("[gain]\nx = 1\n") == "bad.toml:1:1: gain: a number is needed, found a table");
}

TEST_CASE("a value outside its range is an error with its place and what is allowed") {
  CHECK(ConfigError("views = 65\n") == "bad.toml:1:9: views: is 65, allowed is 1 to 64");
  CHECK(ConfigError("cell.arm.speed_m_per_s = -0.5\n") ==
        "bad.toml:1:26: cell.arm.speed_m_per_s: is -0.5, allowed is 0 to 1");
  CHECK(ConfigError("bin.size_m = [0.8, 0.6, 7]\n") ==
        "bad.toml:1:25: bin.size_m[2]: is 7, allowed is 0.01 to 2");
}

TEST_CASE("a list of the wrong length is an error with its place") {
  CHECK(ConfigError("bin.size_m = [0.8, 0.6]\n") ==
        "bad.toml:1:14: bin.size_m: 3 numbers are needed, found 2");
}

TEST_CASE("a wrong choice is an error that lists the choices") {
  CHECK(ConfigError("[cell.arm]\ndriver = 'twim'\n") ==
        "bad.toml:2:10: cell.arm.driver: is \"twim\", allowed are twin, simple_message, replay; "
        "the nearest is 'twin'");
}

TEST_CASE("bad syntax is an error with its place") {
  CHECK_THAT(ConfigError("seed = 1\nviews = = 2\n"),
             Catch::StartsWith("bad.toml:2:9: not valid TOML: "));
  CHECK_THAT(ConfigError("seed = 1\nseed = 2\n"), Catch::StartsWith("bad.toml:2:"));
}

TEST_CASE("a misprint where a key should begin is an error with its place") {
  for (const char* text :
       {"[=a]", "[[~a]]", "[.a]", "[a.]", "[a", "[", "[[a]", "a. = 1", "a.=", "= 1", "~a = 1",
        "x = {=1}", "x = {~}", "x = {a.}", "x = [", "x =", "x = 'a"}) {
    INFO(text);
    try {
      ConfigSource().AddText(text, "f.toml");
      FAIL("not refused");
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::kConfig);
      CHECK_THAT(e.what(), Catch::StartsWith("f.toml:1:"));
    }
  }
}

TEST_CASE("errors of overrides name the override") {
  CHECK(OverrideError("cell.arm.sped_m_per_s=1") ==
        "--set cell.arm.sped_m_per_s=1: cell.arm.sped_m_per_s: unknown key; the nearest known is "
        "'cell.arm.speed_m_per_s'");
  CHECK(OverrideError("views=0") == "--set views=0: views: is 0, allowed is 1 to 64");
  CHECK(OverrideError("views=") ==
        "--set views=: views: a whole number is needed, found the text \"\"");
  CHECK(OverrideError("cell.arm=5") == "--set cell.arm=5: cell.arm: a table is needed, found 5");
  CHECK(OverrideError("seed.x=5") ==
        "--set seed.x=5: seed: a whole number is needed, found a table");
}

TEST_CASE("an override that is no key=value is a usage error") {
  for (const char* text : {"views", "=5", "a..b=1", "a b=1", ""}) {
    ConfigSource source;
    try {
      source.AddOverride(text);
      FAIL("accepted: " << text);
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::kUsage);
      CHECK_THAT(e.what(), Catch::StartsWith(std::string("--set ") + text + ": "));
    }
  }
  ConfigSource source;
  CHECK_THROWS_WITH(source.AddOverride("a\xc1\x19=1"), Catch::StartsWith("--set a\\xC1\\x19=1: "));
}

TEST_CASE("a key that no person wrote is not shown whole") {
  CHECK_THAT(ConfigError(std::string(5000, 'a') + " = 1"),
             Catch::StartsWith("bad.toml:1:1: " + std::string(100, 'a') + "...: unknown key"));
}

TEST_CASE("odd bytes of a file are named in printable ones") {
  CHECK_THAT(ConfigError("seed = n\x19"), Catch::Contains("'n\\x19'"));
  CHECK_THAT(ConfigError("\"s\\u001bd\" = 1"), Catch::Contains("s\\x1Bd: unknown key"));
}

TEST_CASE("a missing configuration file is missing input and names the file") {
  ConfigSource source;
  try {
    source.AddFile("no/such/file.toml");
    FAIL("accepted");
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kMissing);
    CHECK_THAT(e.what(), Catch::Contains("no/such/file.toml"));
  }
}

TEST_CASE("a written configuration reads back as the same bytes") {
  SampleConfig c;
  c.seed = -9007199254740993;
  c.gain = 0.1 + 0.2;
  c.part = "quote \" backslash \\ newline \n bell \a umlaut \xc3\xbc # [x]";
  c.pulses = {1.0, 1e-300, -5e22, 1.0 / 3.0};
  c.files = {"", "a, b"};
  c.arm.driver = "replay";
  for (const bool with_docs : {false, true}) {
    const SampleConfig back = ReadText(ToToml(c, with_docs));
    CHECK(back.seed == c.seed);
    CHECK(back.gain == c.gain);
    CHECK(back.part == c.part);
    CHECK(back.pulses == c.pulses);
    CHECK(back.files == c.files);
    CHECK(ToToml(back, with_docs) == ToToml(c, with_docs));
  }
}

TEST_CASE("fields visited after a section still belong to their own table") {
  CHECK_THAT(ToToml(SampleConfig{}), Catch::StartsWith("seed = 1\nviews = 8\n") &&
                                         Catch::EndsWith("\n\n[bin]\nsize_m = [0.77, 0.58, 0.09]\n"
                                                         "\n[cell]\n\n[cell.arm]\n"
                                                         "driver = \"twin\"\n"
                                                         "speed_m_per_s = 0.25\n"));
}

TEST_CASE("documentation stands as a comment over each key") {
  const std::string toml = ToToml(SampleConfig{}, true);
  CHECK_THAT(toml, Catch::Contains("# Number of scans. Allowed: 1 to 64.\nviews = 8\n"));
  CHECK_THAT(toml, Catch::Contains("# Who moves. One of: twin, simple_message, replay.\n"));
}

TEST_CASE("the schema states type, limits, choices and defaults and refuses other keys") {
  SampleConfig c;
  const Json schema = Json::parse(WriteConfigSchema([&c](ConfigVisitor& v) { c.Visit(v); }));
  CHECK(schema["type"] == "object");
  CHECK(schema["additionalProperties"] == false);
  const Json& views = schema["properties"]["views"];
  CHECK(views == Json{{"description", "Number of scans."},
                      {"type", "integer"},
                      {"minimum", 1},
                      {"maximum", 64},
                      {"default", 8}});
  const Json& arm = schema["properties"]["cell"]["properties"]["arm"];
  CHECK(arm["additionalProperties"] == false);
  CHECK(arm["properties"]["driver"]["enum"] == Json{"twin", "simple_message", "replay"});
  const Json& size = schema["properties"]["bin"]["properties"]["size_m"];
  CHECK(size["minItems"] == 3);
  CHECK(size["items"]["maximum"] == 2.0);
}

TEST_CASE("describing a configuration does not change it") {
  SampleConfig c;
  c.views = 5;
  c.size_m = {0.5, 0.4, 0.1};
  const std::string before = ToToml(c);
  WriteConfigSchema([&c](ConfigVisitor& v) { c.Visit(v); });
  CHECK(ToToml(c) == before);
}

TEST_CASE("TOML nested deeper than any configuration is refused before it is parsed", "[base]") {
  const auto repeated = [](const std::string& text, int times) {
    std::string out;
    for (int i = 0; i < times; ++i) out += text;
    return out;
  };
  const std::string problem =
      ": lists, tables or the parts of a key nest more than 32 deep; allowed: up to that";
  for (const std::string& text :
       {repeated("a.", 20000) + "b = 1", "[" + repeated("a.", 20000) + "b]",
        "a = " + repeated("[", 20000), "a = " + repeated("{a=", 20000),
        repeated("\"a\" . ", 33) + "b = 1"}) {
    ConfigSource source;
    CHECK_THROWS_WITH(source.AddText("# [[[[\nc = '[[['\n" + text, "f.toml"), "f.toml:3" + problem);
    CHECK_THROWS_AS(source.AddText(text, "f.toml"), Error);
  }
  ConfigSource source;
  CHECK_THROWS_WITH(source.AddOverride(repeated("a.", 32) + "b=1"),
                    Catch::Matchers::Contains(problem));
  CHECK_THROWS_WITH(source.AddOverride("a=" + repeated("[", 33)),
                    Catch::Matchers::Contains(problem));
  // Brackets and dots within texts and comments nest nothing, whatever quotes are among them.
  const std::string many = repeated("[.", 100);
  source.AddText("a = \"" + many + "\\\"" + many + "\" # " + many + "\nb = \"\"\"\n" + many +
                     "\"\"" + many + "\"\"\"\"\"\nc = '" + many + "\\'\nd = '''" + many + "'" +
                     many + "''''\ne = \"\"\n" + repeated("f = 0.5\n", 1),
                 "f.toml");
  source.AddText(repeated("[[x]]\n", 100) + "g = [" + repeated("[1.5], ", 100) + "]\n", "g.toml");
}

TEST_CASE("the name of a file or part has no control characters", "[base]") {
  ConfigSource source;
  source.AddText("name = '''a\nb'''", "f.toml");
  std::string name;
  const auto visit = [&](ConfigVisitor& v) { v.NameOrFile("name", "", name); };
  CHECK_THROWS_WITH(source.Read(visit),
                    "f.toml:1:8: name: is \"a\\nb\"; allowed: texts without control characters");
  ConfigSource typed;
  typed.AddOverride("name=a\x1b[31m");
  CHECK_THROWS_WITH(typed.Read(visit), Catch::Matchers::Contains("\\u001b[31m"));
}

}  // namespace tubetwin

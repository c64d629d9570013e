#include "models/base/config/config_edit.h"

#include "models/base/config/config.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

const TomlNumbers kNumbers{"calibration", "X_FS", {0.001, -0.25, 3.0}};

std::string Edited(const std::string& toml) { return WithTomlNumbers(toml, "cell.toml", kNumbers); }

TEST_CASE("Numbers of a TOML text are replaced where they stand", "[unit]") {
  const auto same_around = [](const std::string& before, const std::string& after) {
    CHECK(Edited(before + "[1, 2, 3]" + after) == before + "[0.001, -0.25, 3]" + after);
  };
  same_around("[calibration]\nX_FS = ", "  # by drawing\n\n[bin]\nX_BN=[ 1, 2 ]#here\n");
  same_around("# first\n[calibration] # how\nX_FK = [1]\n  X_FS =", "");
  same_around("calibration.X_FS = ", "\nrate = 2\n");
  same_around("calibration = { X_FK = [7], X_FS = ", ", X_FE = [] } # one line\n");
  same_around("name = \"\xC3\xA4\xE2\x82\xAC\"\ncalibration = { \"\xC3\xA4\" = 1, X_FS = ", " }\n");
  same_around("\xEF\xBB\xBF[calibration]\r\nX_FS = ", "\r\n[bin]\r\n");
  same_around(
      "\xEF\xBB\xBF"
      "calibration.X_FS = ",
      "\n");
  same_around("text = '''\n[calibration]\nX_FS = [9, 9, 9]\n'''\n[calibration]\nX_FS = ", "\n");
}

TEST_CASE("Comments and lines within a list of numbers stay", "[unit]") {
  CHECK(Edited("[calibration]\nX_FS = [\n  1.5e-3, # x, in metres ]\n  +2_0,\n  3, # z\n]\n") ==
        "[calibration]\nX_FS = [\n  0.001, # x, in metres ]\n  -0.25,\n  3, # z\n]\n");
}

TEST_CASE("A list of another length is replaced whole", "[unit]") {
  CHECK(Edited("[calibration]\nX_FS = []  # none yet\nX_FE = [1]\n") ==
        "[calibration]\nX_FS = [0.001, -0.25, 3]  # none yet\nX_FE = [1]\n");
  CHECK(Edited("[calibration]\nX_FS = [1, # ] one\n 2]\nX_FE = [1]\n") ==
        "[calibration]\nX_FS = [0.001, -0.25, 3]\nX_FE = [1]\n");
}

TEST_CASE("A list that is not there finds its place in its table", "[unit]") {
  CHECK(Edited("") == "[calibration]\nX_FS = [0.001, -0.25, 3]\n");
  CHECK(Edited("rate = 1\n") == "rate = 1\n\n[calibration]\nX_FS = [0.001, -0.25, 3]\n");
  CHECK(Edited("rate = 1") == "rate = 1\n\n[calibration]\nX_FS = [0.001, -0.25, 3]\n");
  CHECK(Edited("[ calibration ] # how\r\nX_FE = [1]\r\n[bin]\r\n") ==
        "[ calibration ] # how\r\nX_FS = [0.001, -0.25, 3]\r\nX_FE = [1]\r\n[bin]\r\n");
  CHECK(Edited("[calibration]") == "[calibration]\nX_FS = [0.001, -0.25, 3]\n");
  CHECK(Edited("t = '''\n[calibration]\n'''\n[calibration]\nX_FE = [1]\n") ==
        "t = '''\n[calibration]\n'''\n[calibration]\nX_FS = [0.001, -0.25, 3]\nX_FE = [1]\n");
  CHECK(Edited("rate = 1\ncalibration.X_FE = [1]\n[bin]\n") ==
        "calibration.X_FS = [0.001, -0.25, 3]\nrate = 1\ncalibration.X_FE = [1]\n[bin]\n");
  CHECK(Edited("calibration = {X_FE = [1]}\n") ==
        "calibration = { X_FS = [0.001, -0.25, 3],X_FE = [1]}\n");
  CHECK(Edited("calibration = {}\n") == "calibration = { X_FS = [0.001, -0.25, 3] }\n");
}

TEST_CASE("What holds no list of numbers is refused with its place", "[unit]") {
  CHECK_THROWS_WITH(Edited("calibration = 3\n"),
                    Contains("cell.toml:1:15: calibration: is") && Contains("a table is needed"));
  CHECK_THROWS_WITH(Edited("[calibration]\nX_FS = \"abc\"\n"),
                    Contains("cell.toml:2:8: calibration.X_FS") && Contains("a list of numbers"));
  CHECK_THROWS_WITH(Edited("[[calibration]]\nX_FE = [1]\n"), Contains("a table is needed"));
  CHECK_THROWS_WITH(Edited("[calibration\n"), Contains("cell.toml:1:") && Contains("TOML"));
}

}  // namespace
}  // namespace tubetwin

#include "models/base/text.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {

TEST_CASE("the nearest name has the fewest letters changed") {
  const std::vector<std::string> known = {"perpendicular", "plus45", "putback", "none"};
  CHECK(NearestName("plus54", known) == "plus45");
  CHECK(NearestName("put_back", known) == "putback");
  CHECK(NearestName("", known) == "none");
  CHECK(NearestName("x", {}).empty());
  CHECK(NearestName("ab", {"aa", "ac"}) == "aa");  // A tie goes to the first.
}

TEST_CASE("joining puts the separator between, not around") {
  CHECK(Join({}) == "");
  CHECK(Join({"a"}) == "a");
  CHECK(Join({"a", "b", "c"}, "; ") == "a; b; c");
}

TEST_CASE("a number is written shortest and reads back as the same bits") {
  CHECK(Number(0.25) == "0.25");
  CHECK(Number(1e-5) == "1e-05");
  CHECK(Number(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(Number(std::nan("")) == "nan");
  for (const double value : {0.1 + 0.2, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -0.0}) {
    const double back = std::strtod(Number(value).c_str(), nullptr);
    CHECK(back == value);
    CHECK(std::signbit(back) == std::signbit(value));
  }
}

TEST_CASE("a number is read as any compiler's program prints it") {
  const auto value = [](const char* word) {
    INFO(word);
    const auto read = ParseNumber(word);
    REQUIRE(read);
    return *read;
  };
  CHECK(value("0.425") == 0.425);
  CHECK(value("+0.425") == 0.425);
  CHECK(value("+.5e+1") == 5.0);
  CHECK(value("-4e-1") == -0.4);
  CHECK(value("1e400") == std::numeric_limits<double>::infinity());
  CHECK(value("-1e400") == -std::numeric_limits<double>::infinity());
  CHECK(value("1e-400") == 0.0);
  for (const char* none :
       {"nan", "NaN", "-nan", "+nan", "nan(ind)", "-nan(ind)", "nan(snan)", "1.#QNAN", "-1.#IND",
        "-1.#IND00", "1.#QNAN0", "1.#SNAN", "1.#R", "1.#J", "+1.#QNAN"}) {
    CHECK(std::isnan(value(none)));
  }
  for (const char* far : {"inf", "INF", "+inf", "Infinity", "1.#INF", "1.#INF00"}) {
    CHECK(value(far) == std::numeric_limits<double>::infinity());
  }
  CHECK(value("-1.#INF") == -std::numeric_limits<double>::infinity());
  for (const char* word : {"", "+", "-", "+-1", "++1", "- 1", "0x10", "1,5", "1.5f", "one", "1.#",
                           "1.#1", "2.#QNAN", "1.#QNAN1", "nano", "1 "}) {
    INFO(word);
    CHECK_FALSE(ParseNumber(word));
  }
}

TEST_CASE("what is no plain UTF-8 is shown byte by byte") {
  for (const char* plain : {"", "tube 1.stl", "\"q\" \\ #", "Schl\xc3\xa4uche", "\xe7\xae\xa1",
                            "\xf0\x9f\x94\xa7", "\xc2\xa0", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) {
    CHECK(IsPlainUtf8(plain));
    CHECK(Printable(plain) == plain);
  }
  CHECK(Printable("a\nb\tc\x7f") == "a\\x0Ab\\x09c\\x7F");
  CHECK(Printable("l\xe4tin") == "l\\xE4tin");
  CHECK(Printable("\xc3") == "\\xC3");
  CHECK(Printable("\xc2\x85") == "\\xC2\\x85");           // A control of Latin-1.
  CHECK(Printable("\xc0\xaf") == "\\xC0\\xAF");           // Overlong.
  CHECK(Printable("\xed\xa0\x80") == "\\xED\\xA0\\x80");  // Half of a surrogate pair.
  CHECK(Printable("\xf4\x90\x80\x80x") == "\\xF4\\x90\\x80\\x80x");
  CHECK_FALSE(IsPlainUtf8("a\nb"));
}

TEST_CASE("a failed check of the program throws where a false one stands, and only there") {
  CHECK_NOTHROW([] { TT_CHECK(1 + 1 == 2); }());
  CHECK_THROWS_WITH([] { TT_CHECK(1 + 1 == 3); }(),
                    Catch::Contains("text_test.cc") && Catch::Contains("1 + 1 == 3"));
}

}  // namespace tubetwin

// Piles as spreadsheets and scripts write them: read where there is one way to read them.

#include <functional>

#include "models/base/error.h"
#include "scenes/pile_text.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Contains;

const std::string kPlain =
    "tube,index,x,y,z\n7,0,-0.1,0.2,0.0125\n7,1,0.1,0.2,0.0125\n3,0,0.25,-0.1,0.02\n"
    "3,1,0.15,-0.1,0.03\n3,2,0.05,0,0.02\n";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// The tubes of kPlain, sorted by id where the rows were not.
void CheckPlain(const std::string& text, bool sorted = false,
                std::optional<double> unit_m = std::nullopt) {
  INFO(text);
  const std::vector<TextTube> tubes = ParsePileCsv(text, "p.csv", unit_m);
  REQUIRE(tubes.size() == 2);
  const TextTube& seven = tubes[sorted ? 1 : 0];
  const TextTube& three = tubes[sorted ? 0 : 1];
  CHECK(seven.id == 7);
  CHECK(three.id == 3);
  REQUIRE(seven.centerline_N.size() == 2);
  REQUIRE(three.centerline_N.size() == 3);
  CHECK(seven.centerline_N[0].isApprox(Vector3(-0.1, 0.2, 0.0125)));
  CHECK(seven.centerline_N[1].isApprox(Vector3(0.1, 0.2, 0.0125)));
  CHECK(three.centerline_N[0].isApprox(Vector3(0.25, -0.1, 0.02)));
  CHECK(three.centerline_N[1].isApprox(Vector3(0.15, -0.1, 0.03)));
  CHECK(three.centerline_N[2].isApprox(Vector3(0.05, 0, 0.02)));
}

void CheckBad(const std::string& text, const std::string& said) {
  INFO(text);
  try {
    ParsePileCsv(text, "p.csv");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kBadData);
    CHECK_THAT(error.what(), Catch::StartsWith("p.csv: line ") && Contains(said));
    return;
  }
  FAIL("not refused");
}

TEST_CASE("CSV is read with any separator, line end, quotes and comments", "[unit]") {
  CheckPlain(kPlain);
  CheckPlain("\xef\xbb\xbf" + kPlain);
  for (const char* separator : {";", "\t", " ", ", ", " ; ", "  "}) {
    CheckPlain(Replaced(kPlain, ",", separator));
  }
  CheckPlain(Replaced(kPlain, "\n", "\r\n"));
  CheckPlain(Replaced(kPlain, "\n", "\r"));
  CheckPlain(kPlain.substr(0, kPlain.size() - 1));
  CheckPlain("# by hand\n\nsep=;\n" + Replaced(kPlain, ",", ";") + ";;;;\n\n# end\n");
  // As spreadsheets fill up rows.
  CheckPlain("tube,index,x,y,z\n" + Replaced(kPlain.substr(17), "\n", ",,\n"));
  CheckPlain("\"tube\",\"index\",\"x\",\"y\",\"z\"\n" + kPlain.substr(17));
  CheckPlain(Replaced(Replaced(kPlain, "0.", "+0."), "-+", "-"));
  CheckPlain("TUBE,Index,X,Y,Z\n" + kPlain.substr(17));
}

TEST_CASE("Decimal commas are read where commas set no columns apart", "[unit]") {
  CheckPlain(Replaced(Replaced(kPlain, ",", ";"), "0.", "0,"));
  CheckPlain(Replaced(Replaced(kPlain, ",", "\t"), "0.", "0,"));
  CheckPlain(
      "tube,index,x,y,z\n7,0,\"-0,1\",\"0,2\",\"0,0125\"\n7,1,\"0,1\",\"0,2\",\"0,0125\"\n"
      "3,0,\"0,25\",\"-0,1\",\"0,02\"\n3,1,\"0,15\",\"-0,1\",\"0,03\"\n3,2,\"0,05\",0,\"0,02\"\n");
  CheckBad(Replaced(kPlain, "0.", "0,"), "line 2: has 8 fields; the header has 5. Decimal commas?");
  CheckBad("tube;index;x;y;z\n1;0;1.234,5;0;0\n", "x is '1.234,5'; allowed: a finite number");
  CheckBad("tube;index;x;y;z\n1;0;1,234,5;0;0\n", "x is '1,234,5'; allowed: a finite number");
}

TEST_CASE("Columns are told by the header: in any order, beside others", "[unit]") {
  CheckPlain(
      ",tube,index,x,y,z\n0,7,0,-0.1,0.2,0.0125\n1,7,1,0.1,0.2,0.0125\n"
      "2,3,0,0.25,-0.1,0.02\n3,3,1,0.15,-0.1,0.03\n4,3,2,0.05,0,0.02\n");
  CheckPlain(
      "z,note,x,y,index,tube\n0.0125,a b,-0.1,0.2,0,7\n0.0125,\"c, d\",0.1,0.2,1,7\n"
      "0.02,,0.25,-0.1,0,3\n0.03,nan,0.15,-0.1,1,3\n0.02,,0.05,0,2,3\n");
  CheckPlain(
      "tube,index,x,y,z\n7.0,0.0,-0.1,0.2,0.0125\n7.0,1.0,0.1,0.2,0.0125\n"
      "3.0,0.0,0.25,-0.1,0.02\n3.0,1.0,0.15,-0.1,0.03\n3.0,2.0,0.05,0,0.02\n");
  CheckBad("tube,index,x,y\n", "header is 'tube,index,x,y' and lacks 'z'");
  CheckBad("1,0,0.1,0.1,0.1\n", "and lacks 'tube'; allowed: columns tube,index,x,y,z in any order");
  CheckBad("tube,index,x,x,y,z\n", "header names 'x' twice");
  CheckBad("tube,index,x,y,z\n1,0,0.1,0.1\n", "has 4 fields; the header has 5");
  CheckBad("tube,index,x,y,z\nA,0,0.1,0.1,0.1\n", "tube is 'A'; allowed: a whole number");
  CheckBad("tube,index,x,y,z\n1,0.5,0.1,0.1,0.1\n", "index is '0.5'; allowed: a whole number");
  CheckBad("tube,index,x,y,z\n1,0,0.1,,0.1\n", "y is ''; allowed: a finite number");
  CheckBad("tube,index,x,y,z\n1,0,0.1,\x1b[2J,0.1\n", "y is '\\x1B[2J'");
}

TEST_CASE("Indices count from 0 or 1, and rows may come in any order", "[unit]") {
  const std::string from_1 =
      "tube,index,x,y,z\n7,1,-0.1,0.2,0.0125\n7,2,0.1,0.2,0.0125\n3,1,0.25,-0.1,0.02\n"
      "3,2,0.15,-0.1,0.03\n3,3,0.05,0,0.02\n";
  CheckPlain(from_1);
  CheckPlain(
      "tube,index,x,y,z\n3,2,0.05,0,0.02\n7,1,0.1,0.2,0.0125\n3,0,0.25,-0.1,0.02\n"
      "7,0,-0.1,0.2,0.0125\n3,1,0.15,-0.1,0.03\n",
      true);
  CheckBad(Replaced(from_1, "7,1,", "7,0,"), "line 3: index of tube 7 is 2, and it has no 1");
  CheckBad(Replaced(kPlain, "3,0,", "3,1,"),
           "index of tube 3 is 1, and it has no 0; allowed: each "
           "from 0 on once");
  CheckBad(Replaced(kPlain, "3,2,", "3,1,"), "line 6: index of tube 3 is 1, which it had before");
}

TEST_CASE("A unit is what the user says, or the header", "[unit]") {
  const std::string mm =
      "tube,index,x,y,z\n7,0,-100,200,12.5\n7,1,100,200,12.5\n3,0,250,-100,20\n"
      "3,1,150,-100,30\n3,2,50,0,20\n";
  CheckPlain(mm, false, 0.001);
  for (const char* header : {"tube,index,x_mm,y_mm,z_mm", "tube,index,x [mm],y [mm],z [mm]",
                             "tube,index,X(mm),Y(mm),Z(mm)"}) {
    CheckPlain(Replaced(mm, "tube,index,x,y,z", header));
  }
  CheckPlain(Replaced(kPlain, "x,y,z", "x_m,y_m,z_m"));
  CheckBad(Replaced(mm, "x,y,z", "x_mm,y_mm,z"), "x, y and z different units");
}

TEST_CASE("A radius in the file is the tube's, one for all its points", "[unit]") {
  const std::string head = "tube,index,x,y,z,radius_mm\n";
  const auto tubes = ParsePileCsv(head + "1,0,0,0,0.1,11\n1,1,0.1,0,0.1,11\n", "p.csv");
  CHECK(tubes[0].radius_m == Approx(0.011));
  CHECK(ParsePileCsv(kPlain, "p.csv")[0].radius_m == 0.0);
  CheckBad(head + "1,0,0,0,0.1,11\n1,1,0.1,0,0.1,12\n",
           "radius of tube 1 is 12, at its first point 11");
  CheckBad(head + "1,0,0,0,0.1,0\n", "radius is 0; allowed: above 0");
}

}  // namespace
}  // namespace tubetwin

// PCD as other programs write it: what nobody needs stops nothing, what would be wrong is refused.

#include <cstring>

#include "models/base/cloud/cloud.h"
#include "models/base/cloud/lzf.h"
#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/cloud_text.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

constexpr char kPcd[] = "a.pcd";

template <class T>
std::string Bytes(std::initializer_list<T> values) {
  std::string out;
  for (const T value : values) out.append(reinterpret_cast<const char*>(&value), sizeof value);
  return out;
}

/// LZF of literal runs alone.
std::string Literals(const std::string& content) {
  std::string out;
  for (std::size_t at = 0; at < content.size(); at += 32) {
    const std::string run = content.substr(at, 32);
    out += static_cast<char>(run.size() - 1);
    out += run;
  }
  return out;
}

std::string Compressed(const std::string& content) {
  const std::string packed = Literals(content);
  return Bytes<std::uint32_t>({static_cast<std::uint32_t>(packed.size()),
                               static_cast<std::uint32_t>(content.size())}) +
         packed;
}

const char kFloats[] = "SIZE 4 4 4\nTYPE F F F\n";
const char kPoints[] = "WIDTH 2\nHEIGHT 1\nPOINTS 2\n";
const char kHead[] =
    "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
const std::string kData = Bytes({0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f});
const std::string kHeadText = kHead;

std::string ChangedPcd(const std::string& from, const std::string& to,
                       const std::string& rest = "ascii\n0.1 0.2 0.3\n0.4 0.5 0.6\n") {
  return Replaced(kHeadText + rest, from, to);
}

TEST_CASE("LZF unpacks literals, runs, and runs into themselves", "[unit]") {
  using namespace std::string_literals;
  // "abc", then 3 + 2 bytes from 3 back, then 7 + 10 + 2 bytes from 1 back.
  const std::string packed =
      "\x02"
      "abc\x60\x02\xe0\x0a\x00"s;
  CHECK(LzfUnpacked(packed, 27, "s") == "abcabcab" + std::string(19, 'b'));
  const auto bad = [](const std::string& bytes, std::size_t size, const std::string& said) {
    CHECK_THROWS_WITH(LzfUnpacked(bytes, size, "s"), Contains(said) && Contains("s: "));
  };
  bad(packed, 26, "goes on");
  bad(packed, 28, "ends early");
  bad(packed.substr(0, 8), 27, "ends inside a run");
  bad(packed.substr(0, 3), 3, "ends inside a run");
  bad("\x00"
      "a\x20\x01"s,
      5, "points before its beginning");
  bad("\x1f"
      "a"s,
      32, "ends inside a run");
  bad("\x01"
      "ab"s,
      1, "goes on");
  bad("", 1, "is too short");
  bad(packed, 1'000'000'000'000, "is too short");
  // A distance of 13 bits.
  std::string far = Literals(std::string(1, 'x') + std::string(8191, 'y'));
  far += "\x3f\xff"s;
  CHECK(LzfUnpacked(far, 8195, "s").substr(8192) == "xyy");
}

TEST_CASE("Compressed PCD holds one field after the other, with padding or without", "[unit]") {
  const std::string planes = Bytes({0.1f, 0.4f, 0.2f, 0.5f, 0.3f, 0.6f});
  CheckTwoPoints(kPcd, kHeadText + "binary_compressed\n" + Compressed(planes));
  CheckTwoPoints(kPcd, kHeadText + "Binary_Compressed\r\n" + Compressed(planes) + "behind");
  const std::string padded =
      "FIELDS rgb x _ y z label intensity\nSIZE 4 4 1 4 8 1 4\nTYPE U F U F F U F\n"
      "COUNT 1 1 3 1 1 1 1\n" +
      std::string(kPoints) + "DATA binary_compressed\n";
  for (const bool with_padding : {false, true}) {
    const std::string fields = std::string(8, '\x11') + Bytes({0.1f, 0.4f}) +
                               (with_padding ? std::string(6, '\x22') : "") + Bytes({0.2f, 0.5f}) +
                               Bytes({0.3, 0.6}) + "\x07\x08" + Bytes({0.25f, 0.75f});
    CheckTwoPoints(kPcd, padded + Compressed(fields));
    const OrganizedCloud cloud = CloudIn(kPcd, padded + Compressed(fields));
    CHECK(cloud.label == std::vector<std::uint32_t>{7, 8});
    CHECK(cloud.intensity == std::vector<float>{0.25f, 0.75f});
  }
  const std::string head = kHeadText + "binary_compressed\n";
  CheckBadCloud(kPcd, head + Compressed(planes).substr(0, 20),
                "the file only 12 more: it is cut off");
  CheckBadCloud(kPcd, head + "1234567", "1 bytes missing");
  CheckBadCloud(kPcd, head + Compressed(planes.substr(4)),
                "unpacks to 20 bytes, POINTS 2 of 12 bytes each");
  std::string damaged = head + Compressed(planes);
  damaged[head.size() + 8] = '\x20';
  CheckBadCloud(kPcd, damaged, "the file is damaged");
  CheckBadCloud(kPcd,
                ChangedPcd("WIDTH 2", "WIDTH 200000", "binary_compressed\n" + Compressed(planes))
                    .replace(0, 0, "# 10^5 points in 33 bytes\n"),
                "POINTS is 2");
  std::string large = head + Compressed(planes);
  large.replace(large.find("WIDTH 2"), 7, "WIDTH 900")
      .replace(large.find("POINTS 2"), 8, "POINTS 900");
  CheckBadCloud(kPcd, large, "need more than the 33 bytes of compressed data");
}

TEST_CASE("Older versions of PCD and other spellings read as 0.7", "[unit]") {
  const std::string ascii = "DATA ascii\n0.1 0.2 0.3\n0.4 0.5 0.6\n";
  for (const char* version : {"0.5", ".5", "0.6", ".6", "0.7", ".7"}) {
    CheckTwoPoints(kPcd, "# .PCD\nVERSION " + std::string(version) + "\nCOLUMNS x y z\n" + kFloats +
                             kPoints + "DATA binary\n" + kData);
  }
  CheckTwoPoints(kPcd,
                 "VERSION .5\nCOLUMNS x y z\n" + std::string(kPoints) + "DATA binary\n" + kData);
  CheckTwoPoints(kPcd, "FIELDS x y z\n" + std::string(kPoints) + ascii);
  CheckTwoPoints(kPcd, "\xef\xbb\xbf# .PCD\nFIELDS x y z\nPOINTS 2\n" + ascii);
  CheckTwoPoints(kPcd,
                 "fields x y z\nsize 4 4 4\ntype f f f\nwidth 2\npoints 2\ndata Binary\n" + kData);
  CheckTwoPoints(kPcd, "# one\n#two\nFIELDS x y z # three\n\n \t\nWIDTH\t2\nHEIGHT 0\n#\n" + ascii);
  // Lines as Windows and the first Macs end them.
  for (const char* end : {"\r\n", "\r"}) {
    std::string text = "FIELDS x y z\nWIDTH 2\nHEIGHT 1\n" + ascii;
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) {
      text.replace(at, 1, end);
      at += std::strlen(end);
    }
    CheckTwoPoints(kPcd, text);
  }
  CheckTwoPoints(kPcd,
                 "FIELDS x y z\r\n" + std::string(kFloats) + kPoints + "DATA binary\r\n" + kData);
  CheckBadCloud(kPcd, "FIELDS x y z\nPOINTS 2\nDATA binary\n" + kData,
                "the header ends without a line SIZE");
  CheckBadCloud(kPcd, "FIELDS x y z\n" + ascii, "the header ends without a line WIDTH or POINTS");
  CheckBadCloud(kPcd,
                "FIELDS x y z \xb3w\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3\n",
                "point 0, field '\\xB3w' is missing");
}

TEST_CASE("One of WIDTH, HEIGHT and POINTS may be missing", "[unit]") {
  std::string rows;
  for (int i = 0; i < 6; ++i) rows += "0." + std::to_string(i) + " 0 0.5\n";
  const auto shape = [&](const std::string& lines) {
    const OrganizedCloud cloud = CloudIn(kPcd, "FIELDS x y z\n" + lines + "DATA ascii\n" + rows);
    REQUIRE(cloud.size() == 6);
    return std::pair(cloud.width, cloud.height);
  };
  CHECK(shape("WIDTH 3\nHEIGHT 2\n") == std::pair(3, 2));
  CHECK(shape("WIDTH 3\nPOINTS 6\n") == std::pair(3, 2));
  CHECK(shape("HEIGHT 2\nPOINTS 6\n") == std::pair(3, 2));
  CHECK(shape("POINTS 6\n") == std::pair(6, 1));
  CHECK(shape("WIDTH 6\nHEIGHT 0\n") == std::pair(6, 1));
  CheckBadCloud(kPcd, "FIELDS x y z\nWIDTH 4\nPOINTS 6\nDATA ascii\n" + rows, "POINTS is 6");
  CheckBadCloud(kPcd, "FIELDS x y z\nHEIGHT 4\nPOINTS 6\nDATA ascii\n" + rows, "POINTS is 6");
  CheckBadCloud(kPcd, "FIELDS x y z\nHEIGHT 9\nPOINTS 6\nDATA ascii\n" + rows, "POINTS is 6");
}

TEST_CASE("A column that nobody needs stops nothing", "[unit]") {
  // Padding of no place, an intensity of 16 bits, floating labels, a type of another world.
  const std::string head =
      "FIELDS intensity _ x ring y label _ z t\nSIZE 2 1 4 3 8 4 1 4 8\n"
      "TYPE U U F Q F F U F LONG\nCOUNT 1 0 1 2 1 1 2 1 1\n" +
      std::string(kPoints);
  std::string binary = head + "DATA binary\n";
  for (const float x : {0.1f, 0.4f}) {
    binary += "ab" + Bytes({x}) + "ringrr" + Bytes({x == 0.1f ? 0.2 : 0.5}) + Bytes({-3.5f}) +
              "__" + Bytes({x == 0.1f ? 0.3f : 0.6f}) + "12345678";
  }
  CheckTwoPoints(kPcd, binary);
  CHECK(CloudIn(kPcd, binary).label.empty());
  CHECK(CloudIn(kPcd, binary).intensity.empty());
  CheckTwoPoints(
      kPcd, head + "DATA ascii\n7 0.1 a b 0.2 1.5 0 0 0.3 12:30\n8 0.4 - - 0.5 x 0 0 0.6 \xff\n");
  CheckTwoPoints(kPcd, "FIELDS X Y Z GpsTime\n" + std::string(kPoints) +
                           "DATA ascii\n0.1 0.2 0.3 7\n0.4 0.5 0.6 8\n");
  CheckTwoPoints(kPcd, "FIELDS rgb x y z rgb\n" + std::string(kPoints) +
                           "DATA ascii\n1 0.1 0.2 0.3 2\n1 0.4 0.5 0.6 2\n");
  // PCL goes back by padding where fields are not named in the order of their places.
  const std::string back =
      "FIELDS y _ z _ x _\nSIZE 4 1 4 1 4 1\nTYPE F U F U F U\nCOUNT 1 8 1 -8 1 4\n" +
      std::string(kPoints) + "DATA binary\n";
  CheckTwoPoints(kPcd, back + Bytes({0.2f, 7.0f, 0.1f, 0.3f, 0.5f, 7.0f, 0.4f, 0.6f}));
  CheckBadCloud(kPcd, Replaced(back, "-8", "-20"), "goes back before the point's beginning");
  CheckBadCloud(kPcd, Replaced(back, "COUNT 1 8 1 -8 1 4", "COUNT 1 8 1 -8 1 0"),
                "ends behind its point");
  CheckBadCloud(kPcd, Replaced(back, "COUNT 1", "COUNT -1"), "COUNT of field 'y' is '-1'");
  // A bad word in a column that could be ours drops that column whole.
  const OrganizedCloud cloud =
      CloudIn(kPcd, "FIELDS x y z label intensity\nSIZE 4 4 4 4 4\nTYPE F F F U F\n" +
                        std::string(kPoints) + "DATA ascii\n.1 .2 .3 7 0.5\n.4 .5 .6 -1 bright\n");
  CHECK(cloud.label.empty());
  CHECK(cloud.intensity.empty());
  CheckBadCloud(kPcd, "FIELDS x y z x\n" + std::string(kPoints) + "DATA ascii\n1 1 1 1\n1 1 1 1\n",
                "FIELDS names 'x' twice");
  CheckBadCloud(kPcd,
                "FIELDS x y z\nCOUNT 1 1 0\n" + std::string(kPoints) + "DATA ascii\n1 1\n1 1\n",
                "field 'z' has TYPE F, SIZE 4, COUNT 0");
}

TEST_CASE("Coordinates may be whole numbers of any size, in a unit that is said", "[unit]") {
  std::string text = "# units: mm\nFIELDS y z x\nSIZE 2 4 8\nTYPE I U I\n" + std::string(kPoints) +
                     "DATA binary\n";
  text += Bytes<std::int16_t>({200}) + Bytes<std::uint32_t>({300}) + Bytes<std::int64_t>({100});
  text += Bytes<std::int16_t>({500}) + Bytes<std::uint32_t>({600}) + Bytes<std::int64_t>({400});
  CheckTwoPoints(kPcd, text);
  CheckTwoPoints(kPcd, text.substr(text.find('\n') + 1), 0.001);
  const OrganizedCloud other = CloudIn(kPcd, text, 0.002);  // What the user says wins.
  CHECK(other.p_SP[0].x() == Approx(0.2f));
  CheckBadCloud(kPcd, text.substr(text.find('\n') + 1), "--units mm, cm or in");
}

TEST_CASE("--units holds for the pose too, and a wrong one is refused", "[unit]") {
  const std::string text = ChangedPcd("VIEWPOINT 0 0 0 1", "VIEWPOINT 100 -200 500 1",
                                      "ascii\n100 200 300\n400 500 600\n");
  CheckTwoPoints(kPcd, text, 0.001);
  CHECK(CloudIn(kPcd, text, 0.001).X_NS.translation().isApprox(Vector3(0.1, -0.2, 0.5)));
  CheckBadCloud(kPcd, text, "--units mm, cm or in says another unit");
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "a.pcd", kHeadText + "binary\n" + kData);
  CHECK_THROWS_WITH(ReadPcd(folder / "a.pcd", 0.001), Contains("allowed are 0.001 to 20 m"));
}

TEST_CASE("Numbers are read as C and Microsoft print them", "[unit]") {
  CheckTwoPoints(kPcd, ChangedPcd("0.1 0.2 0.3", "+0.1 +2e-1 +.3"));
  for (const char* none : {"nan", "-nan", "NaN", "1.#QNAN", "-1.#IND", "-nan(ind)", "inf", "-inf",
                           "1.#INF00", "1e39", "-1e400"}) {
    INFO(none);
    const OrganizedCloud cloud = CloudIn(kPcd, ChangedPcd("0.5 0.6", "0.5 " + std::string(none)));
    CHECK(IsValid(cloud.p_SP[0]));
    CHECK_FALSE(IsValid(cloud.p_SP[1]));
    CHECK(std::isnan(cloud.p_SP[1].x()));
  }
  for (const char* zero : {"0 0 0", "-0 0.0 -0.0"}) {  // In unorganised clouds, too.
    CHECK_FALSE(IsValid(CloudIn(kPcd, ChangedPcd("0.4 0.5 0.6", zero)).p_SP[1]));
  }
  CheckBadCloud(kPcd, ChangedPcd("0.1 0.2", "0,1 0,2"),
                "field 'x' is '0,1', no number: numbers are written with");
  CheckBadCloud(kPcd, ChangedPcd("0.1 0.2", "0.1 \x1b[31m"), "is '\\x1B[31m', no number");
}

TEST_CASE("Bytes behind the data are nobody's, unless the header lacks a field", "[unit]") {
  CheckTwoPoints(kPcd, kHeadText + "binary\n" + kData + "x");
  CheckTwoPoints(kPcd, kHeadText + "binary\n" + kData + std::string(4097, '\0'));
  CheckTwoPoints(kPcd, ChangedPcd("0.6\n", "0.6\n\n# end\n\x1a"));
  // Each point has four bytes more than the fields say: every later one would be wrong.
  CheckBadCloud(kPcd, kHeadText + "binary\n" + kData + "12345678", "(16 bytes for each point)");
  CheckBadCloud(kPcd, ChangedPcd("0.3\n0.4", "0.3 7\n0.4"),
                "a.pcd:11: point 0: the line goes on with '7'");
  CheckBadCloud(kPcd, ChangedPcd("0.6\n", "0.6\n0.7 0.8 0.9\n"),
                "data goes on after the last of POINTS 2");
  CheckTwoPoints(kPcd, ChangedPcd("0.1 0.2 0.3", "0.1\n0.2 # half\n 0.3"));
}

TEST_CASE("A file that was taken for a cloud is called what it is", "[unit]") {
  using namespace std::string_literals;
  CheckBadCloud(kPcd, "", "is empty");
  CheckBadCloud(kPcd, "\x1f\x8b\x08\x00"s, "is packed by gzip; unpack it first");
  CheckBadCloud(kPcd, "PK\x03\x04\x14\x00"s, "zip archive");
  CheckBadCloud(kPcd, "\xff\xfe#\0 \0"s, "UTF-16");
  CheckBadCloud(kPcd, "ply\nformat ascii 1.0\n", "is a PLY file");
  CheckBadCloud(kPcd, "solid tube\n", "is an STL mesh");
  CheckBadCloud(kPcd, "<!DOCTYPE html>\n<html>\n", "is a web page");
  CheckBadCloud(kPcd, "version https://git-lfs.github.com/spec/v1\noid sha256:00\n",
                "git lfs pull");
}

}  // namespace
}  // namespace tubetwin

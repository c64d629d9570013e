// PLY as other programs write it: what nobody needs stops nothing, what would be wrong is refused.

#include <algorithm>
#include <cstring>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/cloud_text.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

constexpr char kPly[] = "a.ply";

/// Numbers as a file of either byte order holds them.
class Writer {
 public:
  explicit Writer(bool big) : big_(big) {}
  template <class T>
  Writer& Put(std::initializer_list<T> values) {
    for (const T value : values) {
      char bytes[sizeof(T)];
      std::memcpy(bytes, &value, sizeof value);
      if (big_) std::reverse(bytes, bytes + sizeof value);
      text.append(bytes, sizeof value);
    }
    return *this;
  }
  std::string text;

 private:
  bool big_;
};

const std::string kVertex =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kRows = "0.1 0.2 0.3\n0.4 0.5 0.6\n";
const std::string kText = "ply\nformat ascii 1.0\n" + kVertex + "end_header\n" + kRows;

std::string ChangedPly(const std::string& from, const std::string& to) {
  return Replaced(kText, from, to);
}

TEST_CASE("PLY is read in either byte order, with columns of every size and lists", "[unit]") {
  const std::string body =
      "element tag 2\nproperty list uchar ushort word\nproperty int64 stamp\n"
      "element vertex 2\nproperty bool seen\nproperty double x\nproperty list int double more\n"
      "property uint64 time\nproperty float16 h\nproperty float32 y\nproperty list uint8 int8 "
      "name\n"
      "property float64 z\nproperty short label\nproperty float intensity\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const bool big : {false, true}) {
    Writer w(big);
    w.Put<std::uint8_t>({2}).Put<std::uint16_t>({7, 8}).Put<std::int64_t>({-1});
    w.Put<std::uint8_t>({0}).Put<std::int64_t>({-1});
    w.Put<std::uint8_t>({1}).Put({0.1}).Put<std::int32_t>({2}).Put({9.0, 9.0});
    w.Put<std::uint64_t>({5}).Put<std::uint16_t>({0x3c00}).Put({0.2f});
    w.Put<std::uint8_t>({3, 'a', 'b', 'c'}).Put({0.3}).Put<std::int16_t>({258}).Put({0.25f});
    w.Put<std::uint8_t>({0}).Put({0.4}).Put<std::int32_t>({0});
    w.Put<std::uint64_t>({5}).Put<std::uint16_t>({0x3c00}).Put({0.5f});
    w.Put<std::uint8_t>({0}).Put({0.6}).Put<std::int16_t>({-4}).Put({0.75f});
    const std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                             "_endian 1.0\n" + body +
                             w.text;  // The face is cut off: nobody needs it.
    CheckTwoPoints(kPly, file);
    const OrganizedCloud cloud = CloudIn(kPly, file);
    CHECK(cloud.label == std::vector<std::uint32_t>{258, 0});
    CHECK(cloud.intensity == std::vector<float>{0.25f, 0.75f});
    CheckBadCloud(kPly, file.substr(0, file.size() - 3), "the data ends, 3 bytes missing");
  }
  CheckTwoPoints(kPly,
                 "ply\nformat ascii 1.0\nelement vertex 2\nproperty quaternion q\nproperty int x\n"
                 "property list int string more\nproperty float y\nproperty float z\nend_header\n"
                 "- 100 2 a b 200 300\n- 400 0 500 600\n",
                 0.001);
}

TEST_CASE("Faces before the points, or of no length, are passed over", "[unit]") {
  const std::string face = "element face 2\nproperty list uchar int vertex_indices\n";
  CheckTwoPoints(kPly,
                 "ply\nformat ascii 1.0\n" + face + kVertex + "end_header\n3 0 1 1\n0\n" + kRows);
  CheckTwoPoints(kPly, "ply\nformat ascii 1.0\nelement nothing 1000000000000\n" + kVertex +
                           "end_header\n" + kRows);
  CheckBadCloud(kPly,
                "ply\nformat ascii 1.0\n" + face + kVertex + "end_header\n-3 0 1 1\n0\n" + kRows,
                "element 'face', row 0, property 'vertex_indices': is a list of '-3' numbers");
  CheckBadCloud(kPly,
                "ply\nformat ascii 1.0\n" + face + kVertex + "end_header\n1e9 0 1 1\n0\n" + kRows,
                "is a list of '1e9' numbers");
  const std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list int int v\n" + kVertex +
      "end_header\n";
  for (const std::int32_t count : {-1, 1'900'000'001}) {
    CheckBadCloud(kPly, binary + Writer(false).Put<std::int32_t>({count, 1, 2}).text,
                  "a list of " + std::to_string(count) + " numbers, the file has 8 bytes more");
  }
}

TEST_CASE("Comments may stand anywhere and say anything", "[unit]") {
  CheckTwoPoints(kPly,
                 "ply\ncomment first\nformat ascii 1.0\ncomment\nobj_info num_cols 512\n# hash\n"
                 "element vertex 2\ncomment \xe4\x07\x1b[31m units\nproperty float x\n"
                 "obj_info\nproperty float y\nCOMMENT units are in the manual\nproperty float z\n"
                 "comment frame of mind\nend_header\n# row\n0.1 0.2 0.3 # half\ncomment x\n"
                 "0.4 0.5 0.6\n");
  CheckTwoPoints(kPly,
                 "PLY \r\nFORMAT ASCII 1.0\r\nElement vertex 2\r\nproperty FLOAT X\r\n"
                 "property float Y\r\nproperty float Z\r\nEnd_Header\r\n" +
                     kRows);
  CheckTwoPoints(kPly, ChangedPly("element", "Created by a program, source file:\nelement"));
  CheckBadCloud(kPly, ChangedPly("property float z", "proprety float z"),
                "lacks property 'z', it has: x y");
  std::string mac = kText;
  std::replace(mac.begin(), mac.end(), '\n', '\r');
  CheckTwoPoints(kPly, mac);
  CheckTwoPoints(kPly, "\xef\xbb\xbf" + kText);
}

TEST_CASE("A unit in the header is read however it is spelt, and --units wins", "[unit]") {
  const std::string rows = "100 200 300\n400 500 600\n";
  for (const char* note : {"comment units mm", "comment Units: millimetres", "obj_info unit = MM",
                           "comment units:mm", "comment unit millimeter"}) {
    CheckTwoPoints(kPly, "ply\nformat ascii 1.0\n" + std::string(note) + "\n" + kVertex +
                             "end_header\n" + rows);
  }
  CheckTwoPoints(kPly, "ply\nformat ascii 1.0\ncomment units cm\n" + kVertex +
                           "end_header\n10 20 30\n40 50 60\n");
  CheckTwoPoints(kPly, "ply\nformat ascii 1.0\ncomment units m\n" + kVertex + "end_header\n" + rows,
                 0.001);
  CheckTwoPoints(kPly,
                 "ply\nformat ascii 1.0\ncomment units furlong\n" + kVertex + "end_header\n" + rows,
                 0.001);
}

TEST_CASE("Text rows may wrap or run on, but never hold more than the header says", "[unit]") {
  CheckTwoPoints(kPly, ChangedPly(kRows, "0.1\n0.2 0.3\n\n0.4\t0.5\n0.6"));
  CheckTwoPoints(kPly, ChangedPly(kRows, "0.1 0.2 0.3 0.4 0.5 0.6\n"));
  CheckTwoPoints(kPly, ChangedPly(kRows, "+0.1 2e-1 .3 0.4 0.5 6.0E-1"));
  CheckBadCloud(
      kPly, ChangedPly(kRows, "0.1 0.2 0.3 255\n0.4 0.5 0.6 255\n"),
      "element 'vertex', row 0: the line goes on with '255', the header says 3 properties");
  CheckBadCloud(kPly, ChangedPly("0.4", "0,4"),
                "property 'x': is '0,4', no number: numbers are written with");
  CheckBadCloud(kPly, ChangedPly("0.5 0.6\n", "0.5"), "property 'z': is missing: the data ends");
  for (const char* none : {"nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "inf", "1e99"}) {
    INFO(none);
    const OrganizedCloud cloud = CloudIn(kPly, ChangedPly("0.6", none));
    CHECK(IsValid(cloud.p_SP[0]));
    CHECK_FALSE(IsValid(cloud.p_SP[1]));
  }
  CHECK_FALSE(IsValid(CloudIn(kPly, ChangedPly("0.4 0.5 0.6", "-0 0 -0.0")).p_SP[1]));
}

TEST_CASE("A scan without the points that were not measured is read as it is", "[unit]") {
  const auto framed = [](int width, int height) {
    return "ply\nformat ascii 1.0\ncomment units m\n" + kVertex +
           "element camera 1\nproperty float focal\nelement phoxi_frame_params 1\n"
           "property uint frame_width\nproperty uint frame_height\nend_header\n" +
           kRows + "35\n" + std::to_string(width) + " " + std::to_string(height) + "\n";
  };
  for (const auto& [width, height] : {std::pair(1032, 772), std::pair(1, 1), std::pair(0, 0)}) {
    CheckTwoPoints(kPly, framed(width, height));
    CHECK_FALSE(CloudIn(kPly, framed(width, height)).organized());
  }
  CHECK(CloudIn(kPly, framed(1, 2)).organized());
}

TEST_CASE("A bad PLY header says what is missing and what it has", "[unit]") {
  CheckBadCloud(kPly, ChangedPly("float x", "float u"),
                "element 'vertex' lacks property 'x', it has: u y z");
  CheckBadCloud(kPly, ChangedPly("element vertex", "element point"),
                "no element 'vertex' with at least one row, the header has: point 2");
  CheckBadCloud(kPly, ChangedPly("element vertex 2", "element vertex 0"),
                "the header has: vertex 0");
  CheckBadCloud(kPly, ChangedPly("element vertex 2", "element vertex two"),
                "count of element 'vertex' is 'two'");
  CheckBadCloud(kPly, ChangedPly("element vertex 2", "element vertex 90"),
                "count of element 'vertex' is 90, the 24 bytes of data that follow hold at most 4");
  CheckBadCloud(kPly, ChangedPly("end_header", "element vertex 1\nend_header"),
                "'vertex' is given twice");
  CheckBadCloud(kPly, ChangedPly("float x", "list int float x"),
                "property 'x' is a list or a half float");
  CheckBadCloud(kPly, ChangedPly("ascii", "utf8"),
                "format is 'utf8', allowed are ascii, binary_little_endian, binary_big_endian");
  CheckBadCloud(kPly, ChangedPly("format ascii 1.0\n", ""), "element stands before format");
  CheckBadCloud(kPly, "ply\nend_header\n", "without a line format");
  std::string binary = ChangedPly("ascii", "binary_little_endian");
  CheckBadCloud(kPly, Replaced(binary, "end_header", "end"), "'end' is no PLY header entry");
  binary.replace(binary.find("float x"), 7, "triple x");
  CheckBadCloud(kPly, binary, "property 'x' has type 'triple', allowed are char");
  CheckBadCloud(kPly, "# .PCD v0.7\n", "no PLY file: it is a PCD cloud");
  CheckBadCloud(kPly, std::string("\x1f\x8b\x08"),
                "no PLY file: it is packed by gzip; unpack it first");
}

}  // namespace
}  // namespace tubetwin

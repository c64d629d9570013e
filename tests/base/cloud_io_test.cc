#include <cstring>
#include <filesystem>
#include <fstream>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("tubetwin_cloud_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string File(const std::string& name) const { return (path / name).string(); }
  std::string Write(const std::string& name, const std::string& content) const {
    WriteFileAtomically(File(name), content);
    return File(name);
  }
};

OrganizedCloud SomeCloud(int width, int height, bool intensity, bool label) {
  RandomStream stream(7, 0, "cloud");
  OrganizedCloud cloud;
  cloud.width = width;
  cloud.height = height;
  for (int i = 0; i < width * height; ++i) {
    cloud.p_SP.push_back(i % 5 == 0
                             ? InvalidPoint()
                             : Eigen::Vector3f(stream.Uniform(-0.2, 0.2), stream.Uniform(-0.2, 0.2),
                                               stream.Uniform(0.3, 0.6)));
    if (intensity) cloud.intensity.push_back(static_cast<float>(stream.Uniform()));
    if (label) cloud.label.push_back(stream.NextBits());
  }
  cloud.X_NS = MakeTransform(RotZ(0.3) * RotX(kPi - 0.2), {0.1, -0.2, 0.515});
  return cloud;
}

void CheckSame(const OrganizedCloud& a, const OrganizedCloud& b) {
  CHECK(a.width == b.width);
  CHECK(a.height == b.height);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same = IsValid(a.p_SP[i]) ? a.p_SP[i] == b.p_SP[i] : !IsValid(b.p_SP[i]);
    if (!same) FAIL("point " << i << " differs");
  }
  CHECK((a.intensity == b.intensity));  // In parentheses: a failure prints no thousands of numbers.
  CHECK((a.label == b.label));
  constexpr double kQuaternionRounding = 1e-14;
  CHECK(a.X_NS.isApprox(b.X_NS, kQuaternionRounding));
}

Error CloudError(const std::string& path) {
  try {
    ReadCloud(path);
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error for " << path);
  throw 0;
}

void CheckBadFile(const std::string& path, const std::string& text) {
  const Error error = CloudError(path);
  CHECK(error.kind() == ErrorKind::kBadData);
  CHECK_THAT(error.what(), Contains(path));
  CHECK_THAT(error.what(), Contains(text));
}

// A small good header; tests change one line of it.
std::string Pcd(const std::string& from = "", const std::string& to = "") {
  std::string text =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
      "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n0.1 0.2 0.3\n0.4 0.5 nan\n";
  if (!from.empty()) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST_CASE("A cloud written as PCD reads back the same", "[unit]") {
  const Folder folder;
  for (const bool intensity : {false, true}) {
    for (const bool label : {false, true}) {
      const OrganizedCloud cloud = SomeCloud(40, 30, intensity, label);
      WritePcd(cloud, folder.File("a.pcd"));
      CheckSame(cloud, ReadPcd(folder.File("a.pcd")));
    }
  }
}

TEST_CASE("A cloud written as PLY reads back the same", "[unit]") {
  const Folder folder;
  const OrganizedCloud cloud = SomeCloud(40, 30, true, true);
  WritePly(cloud, folder.File("a.PLY"));
  CheckSame(cloud, ReadCloud(folder.File("a.PLY")));
}

TEST_CASE("Ascii PCD is read, a point with one bad coordinate is invalid", "[unit]") {
  const Folder folder;
  const OrganizedCloud cloud = ReadCloud(folder.Write("a.pcd", Pcd()));
  REQUIRE(cloud.size() == 2);
  CHECK(cloud.p_SP[0] == Eigen::Vector3f(0.1f, 0.2f, 0.3f));
  CHECK_FALSE(IsValid(cloud.p_SP[1]));
}

TEST_CASE("Unknown PCD fields are skipped wherever they stand", "[unit]") {
  const Folder folder;
  std::string text =
      "VERSION .7\nFIELDS rgb _ x y z normal\nSIZE 4 1 8 8 8 4\nTYPE U U F F F F\n"
      "COUNT 1 3 1 1 1 3\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n";
  text.append(7, '\x55');
  for (const double v : {0.1, 0.2, 0.4}) text.append(reinterpret_cast<const char*>(&v), 8);
  text.append(12, '\x33');
  const OrganizedCloud cloud = ReadCloud(folder.Write("a.pcd", text));
  REQUIRE(cloud.size() == 1);
  CHECK(cloud.p_SP[0] == Eigen::Vector3f(0.1f, 0.2f, 0.4f));
}

TEST_CASE("A header that claims 10^12 points is refused before memory is taken", "[unit]") {
  const Folder folder;
  std::string text = Pcd("WIDTH 2\nHEIGHT 1", "WIDTH 1000000\nHEIGHT 1000000");
  text.replace(text.find("POINTS 2"), 8, "POINTS 1000000000000");
  CheckBadFile(folder.Write("ascii.pcd", text), "POINTS 1000000000000");
  text.replace(text.find("ascii"), 5, "binary");
  CheckBadFile(folder.Write("binary.pcd", text), "POINTS 1000000000000 of 12 bytes each need more");
  CheckBadFile(folder.Write("a.pcd", Pcd("WIDTH 2", "WIDTH 1000000000000")),
               "a.pcd:7: WIDTH is '1000000000000', allowed are whole numbers from 1 to 2147483647");
  CheckBadFile(folder.Write("a.ply",
                            "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\n"
                            "property float x\nproperty float y\nproperty float z\nend_header\n"),
               "1000000000000");
}

TEST_CASE("Truncated data names the byte and what is missing", "[unit]") {
  const Folder folder;
  WritePcd(SomeCloud(40, 30, true, false), folder.File("whole.pcd"));
  const std::string whole = ReadFile(folder.File("whole.pcd"));
  CheckBadFile(folder.Write("cut.pcd", whole.substr(0, whole.size() - 17)),
               "POINTS 1200 of 16 bytes each need more than the 19183 bytes of data that follow");
  CheckBadFile(folder.Write("head.pcd", whole.substr(0, 60)), "the file ends inside its header");
  CheckBadFile(folder.Write("ascii.pcd", Pcd("0.4 0.5 nan\n", "0.4")),
               "ascii.pcd:13: point 1, field 'y' is missing");
  CheckBadFile(folder.Write("more.pcd", Pcd("nan\n", "nan\n7\n")), "data goes on");
  WritePly(SomeCloud(40, 30, true, false), folder.File("whole.ply"));
  const std::string ply = ReadFile(folder.File("whole.ply"));
  CheckBadFile(folder.Write("cut.ply", ply.substr(0, ply.size() - 200)), "bytes missing");
}

TEST_CASE("A bad PCD header names line, field, value and what is allowed", "[unit]") {
  const Folder folder;
  const struct {
    const char *from, *to, *text;
  } cases[] = {
      {"FIELDS x y z", "FIELDS x y w", "FIELDS lacks 'z', it has: x y w"},
      {"FIELDS x y z", "FIELDS x y y", "a.pcd:3: FIELDS names 'y' twice"},
      {"FIELDS x y z\n", "", "a.pcd:3: SIZE stands before FIELDS"},
      {"SIZE 4 4 4", "SIZE 4 4", "a.pcd:4: SIZE has 2 entries, FIELDS has 3"},
      {"SIZE 4 4 4", "SIZE 4 4 0", "SIZE of field 'z' is '0', allowed are whole numbers from 1"},
      {"COUNT 1 1 1", "COUNT 1 1 -1", "COUNT of field 'z' is '-1'"},
      {"VERSION 0.7", "VERSION 0.8", "a.pcd:2: VERSION is '0.8', allowed are 0.5, 0.6, 0.7"},
      {"POINTS 2", "POINTS 3", "POINTS is 3, WIDTH x HEIGHT is 2 x 1 = 2"},
      {"WIDTH 2", "WIDTH two", "a.pcd:7: WIDTH is 'two'"},
      {"WIDTH 2", "WITDH 2", "'WITDH' is no PCD header entry, nearest is WIDTH"},
      {"ascii", "zip", "DATA is 'zip', allowed are binary, binary_compressed, ascii"},
      {"1 0 0 0\nPOINTS", "1 1 0 0\nPOINTS", "a.pcd:9: VIEWPOINT's quaternion (qw qx qy qz) has"},
      {"0 1 0 0 0\nPOINTS", "1 0 0 0 0\nPOINTS", "has norm 0, allowed is 1 within 0.001"},
      {"1 0 0 0\nPOINTS", "1 0 0 nan\nPOINTS", "VIEWPOINT holds 'nan'"},
      {"1 0 0 0\nPOINTS", "1 0 0\nPOINTS", "VIEWPOINT has 6 numbers, 7 are needed"},
      {"0.4 0.5", "0.4 zero", "a.pcd:13: point 1, field 'y' is 'zero', no number"},
      {"0.1 0.2 0.3\n0.4", "100 200 400\n300", "the file is not in metres"},
  };
  for (const auto& c : cases) {
    INFO(c.from << " -> " << c.to);
    CheckBadFile(folder.Write("a.pcd", Pcd(c.from, c.to)), c.text);
  }
  CheckBadFile(folder.Write("noise.pcd", std::string("\x01\x02\x03", 3)),
               "noise.pcd:1: the file ends");
  CheckBadFile(folder.Write("empty.pcd", ""), "empty.pcd: is empty");
  CheckBadFile(folder.Write("a.xyz", "1 2 3"), "the ending is '.xyz', allowed are .pcd, .ply");
}

TEST_CASE("A cloud file that is not there is missing, not bad", "[unit]") {
  const Folder folder;
  CHECK(CloudError(folder.File("none.pcd")).kind() == ErrorKind::kMissing);
  fs::create_directories(folder.path / "folder.pcd");
  CHECK(CloudError(folder.File("folder.pcd")).kind() == ErrorKind::kMissing);
}

TEST_CASE("A PhoXi PLY is in millimetres and its points move into the camera's frame", "[unit]") {
  const Folder folder;
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nproperty float Texture32\nelement camera 1\nproperty float view_px\n"
      "property float view_py\nproperty float view_pz\nproperty float x_axisx\n"
      "property float x_axisy\nproperty float x_axisz\nproperty float y_axisx\n"
      "property float y_axisy\nproperty float y_axisz\nproperty float z_axisx\n"
      "property float z_axisy\nproperty float z_axisz\nelement phoxi_frame_params 1\n"
      "property uint frame_width\nproperty uint frame_height\nend_header\n"
      "100 50 58 7\n0 0 0 0\n100 0 500 1 0 0 0 -1 0 0 0 -1\n1 2\n";
  const OrganizedCloud cloud = ReadCloud(folder.Write("a.ply", text));
  CHECK(cloud.width == 1);
  CHECK(cloud.height == 2);
  CHECK((cloud.p_SP[0] - Eigen::Vector3f(0, -0.05f, 0.442f)).norm() < 1e-6f);  // Float rounding.
  CHECK_FALSE(IsValid(cloud.p_SP[1]));
  CHECK(cloud.X_NS.translation().isApprox(Vector3(0.1, 0, 0.5)));
  std::string mirrored = text;
  mirrored.replace(mirrored.find("1 0 0 0 -1 0 0 0 -1"), 19, "1 0 0 0 -1 0 0 0 +1");
  CheckBadFile(folder.Write("b.ply", mirrored), "b.ply");
}

TEST_CASE("An organised PLY carries PhoXi's elements in their order, its pinhole fits the points",
          "[unit]") {
  const Folder folder;
  OrganizedCloud cloud = SomeCloud(40, 30, false, false);
  for (std::size_t i = 0; i < cloud.size(); ++i) {  // A pinhole of 50 px.
    Eigen::Vector3f& p = cloud.p_SP[i];
    if (!IsValid(p)) continue;
    p.x() = (static_cast<float>(i % 40) + 0.5f - 20.0f) / 50.0f * p.z();
    p.y() = (static_cast<float>(i / 40) + 0.5f - 15.0f) / 50.0f * p.z();
  }
  WritePly(cloud, folder.File("a.ply"));
  CheckSame(cloud, ReadCloud(folder.File("a.ply")));
  const std::string file = ReadFile(folder.File("a.ply"));
  std::size_t at = 0;
  for (const char* element : {"vertex 1200", "camera 1", "phoxi_frame_params 1", "camera_matrix 1",
                              "distortion_matrix 1", "camera_resolution 1", "frame_binning 1"}) {
    const std::size_t next = file.find("\nelement " + std::string(element) + "\n", at);
    REQUIRE(next != std::string::npos);
    at = next;
  }
  // From the end: binning and resolution, 14 distortions, the matrix row by row.
  float matrix[9];
  std::memcpy(matrix, file.data() + file.size() - 16 - 14 * 4 - 9 * 4, sizeof matrix);
  CHECK(matrix[0] == Approx(50.0f).epsilon(1e-5));
  CHECK(matrix[2] == 19.5f);
  CHECK(matrix[4] == matrix[0]);
  CHECK(matrix[5] == 14.5f);
  CHECK(matrix[8] == 1.0f);
  std::uint32_t resolution[4];
  std::memcpy(resolution, file.data() + file.size() - 16, sizeof resolution);
  CHECK(resolution[0] == 40);
  CHECK(resolution[1] == 30);
}

TEST_CASE("A cloud written as a PhoXi frame says nothing but what PhoXi Control would", "[unit]") {
  const Folder folder;
  OrganizedCloud cloud = SomeCloud(4, 3, true, true);
  cloud.X_NS = Translation(1, 2, 3);
  WritePhoxiPly(cloud, 17, folder.File("frame.ply"));
  const std::string text = ReadFile(folder.File("frame.ply"));
  CHECK(text.find("comment") == std::string::npos);
  CHECK(text.find("label") == std::string::npos);
  const OrganizedCloud back = ReadPly(folder.File("frame.ply"));
  REQUIRE(back.width == 4);
  REQUIRE(back.height == 3);
  CHECK(back.X_NS.isApprox(RigidTransform::Identity()));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    REQUIRE(IsValid(back.p_SP[i]) == IsValid(cloud.p_SP[i]));
    constexpr float kTwoRoundings = 1.3e-7f;  // To float32 millimetres and back.
    if (IsValid(cloud.p_SP[i])) CHECK(back.p_SP[i].isApprox(cloud.p_SP[i], kTwoRoundings));
  }
}

TEST_CASE("An unorganised PLY with other properties and faces is read as points", "[unit]") {
  const Folder folder;
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment by hand\nelement vertex 3\n"
      "property uchar red\nproperty double x\nproperty float nx\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const double x : {0.1, 0.2, 0.3}) {
    text += '\x7f';
    const double y = 0.01, z = 0.5;
    const float nx = 1.0f;
    text.append(reinterpret_cast<const char*>(&x), 8);
    text.append(reinterpret_cast<const char*>(&nx), 4);
    text.append(reinterpret_cast<const char*>(&y), 8);
    text.append(reinterpret_cast<const char*>(&z), 8);
  }
  text += std::string("\x03\0\0\0\0\x01\0\0\0\x02\0\0\0", 13);
  const OrganizedCloud cloud = ReadCloud(folder.Write("a.ply", text));
  CHECK_FALSE(cloud.organized());
  REQUIRE(cloud.size() == 3);
  CHECK(cloud.p_SP[2] == Eigen::Vector3f(0.3f, 0.01f, 0.5f));
  CHECK(cloud.X_NS.isApprox(RigidTransform::Identity()));
  CheckBadFile(folder.Write("cut.ply", text.substr(0, text.size() - 13 - 20)), "cut.ply");
}

TEST_CASE("A whole PhoXi PLY in millimetres, every element, is read with its pose", "[unit]") {
  const Folder folder;
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float Texture32\nproperty float Depth32\nproperty float Confidence32\n"
      "element camera 1\n";
  for (const char* name : {"view_p", "x_axis", "y_axis", "z_axis"}) {
    for (const char* axis : {"x", "y", "z"})
      text += std::string("property float ") + name + axis + "\n";
  }
  text +=
      "element phoxi_frame_params 1\nproperty uint32 frame_width\nproperty uint32 frame_height\n"
      "property uint32 frame_index\nproperty float frame_start_time\n"
      "property float frame_duration\nproperty float frame_computation_duration\n"
      "property float frame_transfer_duration\nproperty int32 total_scan_count\n"
      "element camera_matrix 1\n";
  for (int i = 0; i < 9; ++i) text += "property float cm" + std::to_string(i) + "\n";
  text += "element distortion_matrix 1\n";
  for (int i = 0; i < 14; ++i) text += "property float dm" + std::to_string(i) + "\n";
  text +=
      "element camera_resolution 1\nproperty float width\nproperty float height\n"
      "element frame_binning 1\nproperty float horizontal\nproperty float vertical\nend_header\n";
  const auto add = [&](std::initializer_list<float> values) {
    for (const float v : values) text.append(reinterpret_cast<const char*>(&v), 4);
  };
  // The robot's space: the camera stands at (100, 200, 500) mm and looks down.
  for (const float x : {0.0f, 10.0f, 20.0f}) {
    add({100 + x, 200, 50, 0, 0, 1});
    text.append(3, '\x40');
    add({128, 450, 0.1f});
  }
  add({0, 0, 0, 0, 0, 1});
  text.append(3, '\0');
  add({0, 0, 0});
  add({100, 200, 500, 1, 0, 0, 0, -1, 0, 0, 0, -1});
  const std::uint32_t frame[3] = {2, 2, 7};
  text.append(reinterpret_cast<const char*>(frame), 12);
  add({0, 0, 0, 0});
  const std::int32_t count = 8;
  text.append(reinterpret_cast<const char*>(&count), 4);
  for (int i = 0; i < 9 + 14 + 4; ++i) add({1.0f});
  const OrganizedCloud cloud = ReadCloud(folder.Write("a.ply", text));
  CHECK(cloud.width == 2);
  REQUIRE(cloud.height == 2);
  CHECK((cloud.p_SP[1] - Eigen::Vector3f(0.01f, 0, 0.45f)).norm() < 1e-6f);
  CHECK_FALSE(IsValid(cloud.p_SP[3]));
  CHECK((cloud.X_NS.translation() - Vector3(0.1, 0.2, 0.5)).norm() < 1e-6);
  CHECK((cloud.X_NS.linear() - RotX(kPi)).norm() < 1e-6);
}

TEST_CASE("Plain PLY is in metres; millimetres must be said, never guessed", "[unit]") {
  const Folder folder;
  auto text = [](const std::string& comment) {
    return "ply\nformat ascii 1.0\n" + comment +
           "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
           "10 20 442\n";
  };
  CheckBadFile(folder.Write("a.ply", text("")), "the file is not in metres");
  CheckBadFile(folder.Write("a.ply", text("comment units furlong\n")), "allowed are m, mm, cm, in");
  const OrganizedCloud cloud = ReadCloud(folder.Write("a.ply", text("comment units mm\n")));
  CHECK((cloud.p_SP[0] - Eigen::Vector3f(0.01f, 0.02f, 0.442f)).norm() < 1e-6f);
  CHECK_FALSE(cloud.organized());
}

TEST_CASE("A full-resolution cloud is read as it was written", "[unit]") {
  const Folder folder;
  const OrganizedCloud written = SomeCloud(2064, 1544, true, true);
  WritePcd(written, folder.File("a.pcd"));
  const OrganizedCloud cloud = ReadPcd(folder.File("a.pcd"));
  CHECK(cloud.size() == 2064u * 1544u);
  CHECK(cloud.label == written.label);
  CHECK(cloud.p_SP[cloud.size() - 2] == written.p_SP[cloud.size() - 2]);
}

}  // namespace
}  // namespace tubetwin

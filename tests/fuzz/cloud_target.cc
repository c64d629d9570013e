#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "models/base/cloud/cloud.h"
#include "models/base/files.h"
#include "models/base/random.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/memory_file.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

void RequireWhole(const OrganizedCloud& cloud) {
  const std::size_t n = cloud.size();
  if (n == 0 || cloud.width < 1 || cloud.height < 1 ||
      static_cast<std::size_t>(cloud.width) * static_cast<std::size_t>(cloud.height) != n) {
    DieOf("cloud reader", "width x height is not the number of points");
  }
  if (!cloud.intensity.empty() && cloud.intensity.size() != n)
    DieOf("cloud reader", "intensity has another size");
  if (!cloud.label.empty() && cloud.label.size() != n)
    DieOf("cloud reader", "label has another size");
  if (!cloud.X_NS.matrix().allFinite()) DieOf("cloud reader", "the pose is not finite");
  const Matrix3 R = cloud.X_NS.linear();
  constexpr double kRounding = 1e-9;
  if (!(R.transpose() * R).isIdentity(kRounding) || R.determinant() < 0) {
    DieOf("cloud reader", "the pose is no rotation");
  }
  for (const Eigen::Vector3f& p : cloud.p_SP) {
    const bool nan = std::isnan(p.x()) && std::isnan(p.y()) && std::isnan(p.z());
    if (!nan && !p.allFinite()) DieOf("cloud reader", "a point is half valid");
  }
}

OrganizedCloud SmallCloud(int width, int height, bool intensity, bool label, RandomStream& stream) {
  OrganizedCloud cloud;
  cloud.width = width;
  cloud.height = height;
  for (int i = 0; i < width * height; ++i) {
    const bool valid = stream.Uniform() < 0.8;
    cloud.p_SP.push_back(valid ? Eigen::Vector3f(static_cast<float>(stream.Uniform(-0.2, 0.2)),
                                                 static_cast<float>(stream.Uniform(-0.2, 0.2)),
                                                 static_cast<float>(stream.Uniform(0.3, 0.6)))
                               : InvalidPoint());
    if (intensity) cloud.intensity.push_back(0.5f);
    if (label) cloud.label.push_back(static_cast<std::uint32_t>(i % 4));
  }
  cloud.X_NS = MakeTransform(RotZ(0.3) * RotX(kPi - 0.2), {0.1, -0.2, 0.515});
  return cloud;
}

template <class T>
void Append(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string CompressedPcd() {
  std::string planes;
  for (const float value : {0.1f, 0.4f, 0.2f, 0.5f, 0.3f, 0.3f}) Append(planes, value);
  // 20 literal bytes, then the last four of them again.
  const std::string packed = std::string(1, 19) + planes.substr(0, 20) + std::string("\x40\x03", 2);
  std::string out =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0.5 0 1 0 0\nPOINTS 2\nDATA binary_compressed\n";
  Append(out, static_cast<std::uint32_t>(packed.size()));
  Append(out, static_cast<std::uint32_t>(planes.size()));
  return out + packed;
}

std::string BigEndianPly() {
  std::string out =
      "ply\nformat binary_big_endian 1.0\ncomment units m\nelement vertex 2\n"
      "property list uchar ushort l\nproperty float x\nproperty float y\nproperty float z\n"
      "element phoxi_frame_params 1\nproperty uint frame_width\nproperty uint frame_height\n"
      "end_header\n";
  out += std::string("\x01\0\x07\x3d\xcc\xcc\xcd\x3d\xcc\xcc\xcd\x3f\0\0\0", 15);
  out += std::string("\0\x3d\xcc\xcc\xcd\x3d\xcc\xcc\xcd\x3f\0\0\0", 13);
  return out + std::string("\0\0\0\x02\0\0\0\x01", 8);
}

}  // namespace

void TryBytes(std::string_view bytes) {
  static MemoryFile file("cloud");
  file.Fill(bytes);
  TryReader("cloud reader", file.path(), [] { RequireWhole(ReadPcd(file.path())); });
  TryReader("cloud reader", file.path(), [] { RequireWhole(ReadPly(file.path(), 0.001)); });
}

std::vector<std::string> ByteCorpus() {
  std::vector<std::string> out;
  RandomStream stream(1, 0, "cloud corpus");
  const std::string path =
      (fs::temp_directory_path() / ("tubetwin_corpus_" + std::to_string(::getpid()))).string();
  for (const bool more : {false, true}) {
    const OrganizedCloud cloud = SmallCloud(4, more ? 3 : 1, more, more, stream);
    WritePcd(cloud, path);
    out.push_back(ReadFile(path));
    WritePly(cloud, path);
    out.push_back(ReadFile(path));
  }
  fs::remove(path);
  out.emplace_back(
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb normal label\nSIZE 4 8 4 4 4 1\n"
      "TYPE F F F U F U\nCOUNT 1 1 1 1 3 1\nWIDTH 1\nHEIGHT 2\nVIEWPOINT 0 0 0.5 0 1 0 0\n"
      "POINTS 2\nDATA ascii\n0.1 0.2 0.3 7 0 0 1 2\n0.4 0.5 nan 7 0 0 1 0\n");
  out.emplace_back(
      "ply\nformat ascii 1.0\ncomment units mm\nelement vertex 2\nproperty float x\n"
      "property float y\nproperty float z\nproperty float Texture32\nelement camera 1\n"
      "property float view_px\nproperty float view_py\nproperty float view_pz\n"
      "property float x_axisx\nproperty float x_axisy\nproperty float x_axisz\n"
      "property float y_axisx\nproperty float y_axisy\nproperty float y_axisz\n"
      "property float z_axisx\nproperty float z_axisy\nproperty float z_axisz\n"
      "element phoxi_frame_params 1\nproperty uint frame_width\nproperty uint frame_height\n"
      "element face 0\nproperty list uchar int vertex_indices\nend_header\n"
      "100 50 58 7\n0 0 0 0\n100 0 500 1 0 0 0 -1 0 0 0 -1\n1 2\n");
  out.push_back(CompressedPcd());
  out.emplace_back(
      "# units: mm\nVERSION .6\nCOLUMNS x _ y z\nSIZE 2 1 2 4\nTYPE I U I F\nCOUNT 1 0 1 1\n"
      "POINTS 1\nDATA binary\nabcdABCDbehind");
  out.emplace_back(
      "ply\nformat ascii 1.0\nobj_info num_cols 2\nelement face 1\n"
      "property list uchar int vertex_indices\nelement vertex 1\nproperty odd o\n"
      "property bool b\nproperty list int float l\nproperty double x\nproperty float y\n"
      "property float z\nend_header\n3 0 1 2\nodd 1 2 7 8 +0.1 -1.#IND 0.3\n");
  out.push_back(BigEndianPly());
  return out;
}

}  // namespace tubetwin

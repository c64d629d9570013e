#include "tests/fuzz/cloud_target.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/random.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Die(const std::string& problem) {
  std::fprintf(stderr, "cloud reader: %s\n", problem.c_str());
  std::abort();
}

/// A regular file in memory, known by a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : handle_(::memfd_create("cloud", 0)) {
    if (handle_ < 0 ||
        ::write(handle_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      Die("no file in memory");
    }
  }
  ~MemoryFile() { ::close(handle_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(handle_); }

 private:
  int handle_;
};

void RequireWhole(const OrganizedCloud& cloud) {
  const std::size_t n = cloud.size();
  if (n == 0 || cloud.width < 1 || cloud.height < 1 ||
      static_cast<std::size_t>(cloud.width) * static_cast<std::size_t>(cloud.height) != n) {
    Die("width x height is not the number of points");
  }
  if (!cloud.intensity.empty() && cloud.intensity.size() != n) Die("intensity has another size");
  if (!cloud.label.empty() && cloud.label.size() != n) Die("label has another size");
  if (!cloud.X_NS.matrix().allFinite()) Die("the pose is not finite");
  const Matrix3 R = cloud.X_NS.linear();
  constexpr double kRounding = 1e-9;
  if (!(R.transpose() * R).isIdentity(kRounding) || R.determinant() < 0) {
    Die("the pose is no rotation");
  }
  for (const Eigen::Vector3f& p : cloud.p_SP) {
    const bool nan = std::isnan(p.x()) && std::isnan(p.y()) && std::isnan(p.z());
    if (!nan && !p.allFinite()) Die("a point is half valid");
  }
}

void Try(OrganizedCloud (*read)(const std::string&, std::optional<double>),
         const std::string& path) {
  try {
    RequireWhole(read(path, std::nullopt));
  } catch (const Error& error) {
    const std::string what = error.what();
    if (error.kind() != ErrorKind::kBadData) Die("another kind of error: " + what);
    if (what.find(path) == std::string::npos) Die("the file is not named: " + what);
    if (std::count(what.begin(), what.end(), '\n') > 3) Die("more than four lines: " + what);
  } catch (const std::exception& error) {
    Die(std::string("not an Error: ") + error.what());
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

}  // namespace

void TryCloudBytes(std::string_view bytes) {
  const MemoryFile file(bytes);
  Try(ReadPcd, file.path());
  Try(ReadPly, file.path());
}

std::vector<std::string> CloudCorpus() {
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
  return out;
}

}  // namespace tubetwin

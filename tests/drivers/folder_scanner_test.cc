#include "hw_bridge/drivers/photoneo/folder_scanner.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "hw_bridge/drivers/photoneo/scan_check.h"
#include "models/base/config/config.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/fake_scanner.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// The driver on a folder in which the test plays the operator.
struct Bench {
  explicit Bench(double timeout_s = 25.0)
      : driver(Link(timeout_s), [] { return Translation(1, 2, 3); }) {}
  ScannerLinkConfig Link(double timeout_s) const {
    ScannerLinkConfig config;
    config.path = folder.path();
    config.timeout_s = timeout_s;
    return config;
  }
  /// Triggers, and returns when the operator can see it.
  void Trigger(const std::string& file = "trigger-000001") {
    REQUIRE(driver.Trigger().accepted());
    for (int i = 0; i < 20000 && !fs::exists(folder / file); ++i) Rest();
    REQUIRE(fs::exists(folder / file));
  }
  ScanStatus Await() {
    for (int i = 0; i < 60000 && driver.Status() == ScanStatus::kBusy; ++i) Rest();
    return driver.Status();
  }
  static void Rest() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

  TemporaryFolder folder;
  FolderScanner driver;
};

/// A frame of 3 x 2 pixels as PhoXi Control saves it as text, in millimetres: normals, texture,
/// depth, confidence, all elements; one pixel empty.
std::string PhoxiText() {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 6\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    text += std::string("property float ") + name + "\n";
  }
  text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  text += "property float Texture32\nproperty float Depth32\nproperty float Confidence32\n";
  text += "element camera 1\n";
  for (const char* name : {"view_px", "view_py", "view_pz", "x_axisx", "x_axisy", "x_axisz",
                           "y_axisx", "y_axisy", "y_axisz", "z_axisx", "z_axisy", "z_axisz"}) {
    text += std::string("property float ") + name + "\n";
  }
  text +=
      "element phoxi_frame_params 1\nproperty uint32 frame_width\n"
      "property uint32 frame_height\nproperty uint32 frame_index\n"
      "property float frame_start_time\nproperty float frame_duration\n"
      "property float frame_computation_duration\nproperty float frame_transfer_duration\n"
      "property int32 total_scan_count\nelement camera_matrix 1\n";
  for (int i = 0; i < 9; ++i) text += "property float cm" + std::to_string(i) + "\n";
  text += "element distortion_matrix 1\n";
  for (int i = 0; i < 14; ++i) text += "property float dm" + std::to_string(i) + "\n";
  text +=
      "element camera_resolution 1\nproperty float width\nproperty float height\n"
      "element frame_binning 1\nproperty float horizontal\nproperty float vertical\n"
      "end_header\n";
  const char* rest = " 0 0 -1 128 128 128 532.5 442 0.05\n";
  for (const char* p : {"-10 -5 442", "0 -5 442", "10 -5 442.5", "-10 5 440"}) {
    text += std::string(p) + rest;
  }
  text += "0 0 0 0 0 1 0 0 0 0 0 0\n";
  text += std::string("10 5 441") + rest;
  text += "0 0 0 1 0 0 0 1 0 0 0 1\n3 2 17 1234.5 480 120 30 1\n";
  text += "2534 0 1031.5 0 2534 771.5 0 0 1\n0 0 0 0 0 0 0 0 0 0 0 0 0 0\n3 2\n1 1\n";
  return text;
}

void CheckPhoxiFrame(const OrganizedCloud& cloud) {
  REQUIRE(cloud.width == 3);
  REQUIRE(cloud.height == 2);
  CHECK(cloud.p_SP[0] == Eigen::Vector3f(-0.010f, -0.005f, 0.442f));
  CHECK(cloud.p_SP[2] == Eigen::Vector3f(0.010f, -0.005f, 0.4425f));
  CHECK_FALSE(IsValid(cloud.p_SP[4]));
  CHECK(cloud.p_SP[5] == Eigen::Vector3f(0.010f, 0.005f, 0.441f));
  CHECK(cloud.X_NS.translation() == Vector3(1, 2, 3));  // Of the arm, not of the file.
}

TEST_CASE("A PhoXi frame that an operator saves answers the trigger", "[unit]") {
  Bench bench;
  bench.Trigger();
  WriteFileAtomically(bench.folder / "bin left.ply", PhoxiText());
  REQUIRE(bench.Await() == ScanStatus::kReady);
  CheckPhoxiFrame(bench.driver.Take());
  CHECK_FALSE(fs::exists(bench.folder / "trigger-000001"));
  CHECK(fs::exists(bench.folder / "bin left.ply"));  // Only its owner removes it.
}

TEST_CASE("A file that has its size before its content is taken when nobody writes it any more",
          "[unit]") {
  Bench bench;
  bench.Trigger();
  OrganizedCloud cloud;
  cloud.width = 64;
  cloud.height = 64;
  cloud.p_SP.assign(64 * 64, Eigen::Vector3f(0.01f, 0.02f, 0.44f));
  WritePcd(cloud, bench.folder / ".whole.pcd");
  const std::string bytes = ReadFile(bench.folder / ".whole.pcd");
  std::ofstream out(bench.folder / "scan-000001.pcd", std::ios::binary);
  const std::size_t head = bytes.size() - 64 * 64 * 12;
  out << bytes.substr(0, head) << std::string(bytes.size() - head, '\0') << std::flush;
  constexpr std::size_t kParts = 10;
  for (std::size_t part = 0; part < kParts; ++part) {
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    CHECK(bench.driver.Status() == ScanStatus::kBusy);
    const std::size_t from = head + part * (bytes.size() - head) / kParts;
    const std::size_t to = head + (part + 1) * (bytes.size() - head) / kParts;
    out.seekp(static_cast<std::streamoff>(from));
    out << bytes.substr(from, to - from) << std::flush;
  }
  REQUIRE(bench.Await() == ScanStatus::kReady);
  const OrganizedCloud taken = bench.driver.Take();
  REQUIRE(taken.p_SP.size() == cloud.p_SP.size());
  for (const auto& p : taken.p_SP) REQUIRE(p.z() == 0.44f);
}

TEST_CASE("A file is taken when it is whole, however slowly it is written", "[unit]") {
  const std::string name = GENERATE("scan-000001.ply", "by hand.ply");
  Bench bench;
  bench.Trigger();
  const std::string text = PhoxiText();
  std::ofstream out(bench.folder / name);
  std::size_t written = 0;
  for (const double share : {0.1, 0.5, 0.9, 0.99, 1.0}) {
    const auto end = static_cast<std::size_t>(share * static_cast<double>(text.size()));
    out.write(text.data() + written, static_cast<std::streamsize>(end - written));
    out.flush();
    written = end;
    if (share < 1.0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      CHECK(bench.driver.Status() == ScanStatus::kBusy);
    }
  }
  out.close();
  REQUIRE(bench.Await() == ScanStatus::kReady);
  CheckPhoxiFrame(bench.driver.Take());
}

TEST_CASE("The newest file after the trigger counts, older ones do not", "[unit]") {
  Bench bench;
  WriteFileAtomically(bench.folder / "before.ply", PhoxiText());
  WritePcd(SomeScan(1), bench.folder / "scan-000041.pcd");
  bench.Trigger("trigger-000042");  // Numbers go on after those in the folder.
  WritePcd(SomeScan(2), bench.folder / ".first.pcd");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  WritePcd(SomeScan(3), bench.folder / ".second.pcd");
  fs::rename(bench.folder / ".second.pcd", bench.folder / "second.pcd");
  fs::rename(bench.folder / ".first.pcd", bench.folder / "first.pcd");
  REQUIRE(bench.Await() == ScanStatus::kReady);
  CHECK(bench.driver.Take().p_SP.back().z() == Approx(SomeScan(3).p_SP.back().z()).margin(0));
  // The same name again is a new scan.
  bench.Trigger("trigger-000043");
  WriteFileAtomically(bench.folder / "before.ply", PhoxiText());
  REQUIRE(bench.Await() == ScanStatus::kReady);
  CHECK(bench.driver.Take().width == 3);
}

TEST_CASE("A scan that no camera took is refused with its file", "[unit]") {
  Bench bench;
  bench.Trigger();
  SECTION("not organised") {
    OrganizedCloud cloud = SomeScan(1);
    cloud.width = static_cast<int>(cloud.size());
    cloud.height = 1;
    WritePcd(cloud, bench.folder / "scan-000001.pcd");
    REQUIRE(bench.Await() == ScanStatus::kFailed);
    CHECK_THAT(bench.driver.FailureReason(), Contains("scan-000001.pcd: the cloud has 1200 x 1"));
  }
  SECTION("an empty file") {
    WriteFileAtomically(bench.folder / "scan-000001.ply", "");
    REQUIRE(bench.Await() == ScanStatus::kFailed);
    CHECK_THAT(bench.driver.FailureReason(), Contains("scan-000001.ply: is empty"));
  }
  SECTION("no points") {
    std::string text = PhoxiText();
    text.replace(text.find("vertex 6"), 8, "vertex 0");
    WriteFileAtomically(bench.folder / "scan-000001.ply", text);
    REQUIRE(bench.Await() == ScanStatus::kFailed);
    CHECK_THAT(bench.driver.FailureReason(),
               Contains("there is no element 'vertex' with at least one row"));
  }
}

TEST_CASE("A file larger than any scan of the scanner is refused before it takes memory",
          "[unit]") {
  Bench bench;
  bench.Trigger();
  const std::string path = bench.folder / "scan-000001.pcd";
  std::ofstream(bench.folder / "growing") << "# .PCD v0.7\n";
  fs::resize_file(bench.folder / "growing", std::uintmax_t{48} << 27);
  fs::rename(bench.folder / "growing", path);
  REQUIRE(bench.Await() == ScanStatus::kFailed);
  CHECK_THAT(
      bench.driver.FailureReason(),
      Contains("scan-000001.pcd: holds 6442450944 bytes; allowed: 815824896 for four scans of "
               "3186816 points"));
}

TEST_CASE("A folder that is not there is a device that cannot be reached", "[unit]") {
  Bench bench;
  ScannerLinkConfig config = bench.Link(1.0);
  config.path = bench.folder / "none";
  try {
    (void)ConnectScanner(config, [] { return RigidTransform::Identity(); });
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("scanner folder '" + config.path + "': there is no such"));
  }
}

TEST_CASE("A folder that vanishes fails the scan at once", "[unit]") {
  Bench bench;
  SECTION("before the trigger") {
    fs::remove_all(bench.folder.path());
    REQUIRE(bench.driver.Trigger().accepted());
  }
  SECTION("after it") {
    bench.Trigger();
    fs::remove_all(bench.folder.path());
  }
  REQUIRE(bench.Await() == ScanStatus::kFailed);
  CHECK_THAT(bench.driver.FailureReason(), Contains(bench.folder.path()));
  CHECK_FALSE(fs::exists(bench.folder.path()));
}

TEST_CASE("The time limit runs in the cell's time", "[unit]") {
  Bench bench;
  ScannerLinkConfig config = bench.Link(25.0);
  config.rate = 100.0;  // A quarter of a second.
  FolderScanner fast(config, [] { return RigidTransform::Identity(); });
  REQUIRE(fast.Trigger().accepted());
  for (int i = 0; i < 20000 && fast.Status() == ScanStatus::kBusy; ++i) Bench::Rest();
  REQUIRE(fast.Status() == ScanStatus::kFailed);
  CHECK_THAT(fast.FailureReason(), Contains("no whole scan within 25 s"));
}

TEST_CASE("The link's configuration says what is wrong with it", "[unit]") {
  ScannerLinkConfig config;
  CHECK_THROWS_WITH(config.ValidateOrThrow(), Contains("cell.scanner.path: is empty"));
  ConfigSource source;
  source.AddText("path = 'scans'\ntimeout_s = 5.0\n", "cell.toml");
  source.ReadInto(config);
  CHECK(config.path == "scans");
  CHECK(config.timeout_s == 5.0);
  CHECK_NOTHROW(config.ValidateOrThrow());
  config.rate = 0;
  CHECK_THROWS_WITH(config.ValidateOrThrow(), Contains("rate is 0"));
  ConfigSource wrong;
  wrong.AddText("timeout_s = 0\n", "cell.toml");
  CHECK_THROWS_WITH(wrong.ReadInto(config), Contains("cell.toml:1") && Contains("timeout_s"));
}

TEST_CASE("A thousandth of wild points is noise, more is damage", "[unit]") {
  OrganizedCloud cloud = SomeScan(1, 100, 100);
  for (Eigen::Vector3f& p : cloud.p_SP) p = {0, 0, 0.4f};
  for (std::size_t i = 0; i < 10; ++i) cloud.p_SP[i * 7].z() = -0.1f;
  CHECK(NoScan(cloud) == std::nullopt);
  cloud.p_SP[9000] = {0, 21, 0.4f};
  REQUIRE(NoScan(cloud));
  CHECK_THAT(*NoScan(cloud), Contains("11 of 10000 points") && Contains("first point 0 at"));
}

}  // namespace
}  // namespace tubetwin

#include <filesystem>
#include <set>

#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/contract/folder_rig.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// Triggers and returns why the scan failed.
std::string FailedScan(ScannerRig& rig) {
  REQUIRE(rig.scanner().Trigger().accepted());
  REQUIRE(AwaitScan(rig) == ScanStatus::kFailed);
  return rig.scanner().FailureReason();
}

std::set<std::string> Names(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& file : fs::directory_iterator(folder)) {
    names.insert(file.path().filename().string());
  }
  return names;
}

TEST_CASE("Driver and folder feed keep the scanner's contract", "[contract]") {
  FolderRig rig;
  CheckScannerContract(rig);
  CHECK(rig.device.triggers == 3);
}

TEST_CASE("A cloud crosses the folder point by point, with the pose of the trigger", "[contract]") {
  const std::string format = GENERATE("pcd", "ply");
  FolderRig rig(format);
  REQUIRE(rig.driver.Trigger().accepted());
  const RigidTransform X_NS = rig.X_NS;
  rig.X_NS = Translation(7, 7, 7);  // The arm has gone on.
  REQUIRE(AwaitScan(rig) == ScanStatus::kReady);
  const OrganizedCloud got = rig.driver.Take();
  CheckSamePoints(got, rig.device.sees, format == "pcd" ? 0.0f : kMillimetreRounding);
  CHECK(got.X_NS.isApprox(X_NS, 0.0));
  CHECK(got.label.empty());  // Labels are for scoring, no device knows them.
  CHECK(Names(rig.folder.path()) == std::set<std::string>{"scan-000001." + format});
}

TEST_CASE("Each scan is a new one, and only the newest answers stay in the folder", "[contract]") {
  FolderRig rig;
  for (std::uint64_t k = 1; k <= 10; ++k) {
    rig.device.sees = SomeScan(k);
    CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
  }
  // An answer counts when the old ones are gone, a moment after the driver has read it.
  StepUntil(rig, [&rig] { return rig.emulator.answers() == 10; });
  const std::set<std::string> names = Names(rig.folder.path());
  CHECK(names.size() == 8);
  CHECK(*names.begin() == "scan-000003.pcd");
}

TEST_CASE("A damaged answer is a failed scan that names file and place; the next one works",
          "[contract]") {
  FolderRig rig;
  const std::string file = rig.folder / "scan-000001.pcd";
  SECTION("truncated") {
    rig.emulator.faults().Order(ScanFault::kTruncated, 1);
    CHECK_THAT(FailedScan(rig), Contains(file + ": byte ") &&
                                    Contains("POINTS 1200 of 12 bytes each need more than the"));
  }
  SECTION("garbage") {
    rig.emulator.faults().Order(ScanFault::kGarbage, 1);
    CHECK_THAT(FailedScan(rig), Contains(file + ":1: ") && Contains("is no PCD header entry"));
  }
  SECTION("corrupted on its way") {
    rig.emulator.link().corrupt = true;
    CHECK_THAT(FailedScan(rig),
               Contains(file + ":2: 'VE\\x") && Contains("SION' is no PCD header"));
    rig.emulator.link().corrupt = false;
  }
  SECTION("points that no scanner sees") {
    rig.device.sees.p_SP[77].z() = -0.4f;
    rig.device.sees.p_SP[78] = {30.0f, 0.0f, 0.4f};
    CHECK_THAT(FailedScan(rig), Contains(file + ": 2 of ") && Contains("first point 77 at ("));
    rig.device.sees = SomeScan(2);
  }
  CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
}

TEST_CASE("A truncated PhoXi file names the byte where it ends", "[contract]") {
  FolderRig rig("ply");
  rig.emulator.faults().Order(ScanFault::kTruncated, 1);
  CHECK_THAT(FailedScan(rig),
             Contains("scan-000001.ply: byte ") && Contains("count of element 'vertex' is 1200"));
}

TEST_CASE("A scan through a covered lens is a whole cloud without points", "[contract]") {
  const std::string format = GENERATE("pcd", "ply");
  FolderRig rig(format);
  rig.emulator.faults().Order(ScanFault::kEmptyCloud, 1);
  const OrganizedCloud got = TakeScan(rig);
  CHECK(got.width == 40);
  CHECK(got.height == 30);
  for (const Eigen::Vector3f& p : got.p_SP) CHECK_FALSE(IsValid(p));
}

TEST_CASE("A trigger without answer times out and is taken back", "[contract]") {
  FolderRig rig("pcd", 0.3);
  SECTION("the feed does not run") {
    rig.feed_runs = false;
    CHECK_THAT(FailedScan(rig), Contains(rig.folder.path()) &&
                                    Contains("no whole scan within 0.3 s of trigger-000001"));
  }
  SECTION("the feed loses it") {
    rig.emulator.faults().Order(ScanFault::kNoAnswer, 1);
    CHECK_THAT(FailedScan(rig), Contains("no whole scan within 0.3 s"));
    CHECK(rig.device.triggers == 0);
  }
  SECTION("the link drops it") {
    rig.emulator.link().drop = true;
    CHECK_THAT(FailedScan(rig), Contains("no whole scan within 0.3 s"));
  }
  SECTION("the feed is frozen") {
    rig.emulator.link().freeze = true;
    CHECK_THAT(FailedScan(rig), Contains("no whole scan within 0.3 s"));
    CHECK(rig.emulator.triggers() == 0);
  }
  CHECK(Names(rig.folder.path()).empty());
}

TEST_CASE("An answer that comes too late does not answer the next trigger", "[contract]") {
  FolderRig rig("pcd", 0.3);
  rig.device.sees = SomeScan(1);
  rig.emulator.faults().OrderLate(1e6, 1);
  CHECK_THAT(FailedScan(rig), Contains("no whole scan"));
  // The answer to the first trigger comes while the second one waits.
  WriteThroughTemporary(rig.folder / "scan-000001.pcd",
                        [](const std::string& path) { WritePcd(SomeScan(1), path); });
  CHECK_THAT(FailedScan(rig), Contains("of trigger-000002"));
}

TEST_CASE("A late or repeated answer in time is taken", "[contract]") {
  FolderRig rig;
  SECTION("late") { rig.emulator.faults().OrderLate(0.5, 1); }
  SECTION("delayed by the link") { rig.emulator.link().delay = FromSeconds(0.5); }
  SECTION("twice") { rig.emulator.link().duplicate = true; }
  CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
  rig.device.sees = SomeScan(2);
  CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
}

TEST_CASE("Refusals and failures of the scanner reach the client with their reason", "[contract]") {
  FolderRig rig;
  SECTION("ordered") {
    rig.emulator.faults().OrderRefusal("lid closed", 1);
    CHECK_THAT(FailedScan(rig), Contains("the scan was refused: lid closed"));
  }
  SECTION("the device refuses") {
    rig.device.refuses = "laser interlock open";
    CHECK_THAT(FailedScan(rig), Contains("the scan was refused: laser interlock open"));
    rig.device.refuses.clear();
  }
  SECTION("the device fails") {
    rig.device.fails = "too hot";
    CHECK_THAT(FailedScan(rig), Contains("the scan was refused: too hot"));
    rig.device.fails.clear();
    rig.device.Trigger();
    rig.device.now += rig.device.takes;
  }
  CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
}

TEST_CASE("The feed survives junk, floods and the loss of its folder", "[contract]") {
  FolderRig rig;
  fs::create_directory(rig.folder / "trigger-000003");  // A folder is no trigger.
  for (const char* name :
       {"trigger-x", "trigger-", "trigger-000002.tmp", "scan-9.txt", "\xff\xfe"}) {
    WriteFileAtomically(rig.folder / name, "junk");
  }
  for (int i = 100; i < 400; ++i) {
    WriteFileAtomically(rig.folder / ("trigger-000" + std::to_string(i)), "");
  }
  CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
  CHECK(fs::exists(rig.folder / "trigger-x"));
  CHECK(rig.device.triggers <= 2);  // At most one of the flood, and ours.
  StepUntil(rig, [&rig] {
    // Again and again: what answers the flood's trigger may still be under way, and makes a folder.
    std::error_code not_empty;
    fs::remove_all(rig.folder.path(), not_empty);
    return !rig.emulator.last_problem().empty();
  });
  CHECK_THAT(rig.emulator.last_problem(), Contains(rig.folder.path()));
  fs::create_directories(rig.folder.path());
  CheckSamePoints(TakeScan(rig), rig.device.sees, 0.0f);
}

TEST_CASE("Each side can end while a scan runs", "[contract]") {
  FolderRig rig;
  rig.device.takes = FromSeconds(1e6);
  REQUIRE(rig.driver.Trigger().accepted());
  StepUntil(rig, [&rig] { return rig.emulator.triggers() == 1; });
}

}  // namespace
}  // namespace tubetwin

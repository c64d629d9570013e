#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <vector>

#include "models/base/random.h"
#include "tests/contract/gige_rig.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

/// Triggers and returns why the scan failed.
std::string FailedScan(ScannerRig& rig) {
  REQUIRE(rig.scanner().Trigger().accepted());
  REQUIRE(AwaitScan(rig) == ScanStatus::kFailed);
  return rig.scanner().FailureReason();
}

TEST_CASE("Driver and emulated GigE Vision scanner keep the scanner's contract", "[contract]") {
  GigeRig rig;
  CheckScannerContract(rig);
  CHECK(rig.device.triggers == 3);
  StepUntil(rig, [&rig] { return rig.emulator->answers() == 3; });
}

TEST_CASE("A cloud crosses GigE Vision point by point, with the pose of the trigger",
          "[contract]") {
  GigeRig rig;
  REQUIRE(rig.driver->Trigger().accepted());
  const RigidTransform X_NS = rig.X_NS;
  rig.X_NS = Translation(7, 7, 7);  // The arm has gone on.
  REQUIRE(AwaitScan(rig) == ScanStatus::kReady);
  const OrganizedCloud got = rig.driver->Take();
  CheckSamePoints(got, rig.device.sees, kMillimetreRounding);
  CHECK(got.X_NS.isApprox(X_NS, 0.0));
  CHECK(got.label.empty());  // Labels are for scoring, no device knows them.
}

TEST_CASE("Each GigE Vision scan is a new one, also for the next program that connects",
          "[contract]") {
  GigeRig rig;
  for (std::uint64_t k = 1; k <= 4; ++k) {
    if (k == 3) {
      rig.driver.reset();
      rig.Connect(25.0);
    }
    rig.device.sees = SomeScan(k, GigeRig::kWidth, GigeRig::kHeight);
    CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
  }
  StepUntil(rig, [&rig] { return rig.emulator->answers() == 4; });
}

TEST_CASE("A frame that lost packets is asked for once more", "[contract]") {
  GigeRig rig;
  SECTION("and then it comes") {
    rig.emulator->faults().Order(ScanFault::kTruncated, 1);
    CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
    CHECK(rig.device.triggers == 2);
  }
  SECTION("and no more than once") {
    rig.emulator->faults().Order(ScanFault::kTruncated, 2);
    CHECK_THAT(FailedScan(rig), Contains("scanner 127.0.0.1:3956 (GigE Vision): the frame came "
                                         "incomplete twice: "));
    CHECK(rig.device.triggers == 2);
    CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
  }
}

TEST_CASE("A frame that is no scan fails with what is wrong with it; the next one works",
          "[contract]") {
  GigeRig rig;
  SECTION("garbage") {
    rig.emulator->faults().Order(ScanFault::kGarbage, 1);
    CHECK_THAT(FailedScan(rig), Contains("127.0.0.1:3956") && Contains("points"));
  }
  SECTION("corrupted on its way") {
    rig.emulator->link().corrupt = true;
    CHECK_THAT(FailedScan(rig), Contains("127.0.0.1:3956") && Contains("points"));
    rig.emulator->link().corrupt = false;
  }
  SECTION("sent twice, the second copy is no answer to the next trigger") {
    rig.emulator->link().duplicate = true;
    CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
    for (int i = 0; i < 200; ++i) rig.Step();
    rig.emulator->link().duplicate = false;
    rig.device.sees = SomeScan(2, GigeRig::kWidth, GigeRig::kHeight);
  }
  CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
}

TEST_CASE("A GigE Vision scan through a covered lens is a whole cloud without points",
          "[contract]") {
  GigeRig rig;
  rig.emulator->faults().Order(ScanFault::kEmptyCloud, 1);
  const OrganizedCloud got = TakeScan(rig);
  CHECK(got.width == GigeRig::kWidth);
  CHECK(got.height == GigeRig::kHeight);
  for (const Eigen::Vector3f& p : got.p_SP) CHECK_FALSE(IsValid(p));
}

TEST_CASE("A GigE Vision trigger without frame times out", "[contract]") {
  GigeRig rig(0.4);
  const std::string awaited = "no whole frame within 0.4 s of the trigger";
  SECTION("the scanner does not answer") {
    rig.emulator->faults().Order(ScanFault::kNoAnswer, 1);
    CHECK_THAT(FailedScan(rig), Contains(awaited));
    CHECK(rig.device.triggers == 0);
  }
  SECTION("the scanner refuses, for which the protocol has no word") {
    rig.device.refuses = "too hot";
    CHECK_THAT(FailedScan(rig), Contains(awaited));
    CHECK(rig.emulator->last_problem() == "too hot");
    rig.device.refuses.clear();
  }
  SECTION("the link drops it") {
    rig.emulator->link().drop = true;
    CHECK_THAT(FailedScan(rig), Contains(awaited));
    rig.emulator->link().drop = false;
  }
  SECTION("a cloud of another size than announced") {
    rig.device.sees = SomeScan(1, 40, 30);
    CHECK_THAT(FailedScan(rig), Contains(awaited));
    CHECK(rig.emulator->last_problem() == "the cloud has 40 x 30 points, 160 x 120 are announced");
  }
}

TEST_CASE("A frame that comes too late does not answer the next trigger", "[contract]") {
  GigeRig rig(0.5);
  rig.device.sees = SomeScan(1, GigeRig::kWidth, GigeRig::kHeight);
  rig.emulator->faults().OrderLate(1e6, 1);
  CHECK_THAT(FailedScan(rig), Contains("no whole frame"));
  rig.device.now += FromSeconds(2e6);  // It is due as soon as the emulator runs again.
  rig.driver.reset();
  rig.Connect(25.0);
  rig.device.sees = SomeScan(2, GigeRig::kWidth, GigeRig::kHeight);
  CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
}

/// Sends to the camera's control port what no client of its own does.
void SendToControl(const std::vector<std::string>& datagrams) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  REQUIRE(socket >= 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(3956);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (const std::string& bytes : datagrams) {
    ::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
             sizeof to);
  }
  ::close(socket);
}

TEST_CASE("No datagram of anybody takes the camera down, or its control away", "[contract]") {
  GigeRig rig;
  using namespace std::string_literals;
  // A register beyond all, and the control from whoever has it.
  std::vector<std::string> hostile = {"\x42\x01\x00\x80\x00\x04\x00\x01\x00\x01\x20\x00"s,
                                      "\x42\x01\x00\x82\x00\x08\x00\x01\x00\x00\x0a\x00\0\0\0\0"s,
                                      ""s, std::string(9000, 'B')};
  for (std::uint64_t k = 0; k < 2000; ++k) {
    RandomStream stream(1, k, "hostile datagrams");
    std::string bytes(stream.Index(80), '\0');
    for (char& byte : bytes) byte = static_cast<char>(stream.Index(256));
    if (bytes.size() > 8) bytes.replace(0, 2, "\x42\x01");
    hostile.push_back(bytes);
  }
  SendToControl(hostile);
  CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);
}

TEST_CASE("Nobody at the address is a device that cannot be reached", "[contract]") {
  const auto began = std::chrono::steady_clock::now();
  try {
    const GigeScanner driver(GigeLinkTo("127.0.0.1"), [] { return RigidTransform::Identity(); });
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("scanner 127.0.0.1:3956 (GigE Vision)") &&
                                 Contains("no GenICam description") && Contains("timeout"));
  }
  CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(8));
  try {
    const GigeScanner driver(GigeLinkTo("phoxi.local"), [] { return RigidTransform::Identity(); });
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kConfig);
    CHECK_THAT(error.what(), Contains("'phoxi.local', allowed is the scanner's IPv4 address"));
  }
}

TEST_CASE("A scanner that vanishes is lost for good", "[contract]") {
  GigeRig rig;
  rig.emulator.reset();
  CHECK_THAT(FailedScan(rig), Contains("127.0.0.1:3956") && Contains("TriggerSoftware"));
  for (int i = 0; i < 20000; ++i) {  // Until the heartbeat tells.
    const std::string reason = FailedScan(rig);
    if (reason.find("control was lost") != std::string::npos) break;
  }
  rig.emulator.emplace(rig.device, ScannerGigeConfig{"127.0.0.1", 160, 120});
  CHECK_THAT(FailedScan(rig), Contains("control was lost"));
}

TEST_CASE("The port of GigE Vision is there once, and a second program gets no control",
          "[contract]") {
  GigeRig rig;
  try {
    const ScannerGigeEmulator second(rig.device, {});
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("cannot listen on 127.0.0.1:3956, UDP: Address already in"));
  }
  CHECK_THROWS_WITH(ScannerGigeEmulator(rig.device, {"192.0.2.1", 160, 120}),
                    Contains("no port of 192.0.2.1 for frames"));
  try {
    const GigeScanner second(GigeLinkTo("127.0.0.1"), [] { return RigidTransform::Identity(); });
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("control of it; another program has it"));
  }
  CheckSamePoints(TakeScan(rig), rig.device.sees, kMillimetreRounding);  // The first one goes on.
}

TEST_CASE("Driver and emulated GigE Vision scanner can end while a scan runs", "[contract]") {
  GigeRig rig;
  rig.device.takes = FromSeconds(1e6);
  REQUIRE(rig.driver->Trigger().accepted());
  StepUntil(rig, [&rig] { return rig.emulator->triggers() == 1; });
}

}  // namespace
}  // namespace tubetwin

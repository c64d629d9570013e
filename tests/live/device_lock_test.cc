#include "hw_bridge/drivers/device_lock.h"

#include <sys/wait.h>
#include <unistd.h>

#include "hw_bridge/drivers/ati/netft_driver.h"
#include "hw_bridge/drivers/photoneo/photoneo_driver.h"
#include "hw_bridge/drivers/robotiq/robotiq_driver.h"
#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

const std::string kWrist = "wrist 192.0.2.1:49152";

std::string WhyNot(const std::string& device) {
  try {
    const DeviceLock lock(device);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kInterrupted);
    return error.what();
  }
  return "";
}

TEST_CASE("A device has one owner at a time, who is named", "[unit]") {
  CHECK(DeviceLock::HolderOf(kWrist).empty());
  {
    const DeviceLock lock(kWrist);
    const std::string here = "process " + std::to_string(::getpid()) + " (live_tests";
    CHECK_THAT(DeviceLock::HolderOf(kWrist), Contains(here));
    for (int i = 0; i < 300; ++i) {  // Whoever was refused leaves nothing behind.
      CHECK_THAT(WhyNot(kWrist), Contains(kWrist + ": is in use by " + here));
    }
    CHECK(WhyNot("wrist 192.0.2.1:49153").empty());
    CHECK(WhyNot("gripper 192.0.2.1:49152").empty());
  }
  CHECK(WhyNot(kWrist).empty());
}

TEST_CASE("A lock is handed on, and ends with the process that has it, however that ends",
          "[unit]") {
  {
    DeviceLock first(kWrist);
    const DeviceLock second(std::move(first));
    CHECK_FALSE(WhyNot(kWrist).empty());
  }
  int ready[2];
  REQUIRE(::pipe(ready) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const DeviceLock lock(kWrist);
    if (::write(ready[1], "x", 1) != 1) ::_exit(1);
    ::pause();
    ::_exit(0);
  }
  char byte = 0;
  REQUIRE(::read(ready[0], &byte, 1) == 1);
  CHECK_THAT(WhyNot(kWrist), Contains("process " + std::to_string(child) + " ("));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  CHECK(WhyNot(kWrist).empty());
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST_CASE("What of a device has one owner is its address, of a serial line the line", "[unit]") {
  RobotiqDriver gripper;
  gripper.config.host = "192.0.2.7";
  gripper.config.device = "/dev/../dev/null";
  CHECK(gripper.Owned("modbus_tcp") == "192.0.2.7:1502");
  CHECK(gripper.Owned("modbus_rtu") == "/dev/null");
  NetftDriver wrist;
  wrist.config.host = "192.0.2.8";
  CHECK(wrist.Owned("rdt") == "192.0.2.8:49152");
  PhotoneoDriver scanner;
  scanner.config.path = "/tmp/./scans";
  CHECK(scanner.Owned("folder") == "/tmp/scans");
  scanner.config.host = "192.0.2.9";
  CHECK(scanner.Owned("gige") == "192.0.2.9");
}

}  // namespace
}  // namespace tubetwin

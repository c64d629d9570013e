#include "hw_bridge/drivers/yaskawa/hses_client.h"

#include <algorithm>
#include <chrono>

#include "models/base/error.h"
#include "tests/drivers/arm_bench.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

using Catch::Matchers::Contains;

HsesConfig To(const ServedArm& served) {
  HsesConfig config;
  config.port = served.hses_port();
  return config;
}

template <typename T>
T Got(const HsesResult<T>& result) {
  if (const auto* problem = std::get_if<HsesProblem>(&result)) FAIL(problem->reason);
  return std::get<T>(result);
}

template <typename T>
HsesProblem Not(const HsesResult<T>& result) {
  REQUIRE(std::holds_alternative<HsesProblem>(result));
  return std::get<HsesProblem>(result);
}

TEST_CASE("Status, alarms, jobs and positions are read beside the motion ports", "[unit]") {
  ArmBench bench;
  HsesClient client(To(bench.served));
  hses::Status status = Got(client.ReadStatus());
  CHECK((status.data1 & hses::Status::kPlay) != 0);
  CHECK((status.data1 & hses::Status::kRunning) != 0);
  CHECK((status.data2 & hses::Status::kServoOn) != 0);
  CHECK((status.data2 & hses::Status::kAlarm) == 0);
  CHECK(Got(client.ReadAlarm()).code == 0);
  CHECK(Got(client.ReadJob()).name == "INIT_ROS");
  // Half a pulse.
  CHECK((Got(client.ReadJoints()) - bench.State().q).cwiseAbs().maxCoeff() < Radians(0.00051));
  const hses::Position flange = Got(client.ReadPosition(hses::kCartesian));
  const Vector3 p_BF =
      FlangePose(PaperCell().arm, bench.State().q).translation() - Vector3(0, 0, 0.275);
  for (int i = 0; i < 3; ++i) CHECK(1e-6 * flange.axes[i] == Approx(p_BF[i]).margin(2e-6));
  CHECK_THAT(Not(client.ReadPosition(77)).reason, Contains("arm supervision 127.0.0.1:"));
  CHECK(Not(client.ReadPosition(77)).added_status == hses::kNoInstance);

  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.Alarm(4107); });
  status = Got(client.ReadStatus());
  CHECK((status.data2 & hses::Status::kAlarm) != 0);
  CHECK((status.data2 & hses::Status::kServoOn) == 0);
  CHECK(Got(client.ReadAlarm()).code == 4107);
  Got(client.ResetAlarm());
  CHECK(Got(client.ReadAlarm()).code == 0);
}

TEST_CASE("Variables keep what is written, each of its kind", "[unit]") {
  ServedArm served;
  HsesClient client(To(served));
  const std::pair<std::uint16_t, hses::Value> values[] = {
      {hses::kVariableB, std::uint8_t{200}},      {hses::kVariableI, std::int16_t{-12345}},
      {hses::kVariableD, std::int32_t{-7654321}}, {hses::kVariableR, 2.5f},
      {hses::kRegister, std::uint16_t{65000}},
  };
  for (const auto& [command, value] : values) {
    CAPTURE(command);
    Got(client.WriteValue(command, 7, value));
    CHECK(Got(client.ReadValue(command, 7)) == value);
    CHECK(Got(client.ReadValue(command, 8)) != value);
  }
  served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.SetRemote(false); });
  const HsesProblem refused = Not(client.WriteValue(hses::kVariableB, 7, std::uint8_t{1}));
  CHECK(refused.added_status == hses::kNotRemote);
  CHECK_FALSE(refused.silent);
  CHECK(Got(client.ReadValue(hses::kVariableB, 7)) == hses::Value(std::uint8_t{200}));
}

TEST_CASE("A hold by supervision ends a motion", "[unit]") {
  ArmBench bench;
  HsesClient client(To(bench.served));
  bench.MoveOn();
  Got(client.SetHold(true));
  CHECK(bench.Await(ArmMode::kIdle));
  CHECK(bench.Stands());
  CHECK((Got(client.ReadStatus()).data2 & hses::Status::kCommandHold) != 0);
  CHECK(Not(client.StartJob()).added_status == hses::kHeldByCommand);
  Got(client.SetHold(false));
  Got(client.StartJob());
  Got(client.SetServo(false));
  CHECK(Not(client.StartJob()).added_status == hses::kServoOff);
}

TEST_CASE("A question without an answer is asked again, and in the end given up", "[unit]") {
  ServedArm served;
  HsesConfig config = To(served);
  config.answer_s = 0.05;
  config.tries = 20;
  HsesClient client(config);
  served.With([](ArmEmulator& e, FakeServoArm&) { e.hses_link().drop = true; });
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    served.With([](ArmEmulator& e, FakeServoArm&) { e.hses_link().drop = false; });
  });
  const HsesResult<hses::Status> status = client.ReadStatus();
  later.join();
  Got(status);

  config.tries = 2;
  HsesClient hasty(config);
  served.With([](ArmEmulator& e, FakeServoArm&) { e.hses_link().freeze = true; });
  const HsesProblem problem = Not(hasty.ReadStatus());
  CHECK(problem.silent);
  CHECK_THAT(problem.reason, Contains("no answer in 2 tries"));
}

TEST_CASE("Late and repeated answers are not taken for those to another question", "[unit]") {
  ServedArm served;
  HsesClient client(To(served));
  served.With([](ArmEmulator& e, FakeServoArm&) { e.hses_link().duplicate = true; });
  for (int i = 0; i < 50; ++i) {
    Got(client.WriteValue(hses::kVariableI, 1, static_cast<std::int16_t>(i)));
    CHECK(Got(client.ReadValue(hses::kVariableI, 1)) == hses::Value(static_cast<std::int16_t>(i)));
  }
  CHECK(client.ignored() > 0);
  // Where nobody listens, nobody answers.
  HsesConfig nobody = To(served);
  {
    asio::io_context io;
    const asio::ip::udp::socket closed(io, {asio::ip::make_address("127.0.0.1"), 0});
    nobody.port = closed.local_endpoint().port();
  }
  nobody.answer_s = 0.02;
  HsesClient alone(nobody);
  CHECK(Not(alone.ReadStatus()).silent);
}

}  // namespace
}  // namespace tubetwin::test

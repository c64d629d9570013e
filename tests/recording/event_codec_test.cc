#include "hw_bridge/recording/event_codec.h"

#include <vector>

#include "hw_bridge/recording/cloud_packing.h"
#include "tests/recording/random_events.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using test::Bits;

std::vector<CellEvent> Decoded(const std::string& bytes, TimeNs now = TimeNs(0)) {
  std::vector<CellEvent> events;
  EventDecoder decoder(bytes, now, "test");
  while (auto event = decoder.Next()) events.push_back(std::move(*event));
  return events;
}

TEST_CASE("Any events come back bit by bit, also from where the encoder was reset", "[unit]") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4, 5, 6, 7, 8);
  RandomStream stream(seed, 0, "events");
  CAPTURE(seed);
  EventEncoder encoder;
  for (int block = 0; block < 4; ++block) {
    encoder.Reset();
    const TimeNs now = encoder.now();
    std::string bytes;
    std::vector<CellEvent> events;
    for (int i = 0; i < 300; ++i) {
      events.push_back(test::RandomEvent(stream));
      // Devices often say the same again.
      if (stream.Index(3) == 0) events.push_back(events.back());
    }
    for (const CellEvent& event : events) encoder.Encode(event, bytes);
    const std::vector<CellEvent> back = Decoded(bytes, now);
    REQUIRE(back.size() == events.size());
    for (std::size_t i = 0; i < back.size(); ++i) {
      CAPTURE(i, events[i].index());
      REQUIRE(Bits(back[i]) == Bits(events[i]));
    }
  }
}

TEST_CASE("A state that did not change takes two bytes, a control period one", "[unit]") {
  EventEncoder encoder;
  std::string bytes;
  ArmState arm;
  arm.q[2] = 1.23456;
  arm.fault = "blocked";
  arm.time = kControlPeriod;
  WrenchSample sample;
  sample.wrench_K.force_N.x() = 0.3;
  sample.time = kControlPeriod;
  GripperState gripper;
  gripper.opening_m = 0.04;
  gripper.time = kControlPeriod;
  encoder.Encode(TimeAdvanced{kControlPeriod, kControlPeriod}, bytes);
  CHECK(bytes.size() == 1);
  const auto size_of = [&](const CellEvent& event) {
    const std::size_t before = bytes.size();
    encoder.Encode(event, bytes);
    return bytes.size() - before;
  };
  CHECK(size_of(ArmRead{arm}) > 2);
  CHECK(size_of(ArmRead{arm}) == 2);
  CHECK(size_of(WristRead{sample}) > 2);
  CHECK(size_of(WristRead{sample}) == 2);
  CHECK(size_of(GripperRead{gripper}) > 2);
  CHECK(size_of(GripperRead{gripper}) == 2);
  // Standing still while time goes on.
  CHECK(size_of(TimeAdvanced{2 * kControlPeriod, 2 * kControlPeriod}) == 1);
  arm.time = 2 * kControlPeriod;
  CHECK(size_of(ArmRead{arm}) == 2);
  // A sample that is older than now.
  CHECK(size_of(WristRead{sample}) == 2);
  CHECK(size_of(TimeRead{2 * kControlPeriod}) == 2);
}

TEST_CASE("Bytes that are no events are refused with their place or read as some, never more",
          "[unit]") {
  RandomStream stream(11, 0, "garbage");
  EventEncoder encoder;
  std::string good;
  for (int i = 0; i < 200; ++i) encoder.Encode(test::RandomEvent(stream), good);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string bytes = good.substr(0, 1 + stream.Index(static_cast<std::uint32_t>(good.size())));
    for (std::uint32_t k = 1 + stream.Index(4); k > 0; --k) {
      bytes[stream.Index(static_cast<std::uint32_t>(bytes.size()))] =
          static_cast<char>(stream.Index(256));
    }
    try {
      Decoded(bytes);
    } catch (const Error& e) {
      REQUIRE(e.kind() == ErrorKind::kBadData);
      REQUIRE_THAT(e.what(), Catch::StartsWith("test: byte "));
      ++refused;
    }
  }
  CHECK(refused > 1000);
}

TEST_CASE("Clouds come back bit by bit: of a camera, of any numbers, unorganised, empty",
          "[unit]") {
  RandomStream stream(3, 0, "clouds");
  std::vector<OrganizedCloud> clouds;
  for (const auto& [width, height] : {std::pair{64, 48}, {1, 1}, {1, 50}, {500, 1}, {0, 0}}) {
    clouds.push_back(test::RandomCloud(stream, width, height, true));
    clouds.push_back(test::RandomCloud(stream, width, height, false));
  }
  clouds.push_back(clouds.front());
  clouds.back().intensity.clear();
  for (Eigen::Vector3f& p : clouds.back().p_SP) p = InvalidPoint();
  clouds.push_back(clouds.front());
  clouds.back().p_SP[0] = Eigen::Vector3f(-0.0f, std::numeric_limits<float>::infinity(), 1e-40f);
  clouds.back().p_SP[1] = Eigen::Vector3f(1.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f);
  for (const OrganizedCloud& cloud : clouds) {
    CAPTURE(cloud.width, cloud.height);
    const OrganizedCloud back = UnpackCloud(PackCloud(cloud), "test");
    CHECK(Bits(back) == Bits(cloud));
  }
}

TEST_CASE("Bytes that are no cloud are refused with their place", "[unit]") {
  RandomStream stream(5, 0, "no clouds");
  const std::string good = PackCloud(test::RandomCloud(stream, 20, 10, false));
  for (std::size_t size = 0; size < good.size(); ++size) {
    CHECK_THROWS_AS(UnpackCloud(good.substr(0, size), "test"), Error);
  }
  CHECK_THROWS_WITH(UnpackCloud(good + "x", "test"),
                    Catch::Contains("bytes after the cloud's end"));
  std::string large = good;
  large[3] = 0x7f;
  CHECK_THROWS_WITH(UnpackCloud(large, "test"), Catch::Contains("at most 16777216 are allowed"));
}

}  // namespace
}  // namespace tubetwin

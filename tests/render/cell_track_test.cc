#include "twin/render/cell_track.h"

#include "models/base/error.h"
#include "tests/report/report_fixture.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr double kSingle_m = 1e-6;  // Recordings hold single precision.

const CellTrack::Body& BodyOf(const CellTrack& track, const std::string& name) {
  for (const CellTrack::Body& body : track.bodies) {
    if (body.name == name) return body;
  }
  FAIL("no body " << name);
  throw 0;
}

}  // namespace

TEST_CASE("A track has a key where a body moved and one for all that rest") {
  const Recording recording = SmallRecording(1);  // 60 frames: 30 down, 30 up, 1 cm per frame.
  const CellTrack track = TrackOf(recording, 0, 60, 4);
  CHECK(track.samples == 15);
  CHECK(track.sample_s == Approx(4.0 / 30.0));
  CHECK(track.p_BPs.size() == 15);
  CHECK(BodyOf(track, "world").keys.size() == 1);
  CHECK(BodyOf(track, "arm_base").keys.size() == 1);
  CHECK(BodyOf(track, "tube1").keys.size() == 1);
  const std::vector<CellTrack::Key>& tool = BodyOf(track, "tool").keys;
  REQUIRE(tool.size() == 15);
  for (int i = 0; i < 15; ++i) {
    const double z_m = 0.4 - 0.01 * std::min(4 * i, 60 - 4 * i);
    CHECK(tool[i].sample == i);
    CHECK((tool[i].X_BBody.translation() - Vector3(0.6, 0, z_m)).norm() < kSingle_m);
    CHECK((track.p_BPs[i] - Vector3(0.6, 0, z_m)).norm() < kSingle_m);
  }
}

TEST_CASE("A rest ends with a key, so that it stays a rest when poses are interpolated") {
  Recording recording = SmallRecording(1);
  for (int i = 0; i < 60; ++i) recording.frames[i].qpos = {i < 40 ? 0.0f : -0.1f};
  const CellTrack track = TrackOf(recording, 0, 60, 1);
  const std::vector<CellTrack::Key>& tool = BodyOf(track, "tool").keys;
  REQUIRE(tool.size() == 3);
  CHECK(tool[0].sample == 0);
  CHECK(tool[1].sample == 39);
  CHECK(tool[1].X_BBody.translation() == tool[0].X_BBody.translation());
  CHECK(tool[2].sample == 40);
}

TEST_CASE("A tube's centerline runs through its capsules in their order") {
  const CellTrack track = TrackOf(SmallRecording(1), 0, 60, 10);
  const std::vector<Polyline> tubes_B = TubesAt(track, 5);
  REQUIRE(tubes_B.size() == 1);
  REQUIRE(tubes_B[0].size() == 3);
  const double x_m[] = {0.5, 0.65, 0.8};  // g1 stands before g0 in the cell.
  for (int i = 0; i < 3; ++i) {
    CHECK((tubes_B[0][i] - Vector3(x_m[i], 0, 0.1125)).norm() < kSingle_m);
  }
}

TEST_CASE("Frames that do not fit the cell are refused") {
  Recording recording = SmallRecording(1);
  recording.frames[30].qpos = {0.0f, 0.0f};
  CHECK_THROWS_WITH(TrackOf(recording, 0, 60, 1),
                    Catch::Contains("frame 30 has 2 coordinates, its cell has 1"));
  recording.cell_xml = "<mujoco>";
  CHECK_THROWS_AS(TrackOf(recording, 0, 60, 1), Error);
}

}  // namespace tubetwin

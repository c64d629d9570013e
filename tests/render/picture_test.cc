#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <unistd.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "scenes/engine/engine_error.h"
#include "tests/support/catch.h"
#include "tests/support/refused.h"
#include "tests/support/tube_mesh.h"
#include "twin/render/film_panels.h"
#include "twin/render/picture.h"
#include "twin/render/pile_picture.h"
#include "twin/render/recording.h"
#include "twin/render/stage.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("tubetwin_picture_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string File(const std::string& name) const { return (path / name).string(); }
};

/// A cell of one box on a slide over a floor; coordinate 0 is the box's x.
Recording SmallRecording(int frames) {
  Recording recording;
  recording.cell_xml =
      "<mujoco><worldbody>"
      "<geom name='bin_floor' type='box' size='0.4 0.3 0.01' pos='0.6 0 0.09'/>"
      "<body pos='0.6 0 0.3'><joint type='slide' axis='0 1 0'/>"
      "<geom type='sphere' size='0.06' rgba='1 0 0 1' mass='1'/></body>"
      "</worldbody></mujoco>";
  recording.captions = {"approach", "lift"};
  Recording::Overlay overlay;
  overlay.lines_N = {{{-0.2, 0.1, 0.02}, {0.2, 0.1, 0.02}},
                     {{-0.2, -0.1, 0.02}, {0.2, -0.1, 0.02}}};
  overlay.classes = {0, 2};
  overlay.target = 1;
  overlay.cloud_N = {{0.1, -0.25, 0.0375}};
  recording.overlays = {overlay};
  for (int i = 0; i < frames; ++i) {
    Recording::Frame frame;
    frame.qpos = {0.02f * static_cast<float>(i)};
    frame.force_N = 0.1f * static_cast<float>(i);
    frame.overlay = i < 2 ? -1 : 0;
    frame.caption = i % 2;
    recording.frames.push_back(frame);
  }
  recording.attempt_ends = {frames / 2, frames};
  return recording;
}

TEST_CASE("A recording reads back as it was written", "[unit]") {
  const Folder folder;
  const Recording recording = SmallRecording(40);
  WriteRecording(recording, folder.File("a.rec"));
  const Recording back = ReadRecording(folder.File("a.rec"));
  CHECK(back.cell_xml == recording.cell_xml);
  CHECK(back.bin.size_m == recording.bin.size_m);
  CHECK(back.captions == recording.captions);
  REQUIRE(back.overlays.size() == 1);
  CHECK(back.overlays[0].lines_N == recording.overlays[0].lines_N);
  CHECK(back.overlays[0].classes == recording.overlays[0].classes);
  REQUIRE(back.overlays[0].cloud_N.size() == 1);
  constexpr double kHalfStep_m = 0.5e-4;  // The file has 0.1 mm.
  CHECK((back.overlays[0].cloud_N[0] - recording.overlays[0].cloud_N[0]).norm() <
        std::sqrt(3.0) * kHalfStep_m);
  CHECK(back.attempt_ends == recording.attempt_ends);
  CHECK(back.overlays[0].target == 1);
  REQUIRE(back.frames.size() == 40);
  for (std::size_t i = 0; i < 40; ++i) {
    CHECK(back.frames[i].qpos == recording.frames[i].qpos);
    CHECK(back.frames[i].force_N == recording.frames[i].force_N);
    CHECK(back.frames[i].overlay == recording.frames[i].overlay);
    CHECK(back.frames[i].caption == recording.frames[i].caption);
  }
}

TEST_CASE("A recording that is cut, altered or none at all is bad data", "[unit]") {
  const Folder folder;
  WriteRecording(SmallRecording(40), folder.File("a.rec"));
  const std::string whole = ReadFile(folder.File("a.rec"));
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{10}}) {
    WriteFileAtomically(folder.File("cut.rec"), whole.substr(0, size));
    const Error error = Refused([&] { ReadRecording(folder.File("cut.rec")); });
    CHECK(error.kind() == ErrorKind::kBadData);
    CHECK_THAT(error.what(), Contains("cut.rec: byte " + std::to_string(size)));
  }
  std::string altered = whole;
  altered[altered.size() / 2] ^= 0x10;
  WriteFileAtomically(folder.File("altered.rec"), altered);
  CHECK(Refused([&] { ReadRecording(folder.File("altered.rec")); }).kind() == ErrorKind::kBadData);
  for (const std::string& text : {std::string(), std::string("{}\n"), std::string(100, 'x')}) {
    WriteFileAtomically(folder.File("text.rec"), text);
    CHECK(Refused([&] { ReadRecording(folder.File("text.rec")); }).kind() == ErrorKind::kBadData);
  }
  CHECK(Refused([&] { ReadRecording(folder.File("none.rec")); }).kind() == ErrorKind::kMissing);
}

TEST_CASE("A frame that points at no overlay is bad data", "[unit]") {
  const Folder folder;
  Recording recording = SmallRecording(3);
  recording.frames[1].overlay = 7;
  WriteRecording(recording, folder.File("a.rec"));
  const Error error = Refused([&] { ReadRecording(folder.File("a.rec")); });
  CHECK(error.kind() == ErrorKind::kBadData);
  CHECK_THAT(error.what(), Contains("frame 1: overlay is 7, allowed are -1 to 0"));
}

TEST_CASE("A film has one picture per frame, 1280 x 720 at 30 per second, and is repeatable",
          "[render]") {
  const Folder folder;
  const Recording recording = SmallRecording(10);
  RenderFilm(recording, folder.File("one.mp4"), 1, {1});
  RenderFilm(recording, folder.File("two.mp4"), 1, {2});
  CHECK((ReadFile(folder.File("one.mp4")) == ReadFile(folder.File("two.mp4"))));
  cv::VideoCapture film(folder.File("one.mp4"), cv::CAP_FFMPEG);
  REQUIRE(film.isOpened());
  CHECK(film.get(cv::CAP_PROP_FPS) == Approx(30.0));
  CHECK(static_cast<int>(film.get(cv::CAP_PROP_FOURCC)) ==
        cv::VideoWriter::fourcc('a', 'v', 'c', '1'));
  std::vector<cv::Point> red;  // Centre of the moving box in every picture.
  for (cv::Mat picture; film.read(picture);) {
    REQUIRE(picture.cols == 1280);
    REQUIRE(picture.rows == 720);
    cv::Point sum(0, 0);
    int n = 0;
    for (int y = 60; y < 480; ++y) {  // Between the panels.
      for (int x = 0; x < 1280; ++x) {
        const cv::Vec3b& p = picture.at<cv::Vec3b>(y, x);
        if (p[2] < 120 || p[1] > 60 || p[0] > 60) continue;
        sum += cv::Point(x, y);
        ++n;
      }
    }
    REQUIRE(n > 300);
    red.emplace_back(sum.x / n, sum.y / n);
  }
  REQUIRE(red.size() == 10);
  // In the order of the frames: the ball rolls to B's +y, which is right and away of this camera.
  for (std::size_t i = 1; i < red.size(); ++i) CHECK(red[i].x > red[i - 1].x);
  RenderFilm(recording, folder.File("fast.mp4"), 3, {2});
  CHECK(cv::VideoCapture(folder.File("fast.mp4")).get(cv::CAP_PROP_FRAME_COUNT) == 4);
}

TEST_CASE("While the cell stands still the film goes on: every frame, clock and caption",
          "[render]") {
  const Folder folder;
  Recording recording = SmallRecording(40);
  for (Recording::Frame& frame : recording.frames) frame.qpos = {0.1f};
  recording.frames.back().qpos = {0.2f};
  RenderFilm(recording, folder.File("still.mp4"), 1, {2});
  cv::VideoCapture film(folder.File("still.mp4"), cv::CAP_FFMPEG);
  std::vector<cv::Mat> pictures;
  for (cv::Mat picture; film.read(picture);) pictures.push_back(picture.clone());
  REQUIRE(pictures.size() == 40);
  auto difference = [&](int a, int b, const cv::Rect& where) {
    double sum = 0;
    for (int y = where.y; y < where.y + where.height; ++y) {
      for (int x = where.x; x < where.x + where.width; ++x) {
        sum += std::abs(pictures[a].at<cv::Vec3b>(y, x)[1] - pictures[b].at<cv::Vec3b>(y, x)[1]);
      }
    }
    return sum / where.area();
  };
  const cv::Rect scene(300, 60, 700, 440), clock(1150, 10, 110, 30), caption(20, 10, 140, 30);
  constexpr double kCodecNoise = 1.0;  // Grey values; H.264 does not repeat a still exactly.
  CHECK(difference(5, 38, scene) < kCodecNoise);
  CHECK(difference(5, 38, clock) > 5 * kCodecNoise);
  CHECK(difference(5, 38, caption) > 5 * kCodecNoise);
  CHECK(difference(38, 39, scene) > kCodecNoise / 4);  // The ball jumped: drawn anew.
}

TEST_CASE("A mesh is drawn in the place of the plain shapes that it replaces", "[render]") {
  const Folder folder;
  Recording recording = SmallRecording(1);
  const auto drawn = [&](const std::string& name) {
    WriteRecording(recording, folder.File("a.rec"));
    RenderPicture(ReadRecording(folder.File("a.rec")), 0, folder.File(name));
    return cv::imread(folder.File(name));
  };
  const cv::Mat plain = drawn("plain.png");
  // The same floor as a mesh, painted as the bin; then a bin in its place.
  recording.visuals = {{"world", {"bin_floor"}, MakeBoxMesh({0.6, 0, 0.09}, {0.4, 0.3, 0.01})}};
  const cv::Mat same = drawn("same.png");
  recording.visuals[0].mesh = MakeBinMesh({0.8, 0.6, 0.3}, 0.02);
  for (Vector3& v : recording.visuals[0].mesh.vertices) v += Vector3(0.6, 0, 0.09);
  const cv::Mat bin = drawn("bin.png");
  const auto differing = [](const cv::Mat& a, const cv::Mat& b) {
    int count = 0;
    for (int i = 0; i < a.rows; ++i) {
      for (int k = 0; k < a.cols; ++k) {
        count += cv::norm(a.at<cv::Vec3b>(i, k) - b.at<cv::Vec3b>(i, k)) > 40;
      }
    }
    return count;
  };
  const int floor = differing(plain, same);
  CHECK(floor > 10'000);  // It has another colour.
  CHECK(floor < 200'000);
  CHECK(differing(same, bin) > 10'000);  // The walls.
  recording.visuals[0].body = "arm_link9";
  CHECK_THROWS_WITH(RenderPicture(recording, 0, folder.File("a.png")), Contains("arm_link9"));
}

TEST_CASE("A film of nothing or of the wrong cell is refused and leaves no file", "[render]") {
  const Folder folder;
  Recording recording = SmallRecording(2);
  recording.frames[0].qpos.push_back(1.0f);
  CHECK_THROWS_WITH(RenderFilm(recording, folder.File("a.mp4"), 1, {1}),
                    Contains("frames have 2 coordinates, its cell has 1"));
  recording.cell_xml = "<mujoco><worldbody><geom/></worldbody>";
  CHECK_THROWS_WITH(RenderFilm(recording, folder.File("a.mp4"), 1, {1}),
                    Contains("does not parse"));
  recording.frames.clear();
  CHECK_THROWS_WITH(RenderFilm(recording, folder.File("a.mp4"), 1, {1}), Contains("no frames"));
  CHECK(fs::is_empty(folder.path));
}

TEST_CASE("A perceived line is drawn where the camera projects it, in its class's colour",
          "[render]") {
  const Folder folder;
  const Recording recording = SmallRecording(3);
  RenderPicture(recording, 2, folder.File("a.png"));
  const cv::Mat picture = cv::imread(folder.File("a.png"));
  REQUIRE(picture.cols == 1280);
  const Vector3 p_NP(0.1, 0.1, 0.02);  // On line 0, free.
  const auto at = Project(CellView(), 1280, 720, recording.bin.X_BN * p_NP);
  REQUIRE(at);
  const auto p = picture.at<cv::Vec3b>(static_cast<int>(at->y()), static_cast<int>(at->x()));
  CHECK(p[1] > 140);  // Green wins.
  CHECK(p[1] > p[0] + 60);
  CHECK(p[1] > p[2] + 60);
  CHECK_THROWS_WITH(RenderPicture(recording, 3, folder.File("b.png")),
                    Contains("no frame 3, allowed are 0 to 2"));
}

Pile TwoTubes() {
  Pile pile;
  pile.tubes.push_back({4, {{-0.3, 0.1, 0.0125}, {0.1, 0.1, 0.0125}}, 0.0125, 0.055, {}});
  pile.tubes.push_back({9, {{-0.2, -0.1, 0.0125}, {0.3, -0.1, 0.0125}}, 0.0125, 0.055, {}});
  return pile;
}

TEST_CASE("A pile's picture shows every tube in its colour where it lies", "[render]") {
  const Folder folder;
  const Pile pile = TwoTubes();
  RenderPilePicture(pile, folder.File("pile.png"));
  const cv::Mat picture = cv::imread(folder.File("pile.png"));
  REQUIRE(picture.cols == 1280);
  REQUIRE(picture.rows == 720);
  for (int i = 0; i < 2; ++i) {
    const Vector3 top_N = PointAt(pile.tubes[i].centerline_N, 0.3) + Vector3(0, 0, 0.0125);
    const auto at = Project(PileView(pile.bin), 1280, 720, pile.bin.X_BN * top_N);
    REQUIRE(at);
    const auto p = picture.at<cv::Vec3b>(static_cast<int>(at->y()), static_cast<int>(at->x()));
    const auto colour = PileColour(i);
    // Light changes brightness, not hue: compare shares of the strongest channel.
    const double strongest = std::max({p[0], p[1], p[2]});
    const double expected = std::max({colour[0], colour[1], colour[2]});
    REQUIRE(strongest > 100);
    constexpr double kHueTolerance = 0.15;
    for (int k = 0; k < 3; ++k) {
      CHECK(p[2 - k] / strongest == Approx(colour[k] / expected).margin(kHueTolerance));
    }
  }
  CHECK(TakeEngineWarnings().empty());
}

// Hidden: run by the next test in a process of its own, whose EGL loader finds no driver.
TEST_CASE("The loader has no EGL driver", "[.no_egl]") {
  const Folder folder;
  try {
    RenderPilePicture(TwoTubes(), folder.File("pile.png"));
    FAIL("a picture was drawn");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri"));
  }
  CHECK_FALSE(fs::exists(folder.File("pile.png")));
}

TEST_CASE("Without EGL a picture fails with the packages' names", "[render]") {
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  const std::string command = "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json '" + self +
                              "' '[.no_egl]' > /dev/null 2>&1";
  CHECK(std::system(command.c_str()) == 0);
}

}  // namespace
}  // namespace tubetwin

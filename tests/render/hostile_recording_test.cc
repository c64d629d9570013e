// recording.bin from whoever made it.

#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"
#include "twin/render/cell_track.h"
#include "twin/render/recording.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

Recording OneFrame() {
  Recording recording;
  recording.cell_xml =
      "<mujoco><worldbody><body><joint type='slide'/><geom type='sphere' size='0.06'/></body>"
      "</worldbody></mujoco>";
  recording.frames.resize(1);
  recording.frames[0].qpos = {0.02f};
  return recording;
}

/// Frames of one coordinate, without overlay and caption.
std::string Frames(int count) {
  std::string out;
  for (int i = 0; i < count; ++i) {
    out += std::string(4, '\0') + std::string(8, '\xff') + std::string(4, '\0');
  }
  return out;
}

/// A recording's file with another head, packed as the program packs them.
void WritePacked(const std::string& head, const std::string& frames, const std::string& path) {
  const std::string content = head + std::string(1, '\0') + frames;
  WriteFileAtomically(path, Compressed(content));
}

std::string HeadWith(const std::string& nq, const std::string& frames) {
  return R"({"schema": "tubetwin/recording/1", "frames_per_second": 30,
             "bin": {"size_m": [0.8, 0.6, 0.1]}, "nq": )" +
         nq + R"(, "frames": )" + frames +
         R"(, "captions": [], "overlays": [], "visuals": [], "cell_xml": "<mujoco/>"})";
}

TEST_CASE("A recording that would unpack without end is refused by its head", "[unit]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& nq, const std::string& frames,
                           const std::string& said) {
    WritePacked(HeadWith(nq, frames), Frames(4), (folder / "bomb.rec"));
    const Error error = Refused([&] { ReadRecording(folder / "bomb.rec"); });
    CHECK(error.kind() == ErrorKind::kBadData);
    CHECK_THAT(error.what(), Contains("bomb.rec: " + said));
  };
  refused("0", "340787200", "frames: is 340787200, allowed are 0 to 0");
  refused("7", "2592001", "frames: is 2592001, allowed are 0 to 2592000");
  refused("20001", "1", "nq: is 20001, allowed are 0 to 20000");
  refused("20000", "10000", "10000 frames of 20000 coordinates take more than the 536870912 bytes");
  refused("-1", "1", "nq: is -1");
  refused("1", "5", "ends before its last frame");
  refused("1", "3", "goes on after its last frame");
  WritePacked(std::string(100, ' '), "", (folder / "blank.rec"));
  CHECK_THAT(Refused([&] { ReadRecording(folder / "blank.rec"); }).what(),
             Contains("blank.rec: head: not valid"));
  std::string endless(std::size_t{80} << 20, ' ');
  WritePacked(endless, "", (folder / "endless.rec"));
  CHECK_THAT(Refused([&] { ReadRecording(folder / "endless.rec"); }).what(),
             Contains("endless.rec: the head is longer than 67108864 bytes"));
}

TEST_CASE("The cell of a recording opens no file and takes no memory without end", "[render]") {
  const TemporaryFolder folder;
  WriteFileAtomically((folder / "inner.xml"), "<mujoco/>");
  Recording recording = OneFrame();
  recording.source = "r.bin";
  const std::string cell = recording.cell_xml;
  const auto said_of = [&](const std::string& xml) -> std::string {
    recording.cell_xml = xml;
    try {
      TrackOf(recording, 0, 1, 1);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::kBadData);
      return error.what();
    }
    return "";
  };
  CHECK(said_of(cell) == "");
  CHECK_THAT(said_of("<mujoco><geom "), Contains("ends inside of an element"));
  const std::string deep = [] {
    std::string out;
    for (int i = 0; i < 100000; ++i) out += "<body>";
    return out;
  }();
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<include file='" + (folder / "inner.xml") + "'/>", "element 'include'"},
      {"<asset><mesh name='m' file='/etc/passwd'/></asset>", "element 'asset'"},
      {"<asset><hfield name='h' nrow='100000' ncol='100000' size='1 1 1 1'/></asset>", "'asset'"},
      {"<extension><plugin plugin='x'/></extension>", "element 'extension'"},
      {"<worldbody><composite count='100 100 100'/></worldbody>", "element 'composite'"},
      {"<worldbody><replicate count='100000'/></worldbody>", "element 'replicate'"},
      {"<worldbody><geom file='/etc/passwd' size='1'/></worldbody>", "attribute 'file' of 'geom'"},
      {"<compiler meshdir='/'/>", "attribute 'meshdir' of 'compiler' names files"},
      {"<size memory='100G'/>", "attribute 'memory' of 'size' is 100G; allowed: up to 536870912"},
      {"<size nkey='2000000000'/>", "attribute 'nkey' of 'size' is 2000000000"},
      {"<size nuserdata='2000000000'/>", "attribute 'nuserdata' of 'size'; allowed"},
      {"<visual><global offwidth='100000'/></visual>", "attribute 'offwidth' of 'global'"},
      {"<!DOCTYPE x [<!ENTITY a 'b'>]>", "element '!DOCTYPE'"},
      {"<worldbody>" + deep, "elements nest more than 64 deep"},
      {"<worldbody><geom size='0'/></worldbody>", "r.bin"},
      {"<worldbody><geom size=", "has no text"},
      {"<worldbody><geom size", "has no text"},
      {"<worldbody><geom ", "has no text"},
      {"<worldbody><geom pos='nan 0 0' size='1'/></worldbody>", ""}};
  for (const auto& [inside, said] : cases) {
    CAPTURE(inside.substr(0, 60));
    const std::string what = said_of("<mujoco>" + inside + "</mujoco>");
    CHECK_THAT(what, Catch::StartsWith("r.bin"));
    CHECK_THAT(what, Contains(said));
  }
}

}  // namespace
}  // namespace tubetwin

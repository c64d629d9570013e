#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "twin/app/common.h"
#include "twin/app/input/cloud_input.h"
#include "twin/app/input/file_advice.h"
#include "twin/render/perceived_picture.h"
#include "twin/render/picture_points.h"
#include "twin/render/pile_picture.h"
#include "twin/render/recording.h"

namespace tubetwin {
namespace {

struct RenderOptions {
  std::string file, part, bin, units;
  std::optional<int> frame, speed;
};

/// Lines that hatch the cells of a row that no view saw.
void HatchRow(const UnseenFloor& floor, int row, std::vector<Polyline>& lines_N) {
  const double x0 = -0.5 * floor.columns * floor.cell_x_m;
  const double y = (row + 0.5 - 0.5 * floor.rows) * floor.cell_y_m;
  for (int i = 0; i < floor.columns;) {
    int end = i;
    while (end < floor.columns &&
           floor.unseen[static_cast<std::size_t>(row) * floor.columns + end] != 0) {
      ++end;
    }
    if (end > i) {
      lines_N.push_back({{x0 + i * floor.cell_x_m, y, 0}, {x0 + end * floor.cell_x_m, y, 0}});
    }
    i = end + 1;
  }
}

/// Puts the size that --bin or a key asks for in place of another.
void AskedSize(const RenderOptions& given, const Common& common, Bin& bin) {
  RequireUsedKeys(common, {"bin.size_m", "bin.mesh", "bin.mesh_units"}, "of what was seen");
  const PileOverrides asked = GivenPile("", given.bin, LoadScenario({}, common), common);
  if (asked.bin_size_m) bin.size_m = *asked.bin_size_m;
}

void RenderTubes(const RenderOptions& given, const Json& json, const Common& common) {
  const JsonView document(json, given.file);
  const TubeScene scene = TubeSceneFromJson(document);
  PerceivedPicture picture;
  if (const auto bin = document.Optional("bin")) picture.bin = BinFromJson(*bin);
  AskedSize(given, common, picture.bin);
  for (const PerceivedTube& tube : scene.tubes) {
    picture.tubes.push_back({tube.id, tube.centerline_N, tube.node_visible, tube.radius_m,
                             static_cast<int>(tube.tube_class)});
  }
  picture.unexplained_N = scene.unexplained_N;
  for (int row = 0; row < scene.unseen_floor.rows; ++row) {
    HatchRow(scene.unseen_floor, row, picture.unseen_floor_N);
  }
  char unseen[64];
  std::snprintf(unseen, sizeof unseen, ", %.3f m2 of the floor and %.4f m3 unseen",
                scene.unseen_floor_m2, scene.unseen_m3);
  picture.caption = std::to_string(scene.tubes.size()) + " tubes, " +
                    std::to_string(scene.crossings.size()) + " crossings, " +
                    std::to_string(scene.unexplained_N.size()) + " unexplained points" + unseen;
  RenderPerceivedPicture(picture, common.out);
}

/// What one scan shows of the bin.
void RenderCloud(const RenderOptions& given, const Common& common) {
  const OrganizedCloud cloud = ReadCloud(given.file, MetresPer(given.units));
  if (cloud.X_NS.matrix() == RigidTransform::Identity().matrix()) {
    throw Error(ErrorKind::kBadData,
                given.file +
                    ": says no pose of the scanner, so the bin cannot be drawn around it"
                    "\n(tubetwin perceive FILE --part P --pose POSE --labelled F.pcd --out "
                    "tubes.json writes F.pcd with its pose)");
  }
  PerceivedPicture picture;
  AskedSize(given, common, picture.bin);
  const auto valid = std::count_if(cloud.p_SP.begin(), cloud.p_SP.end(),
                                   [](const Eigen::Vector3f& p) { return IsValid(p); });
  picture.cloud_N = DownsampleForPicture({cloud}, picture.bin);
  picture.caption = std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                    " points of a scan, " + std::to_string(valid) + " valid";
  RenderPerceivedPicture(picture, common.out);
}

/// Whether a file is a cloud by its ending, packed or not.
bool IsCloud(const std::string& name) {
  std::filesystem::path file(LowerCase(name));
  if (file.extension() == ".zst") file.replace_extension();
  return file.extension() == ".pcd" || file.extension() == ".ply";
}

/// Whether a JSON file is a tubes.json; other files are not read.
std::optional<Json> TubesJson(const std::string& file) {
  if (std::filesystem::path(file).extension() != ".json") return std::nullopt;
  Json json = ReadJsonFile(file);
  if (!json.is_object() || json.value("schema", Json()) != "tubetwin/tubes/1") return std::nullopt;
  return json;
}

/// What is drawn.
enum class Drawn { kPile, kTubes, kCloud, kRecording };

/// Refuses options that say nothing of what is drawn, or of the kind of file that is written.
void RefuseOptions(const RenderOptions& given, Drawn drawn, bool film) {
  const auto refuse = [&](bool wrong, const char* option, const char* what_for) {
    if (!wrong) return;
    throw Error(ErrorKind::kUsage, given.file + ": " + option + " is for " + what_for);
  };
  const bool recording = drawn == Drawn::kRecording;
  refuse(!given.units.empty() && drawn != Drawn::kCloud, "--units", "clouds (.pcd, .ply)");
  refuse(!given.part.empty() && drawn != Drawn::kPile, "--part", "piles");
  refuse(!given.bin.empty() && recording, "--bin", "piles, tubes.json and clouds");
  refuse(given.frame && !recording, "--frame", "recordings (recording.bin)");
  refuse(given.speed && !recording, "--speed", "recordings (recording.bin)");
  refuse(given.frame && film, "--frame", "pictures (--out F.png)");
  refuse(given.speed && !film, "--speed", "films (--out F.mp4)");
}

int Render(const RenderOptions& given, const Common& common) {
  const std::string ending = std::filesystem::path(common.out).extension().string();
  if (ending != ".png" && ending != ".mp4") {
    throw Error(ErrorKind::kUsage,
                "--out '" + common.out + "': a name ending in .png or .mp4 is needed");
  }
  const bool film = ending == ".mp4";
  const std::string kind = LowerCase(std::filesystem::path(given.file).extension().string());
  if (kind == ".json" || kind == ".csv" || kind == ".txt") {
    if (film) {
      throw Error(ErrorKind::kUsage,
                  given.file + ": a pile gives a picture; a film needs a recording");
    }
    const auto json = TubesJson(given.file);
    RefuseOptions(given, json ? Drawn::kTubes : Drawn::kPile, film);
    if (json) {
      RenderTubes(given, *json, common);
      return 0;
    }
    const Scenario scenario = LoadScenario({}, common);
    RenderPilePicture(LoadGivenPile(given.file, GivenPile(given.part, given.bin, scenario, common)),
                      common.out);
    return 0;
  }
  if (IsCloud(given.file)) {
    if (film) {
      throw Error(ErrorKind::kUsage,
                  given.file + ": a cloud gives a picture; a film needs a recording");
    }
    RefuseOptions(given, Drawn::kCloud, film);
    RenderCloud(given, common);
    return 0;
  }
  const std::string advice = AdviceFor(given.file);
  if (!advice.empty() && kind != ".bin") {
    throw Error(ErrorKind::kBadData,
                given.file + ": is no recording, pile, tubes.json or cloud" + advice);
  }
  RefuseOptions(given, Drawn::kRecording, film);
  RequireUsedKeys(common, {}, "of a recording");
  const Recording recording = ReadRecording(given.file);
  if (film) {
    RenderFilm(recording, common.out, given.speed.value_or(1), common.parallelism());
    return 0;
  }
  if (recording.frames.empty()) {
    throw Error(ErrorKind::kBadData, given.file + ": holds no frame; at least one is needed");
  }
  const int frame = given.frame.value_or(0);
  if (frame >= static_cast<int>(recording.frames.size())) {
    throw Error(ErrorKind::kUsage, "--frame " + std::to_string(frame) + ": " + given.file +
                                       " has frames 0 to " +
                                       std::to_string(recording.frames.size() - 1));
  }
  RenderPicture(recording, frame, common.out);
  return 0;
}

}  // namespace

void AddRenderVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<RenderOptions>();
  CLI::App* verb = app.add_subcommand(
      "render",
      "Example: tubetwin render out/first/recording.bin --out film.mp4\n\n"
      "Pictures and films of recordings, pictures of piles, of what was perceived and of scans (a "
      "kept failure's view_N.pcd.zst); no display is needed.");
  verb->add_option("file", given->file,
                   "recording.bin of a result folder, a pile, tubes.json, or a cloud")
      ->required();
  verb->add_option("--frame", given->frame, "Frame of the recording, for a picture")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--speed", given->speed, "Every N-th frame: N times as fast")
      ->check(CLI::Range(1, 100));
  verb->add_option("--part", given->part, "Part name or part file of a pile");
  AddUnitsOption(*verb, given->units);
  verb->add_option("--bin", given->bin, "Inner size of the bin: long,short,wall in metres");
  AddCommonOptions(*verb, common, PileKeysAnd({}), "Picture (.png) or film (.mp4)", true);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return Render(*given, common); }; });
}

}  // namespace tubetwin

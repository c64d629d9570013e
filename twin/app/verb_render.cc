#include <filesystem>

#include <CLI/CLI.hpp>

#include "hw_bridge/base/error.h"
#include "twin/app/common.h"
#include "twin/render/pile_picture.h"
#include "twin/render/recording.h"

namespace tubetwin {
namespace {

struct RenderOptions {
  std::string file, part, bin;
  int frame = 0, speed = 1;
};

int Render(const RenderOptions& given, const Common& common) {
  const std::string ending = std::filesystem::path(common.out).extension().string();
  if (ending != ".png" && ending != ".mp4") {
    throw Error(ErrorKind::kUsage,
                "--out '" + common.out + "': a name ending in .png or .mp4 is needed");
  }
  if (!std::filesystem::exists(given.file)) {
    throw Error(ErrorKind::kMissing, given.file + ": no such file");
  }
  const std::string kind = std::filesystem::path(given.file).extension().string();
  if (kind == ".json" || kind == ".csv" || kind == ".txt") {
    if (ending != ".png") {
      throw Error(ErrorKind::kUsage,
                  given.file + ": a pile gives a picture; a film needs a recording");
    }
    PileOverrides overrides;
    if (!given.part.empty()) overrides.part = given.part;
    if (!given.bin.empty()) overrides.bin_size_m = ParseBinSize(given.bin);
    RenderPilePicture(LoadPile(given.file, overrides), common.out);
    return 0;
  }
  const Recording recording = ReadRecording(given.file);
  if (ending == ".mp4") {
    RenderFilm(recording, common.out, given.speed, common.parallelism());
    return 0;
  }
  if (given.frame >= static_cast<int>(recording.frames.size())) {
    throw Error(ErrorKind::kUsage, "--frame " + std::to_string(given.frame) + ": " + given.file +
                                       " has frames 0 to " +
                                       std::to_string(recording.frames.size() - 1));
  }
  RenderPicture(recording, given.frame, common.out);
  return 0;
}

}  // namespace

void AddRenderVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<RenderOptions>();
  CLI::App* verb = app.add_subcommand(
      "render",
      "Example: tubetwin render out/first/recording.bin --out film.mp4\n\n"
      "Pictures and films of recordings, pictures of piles; no display is needed.");
  verb->add_option("file", given->file, "recording.bin of a result folder, or a pile")->required();
  verb->add_option("--frame", given->frame, "Frame of the recording, for a picture")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--speed", given->speed, "Every N-th frame: N times as fast")
      ->check(CLI::Range(1, 100));
  verb->add_option("--part", given->part, "Part name or part file of a pile");
  verb->add_option("--bin", given->bin, "Inner size of the bin: long,short,wall in metres");
  AddCommonOptions(*verb, common, "Picture (.png) or film (.mp4)", true);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return Render(*given, common); }; });
}

}  // namespace tubetwin

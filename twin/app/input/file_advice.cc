#include "twin/app/input/file_advice.h"

#include <filesystem>
#include <fstream>

#include "models/base/text.h"

namespace tubetwin {
namespace {

/// Whether a JSON file's beginning says that it holds perceived tubes.
bool HoldsPerceivedTubes(const std::string& file) {
  std::string head(4096, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find("tubetwin/tubes/") != std::string::npos;
}

}  // namespace

std::string AdviceFor(const std::string& file) {
  std::filesystem::path name(LowerCase(file));
  if (name.extension() == ".zst") name.replace_extension();
  const std::string ending = name.extension().string();
  if (ending == ".stl" || ending == ".obj" || ending == ".step" || ending == ".stp") {
    return "\n(a mesh of a tube becomes a part: tubetwin part import FILE --out P.toml)";
  }
  if (ending == ".pcd" || ending == ".ply") {
    return "\n(clouds are for: tubetwin perceive FILE... --part P --out tubes.json)";
  }
  if (ending == ".json" && HoldsPerceivedTubes(file)) {
    return "\n(perceived tubes are for: tubetwin plan FILE, tubetwin render FILE)";
  }
  if (ending == ".csv" || ending == ".txt" || ending == ".json") {
    return "\n(a pile is scanned first: tubetwin scan FILE --out DIR; its clouds are "
           "DIR/view_*.pcd)";
  }
  if (ending == ".toml") {
    return "\n(a part file is given by --part, a scenario to: tubetwin run FILE)";
  }
  if (ending == ".bin") return "\n(recordings are for: tubetwin render FILE, tubetwin replay FILE)";
  return "";
}

Pile LoadGivenPile(const std::string& file, const PileOverrides& overrides) {
  try {
    return LoadPile(file, overrides);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kBadData) throw;  // A pipe would never be read to its end.
    const std::string ending = LowerCase(std::filesystem::path(file).extension().string());
    const bool pile =
        ending == ".csv" || ending == ".txt" || (ending == ".json" && !HoldsPerceivedTubes(file));
    if (pile) throw;
    throw Error(error.kind(), error.what() + AdviceFor(file));
  }
}

}  // namespace tubetwin

#include "twin/app/input/file_advice.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "models/base/config/config.h"
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

/// A kind of TOML file by what stands at its top.
struct TomlKind {
  std::vector<UsedKeys> keys;  ///< It is one that has all keys of any of these.
  const char *name, *use;
  std::vector<std::string> asked_by;  ///< Verbs, options and keys that take one.
};

const std::vector<TomlKind>& TomlKinds() {
  static const std::vector<TomlKind> kinds = {
      {{{"variant"}, {"rounds"}}, "a campaign", "tubetwin campaign run FILE", {"campaign run"}},
      {{{"scan_pose"}, {"arm", "gripper"}, {"arm", "wrist"}, {"arm", "scanner_mount"}},
       "a cell model",
       "use it by --set cell.model=FILE or [cell] model",
       {"cell.model"}},
      {{{"radius_m", "length_m"}},
       "a part",
       "--part FILE, or tubetwin part check FILE",
       {"part check", "--part", "pile.part", "part.name"}},
      {{{"fault"}}, "a script of faults", "tubetwin emulate --faults FILE", {"--faults"}},
      {{{"view"}, {"touch"}},
       "a list of views",
       "tubetwin calibrate hand-eye --views FILE",
       {"--views"}},
      {{{"cell"}, {"pile"}, {"perception"}, {"planner"}, {"evaluator"}, {"resolution"}, {"cycle"}},
       "a scenario or cell file",
       "tubetwin run FILE, or --cell FILE",
       {"run", "config check", "config dump", "emulate", "--cell"}}};
  return kinds;
}

/// Null where the file cannot be read or is of none.
const TomlKind* KindOfToml(const std::string& file) {
  ConfigSource source;
  try {
    source.AddFile(file);
  } catch (const Error&) {
    return nullptr;  // Its reader has said why.
  }
  const auto has = [&](const std::string& key) { return !source.PlaceOf(key).empty(); };
  for (const TomlKind& kind : TomlKinds()) {
    for (const UsedKeys& keys : kind.keys) {
      if (std::all_of(keys.begin(), keys.end(), has)) return &kind;
    }
  }
  return nullptr;
}

std::string AdviceForToml(const std::string& file, const TomlKind& kind) {
  std::string use = kind.use;
  for (std::size_t at = 0; (at = use.find("FILE", at)) != std::string::npos; at += file.size()) {
    use.replace(at, 4, file);
  }
  return "\n(" + file + " is " + kind.name + ": " + use + ")";
}

}  // namespace

std::string AdviceForWords(const std::string& message, const std::string& verb,
                           const std::vector<std::string>& words) {
  constexpr std::array kOptions = {"--part", "--cell", "--faults", "--views"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    // "run FILE", "--part FILE", "--part=FILE", "cell.model=FILE", "--set=cell.model=FILE"
    const std::size_t equals = words[i].rfind('=');
    const std::string file = equals == std::string::npos ? words[i] : words[i].substr(equals + 1);
    if (!file.ends_with(".toml") || !message.starts_with(file + ":")) continue;
    std::string asked_by = verb.substr(verb.find(' ') + 1);
    if (equals != std::string::npos) {
      asked_by = words[i].substr(0, equals);
      asked_by = asked_by.substr(asked_by.rfind('=') + 1);
    } else if (i > 0 && std::count(kOptions.begin(), kOptions.end(), words[i - 1]) > 0) {
      asked_by = words[i - 1];
    }
    const TomlKind* kind = KindOfToml(file);
    if (kind == nullptr || std::count(kind->asked_by.begin(), kind->asked_by.end(), asked_by) > 0) {
      continue;
    }
    return AdviceForToml(file, *kind);
  }
  return "";
}

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
    if (const TomlKind* kind = KindOfToml(file)) return AdviceForToml(file, *kind);
    return "\n(a part file is given by --part, a scenario to: tubetwin run FILE)";
  }
  if (ending == ".bin") return "\n(recordings of a round's motions are for: tubetwin render FILE)";
  if (ending == ".rec") return "\n(recordings of a cell are for: tubetwin replay FILE)";
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

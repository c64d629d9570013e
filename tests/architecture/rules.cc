#include "tests/architecture/rules.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "models/base/text.h"

namespace tubetwin::architecture {
namespace {

/// Rooms and what each may include besides itself. A room sees what its rooms see: twin/cell may
/// name models because scenes, which it may include, are built of them.
const std::map<std::string, std::vector<std::string>>& Rooms() {
  static const std::map<std::string, std::vector<std::string>> rooms = {
      {"models/base", {}},
      {"models", {"models/base"}},
      {"hw_bridge/cell", {"models"}},
      {"hw_bridge/recording", {"hw_bridge/cell"}},
      {"hw_bridge/mcap", {"hw_bridge/recording"}},
      {"hw_bridge/codecs", {"models/base"}},
      {"hw_bridge/drivers", {"hw_bridge/codecs", "hw_bridge/cell"}},
      {"hw_bridge/emulators", {"hw_bridge/codecs", "hw_bridge/cell"}},
      {"scenes/engine", {"models/base"}},
      {"scenes", {"scenes/engine", "models"}},
      {"perception/view", {"models"}},
      {"perception/scene", {"perception/view"}},
      {"perception/calibration", {"perception/view"}},
      {"perception/fragment", {"perception/view"}},
      {"perception/joining", {"perception/fragment", "perception/scene"}},
      {"perception/part_import", {"perception/fragment"}},
      {"perception/leao2020", {"perception/fragment", "perception/scene"}},
      {"perception", {"perception/joining", "perception/leao2020"}},
      {"planner/scene_query", {"perception/scene"}},
      {"planner/extraction", {"planner/scene_query"}},
      {"planner/grasp", {"planner/extraction"}},
      {"planner/motion", {"hw_bridge/cell", "models"}},
      {"planner/cell_check", {"planner/grasp", "planner/motion"}},
      {"planner/pick", {"planner/grasp", "planner/motion"}},
      {"planner/resolution", {"planner/motion"}},
      {"planner/cycle", {"planner/pick", "planner/resolution", "perception"}},
      {"planner/evaluator", {"scenes", "planner/pick"}},
      {"twin/render", {"scenes", "models"}},
      {"twin/cell", {"twin/render", "scenes", "hw_bridge/cell"}},
      {"twin/statistics", {"models/base"}},
      {"twin/round",
       {"twin/cell", "twin/render", "twin/statistics", "planner/evaluator", "planner/cycle",
        "planner/cell_check", "perception", "scenes", "hw_bridge/recording", "hw_bridge/drivers"}},
      {"twin/campaign", {"twin/round", "twin/statistics"}},
      {"twin/study", {"twin/campaign", "twin/round", "twin/statistics"}},
      {"twin/report", {"twin/study", "twin/campaign", "twin/round", "twin/statistics"}},
      {"twin/live", {"twin/round", "hw_bridge/drivers", "hw_bridge/emulators"}},
      {"twin/app",
       {"twin/live", "twin/report", "perception/calibration", "perception/part_import",
        "hw_bridge/mcap"}},
  };
  return rooms;
}

/// All rooms reachable from `room`, itself included.
std::set<std::string> Visible(const std::string& room) {
  std::set<std::string> seen = {room};
  std::vector<std::string> open = {room};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    for (const std::string& below : Rooms().at(next)) {
      if (seen.insert(below).second) open.push_back(below);
    }
  }
  return seen;
}

bool StartsWith(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

bool IsTest(const std::string& path) { return StartsWith(path, "tests/"); }

bool IsHeader(const std::string& path) { return path.ends_with(".h"); }

struct ThirdParty {
  std::string start;               ///< Of the include.
  std::vector<std::string> rooms;  ///< That may use it; tests are named like a room.
  bool only_cc = false;            ///< Not in headers: slow to compile, or an inner matter.
};

const std::vector<ThirdParty>& ThirdParties() {
  static const std::vector<std::string> kSockets = {"hw_bridge/drivers", "hw_bridge/emulators",
                                                    "twin/live", "tests"};
  static const std::vector<ThirdParty> list = {
      {"mujoco/",
       {"scenes/engine", "scenes", "planner/evaluator", "twin/render", "twin/cell", "tests"}},
      {"pcl/", {"perception/leao2020", "tests"}, true},
      {"ode/", {"tests"}, true},
      {"fcl/", {"models"}, true},
      {"embree3/", {"twin/render"}, true},
      {"opencv2/", {"twin/render", "perception", "tests"}, true},
      {"EGL/", {"twin/render"}},
      {"GL/", {"twin/render"}},
      {"CLI/", {"twin/app"}, true},
      {"toml++/", {"models/base"}, true},
      {"nlohmann/", {"models/base", "twin/app"}},
      {"spdlog/", {"models/base", "twin/app"}},
      {"fmt/", {"models/base", "twin/app"}},
      {"asio", kSockets, true},
      {"modbus/", kSockets, true},
      {"arv", kSockets, true},
      {"sys/socket.h", kSockets, true},
      {"sys/un.h", kSockets, true},
      {"netinet/", kSockets, true},
      {"arpa/", kSockets, true},
      {"netdb.h", kSockets, true},
      {"Random123/", {"models/base", "tests"}, true},
      {"boost/", {"models/base", "twin/statistics", "tests"}, true},
      {"zstd.h", {"models/base", "twin/render"}, true},
      {"catch2/", {"tests"}},
      {"benchmark/", {"tests"}},
      {"kdl/", {"tests"}, true},
  };
  return list;
}

/// Eigen is allowed everywhere; standard C++ has neither slash nor ending; the rest is POSIX.
bool IsAllowedEverywhere(const std::string& include) {
  if (StartsWith(include, "Eigen/")) return true;
  if (include.find_first_of("/.") == std::string::npos) return true;
  static const std::set<std::string> kPosix = {
      "dirent.h",    "dlfcn.h",    "fcntl.h",        "poll.h",        "sched.h",     "signal.h",
      "spawn.h",     "termios.h",  "sys/mman.h",     "sys/stat.h",    "sys/types.h", "sys/file.h",
      "sys/prctl.h", "sys/wait.h", "sys/resource.h", "sys/utsname.h", "unistd.h"};
  return kPosix.count(include) > 0;
}

}  // namespace

std::string RoomOf(const std::string& path) {
  std::string best;
  for (const auto& [room, may_include] : Rooms()) {
    if (StartsWith(path, room + "/") && room.size() > best.size()) best = room;
  }
  return best;
}

std::vector<std::string> CheckRoomIncludes(const std::vector<SourceFile>& files) {
  std::vector<std::string> breaks;
  for (const SourceFile& file : files) {
    if (IsTest(file.path)) continue;
    const std::string room = RoomOf(file.path);
    if (room.empty()) {
      breaks.push_back(file.path + " lies in no room of the design");
      continue;
    }
    const std::set<std::string> visible = Visible(room);
    for (const std::string& include : file.quoted) {
      const std::string other = RoomOf(include);
      if (other.empty()) {
        breaks.push_back(file.path + " includes \"" + include + "\", which is in no room");
      } else if (visible.count(other) == 0) {
        breaks.push_back(file.path + " includes \"" + include + "\", but " + room +
                         " may not include " + other);
      }
    }
  }
  return breaks;
}

std::vector<std::string> CheckNoCycles() {
  std::vector<std::string> breaks;
  for (const auto& [room, may_include] : Rooms()) {
    for (const std::string& below : may_include) {
      if (Visible(below).count(room) > 0) breaks.push_back(room + " and " + below);
    }
  }
  return breaks;
}

std::vector<std::string> CheckTruthStaysInRound(const std::vector<SourceFile>& files) {
  const std::string kTruth = "twin/cell/truth.h";
  const auto includes = [](const SourceFile& file, const std::string& header) {
    return std::count(file.quoted.begin(), file.quoted.end(), header) > 0;
  };
  // Truth, and the round's own headers that hand it on.
  std::vector<std::string> telling = {kTruth};
  for (const SourceFile& file : files) {
    if (RoomOf(file.path) == "twin/round" && IsHeader(file.path) && includes(file, kTruth)) {
      telling.push_back(file.path);
    }
  }
  std::vector<std::string> breaks;
  for (const SourceFile& file : files) {
    const std::string room = RoomOf(file.path);
    // The simulated cell fills it in, but its headers must not hand it on.
    if (IsTest(file.path) || room == "twin/round" ||
        (room == "twin/cell" && !IsHeader(file.path))) {
      continue;
    }
    for (const std::string& header : telling) {
      if (includes(file, header)) {
        breaks.push_back(file.path + " includes " + header + ": truth is for twin/round alone");
      }
    }
  }
  return breaks;
}

std::vector<std::string> CheckThirdParty(const std::vector<SourceFile>& files) {
  std::vector<std::string> breaks;
  for (const SourceFile& file : files) {
    const std::string room = IsTest(file.path) ? "tests" : RoomOf(file.path);
    for (const std::string& include : file.brackets) {
      if (IsAllowedEverywhere(include)) continue;
      const auto& all = ThirdParties();
      const auto found = std::find_if(all.begin(), all.end(), [&](const ThirdParty& library) {
        return StartsWith(include, library.start);
      });
      if (found == all.end()) {
        breaks.push_back(file.path + " includes <" + include + ">, a library nobody decided on");
      } else if (std::count(found->rooms.begin(), found->rooms.end(), room) == 0) {
        breaks.push_back(file.path + " includes <" + include + ">, allowed only in " +
                         Join(found->rooms));
      } else if (found->only_cc && IsHeader(file.path) && room != "tests") {
        breaks.push_back(file.path + " includes <" + include + ">, allowed only in .cc files");
      }
    }
  }
  return breaks;
}

std::vector<std::string> RoomNames() {
  std::vector<std::string> names;
  for (const auto& [room, may_include] : Rooms()) names.push_back(room);
  return names;
}

std::vector<std::string> CheckForbiddenWords(const std::string& path, const std::string& text) {
  // Written in two halves, so that this file does not break its own rule.
  static const std::vector<std::string> kWords = {
      std::string("/wo") + "rk/",       std::string("/ro") + "ot/",
      std::string("/ho") + "me/",       std::string("pypi") + ".org",
      std::string("pythonho") + "sted", std::string("deb.deb") + "ian.org"};
  std::vector<std::string> breaks;
  for (const std::string& word : kWords) {
    const std::size_t at = text.find(word);
    if (at == std::string::npos) continue;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
    breaks.push_back(path + ":" + std::to_string(line) + " names '" + word +
                     "', a place of one machine");
  }
  return breaks;
}

}  // namespace tubetwin::architecture

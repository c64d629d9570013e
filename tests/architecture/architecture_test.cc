#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "models/base/files.h"
#include "models/base/text.h"
#include "tests/architecture/rules.h"
#include "tests/architecture/size_rules.h"
#include "tests/architecture/tree.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin::architecture {
namespace {

namespace fs = std::filesystem;

const std::string kTop = TUBETWIN_SOURCE_DIR;

const std::vector<SourceFile>& Sources() {
  static const std::vector<SourceFile> sources = ReadSources(kTop);
  return sources;
}

void CheckNone(const std::vector<std::string>& breaks) {
  INFO(Join(breaks, "\n"));
  CHECK(breaks.empty());
}

std::vector<SourceFile> One(const std::string& path, const std::string& text) {
  return {ParseSource(path, text)};
}

/// Runs a command, its output into `log`; returns its exit code.
int Run(const std::string& command, const std::string& log) {
  const int status = std::system((command + " > '" + log + "' 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("the sources of every room are found") {
  for (const char* room : {"models/base", "models", "hw_bridge/cell", "scenes", "perception",
                           "planner/cycle", "twin/render", "twin/cell", "twin/round",
                           "twin/campaign", "twin/statistics", "twin/study", "twin/report"}) {
    CHECK(std::any_of(Sources().begin(), Sources().end(),
                      [&](const SourceFile& f) { return RoomOf(f.path) == room; }));
  }
}

TEST_CASE("rooms include only what the design allows them") {
  CheckNone(CheckRoomIncludes(Sources()));
}

TEST_CASE("the rooms have no cycle") { CheckNone(CheckNoCycles()); }

TEST_CASE("truth is seen by the round alone") { CheckNone(CheckTruthStaysInRound(Sources())); }

TEST_CASE("third-party headers appear only where they may") {
  CheckNone(CheckThirdParty(Sources()));
}

TEST_CASE("files stay short or argue why not") { CheckNone(CheckFileSizes(Sources())); }

TEST_CASE("functions stay short or argue why not") { CheckNone(CheckFunctionSizes(Sources())); }

TEST_CASE("no folder holds more sources than one can know") {
  CheckNone(CheckFolderSizes(Sources()));
}

TEST_CASE("every room says on a screen what it is") {
  constexpr int kScreen = 60;
  std::vector<std::string> breaks;
  for (const std::string& room : RoomNames()) {
    for (std::string& line : CheckReadme(kTop, room, kScreen)) breaks.push_back(std::move(line));
  }
  CheckNone(breaks);
}

TEST_CASE("the front page stays a page") { CheckNone(CheckReadme(kTop, "", 90)); }

TEST_CASE("the top of the tree holds the agreed files and rooms and nothing else") {
  const std::vector<std::string> allowed = {".ci",
                                            ".clang-format",
                                            ".clang-tidy",
                                            ".gitignore",
                                            "CHANGELOG.md",
                                            "CMakeLists.txt",
                                            "CMakePresets.json",
                                            "CONTRIBUTING.md",
                                            "LICENSE",
                                            "README.md",
                                            "dev",
                                            "hw_bridge",
                                            "models",
                                            "perception",
                                            "planner",
                                            "scenes",
                                            "tests",
                                            "twin"};
  for (const std::string& name : TopLevel(kTop)) {
    INFO(name << " is not one of " << Join(allowed));
    CHECK(std::count(allowed.begin(), allowed.end(), name) == 1);
  }
}

TEST_CASE("nothing in the tree names a place of one machine") {
  std::vector<std::string> breaks;
  for (const std::string& name : TopLevel(kTop)) {
    std::vector<fs::path> files;
    const fs::path path = fs::path(kTop) / name;
    if (fs::is_directory(path)) {
      for (const auto& entry : fs::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
    } else {
      files.push_back(path);
    }
    for (const fs::path& file : files) {
      const std::string text = ReadFile(file.string());
      if (text.find('\0') != std::string::npos) continue;  // A picture or a cloud.
      for (std::string& line : CheckForbiddenWords(fs::relative(file, kTop).string(), text)) {
        breaks.push_back(std::move(line));
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  CheckNone(breaks);
}

TEST_CASE("every source file is listed by name in the build") {
  std::vector<std::string> breaks;
  for (const SourceFile& file : Sources()) {
    if (!file.path.ends_with(".cc")) continue;
    fs::path folder = fs::path(file.path).parent_path();
    while (!fs::exists(fs::path(kTop) / folder / "CMakeLists.txt")) folder = folder.parent_path();
    const std::string lists = ReadFile((fs::path(kTop) / folder / "CMakeLists.txt").string());
    const std::string name = fs::relative(file.path, folder).string();
    if (lists.find(name) == std::string::npos) {
      breaks.push_back(file.path + " is not in " + (folder / "CMakeLists.txt").string());
    }
    if (lists.find("GLOB") != std::string::npos) {
      breaks.push_back((folder / "CMakeLists.txt").string() + " collects files by pattern");
    }
  }
  CheckNone(breaks);
}

TEST_CASE("every library that the build looks for is in a package that ./dev installs") {
  const std::map<std::string, std::string> package_of = {
      {"Eigen3", "libeigen3-dev"},
      {"nlohmann_json", "nlohmann-json3-dev"},
      {"Threads", "g++"},
      {"Catch2", "catch2"},
      {"CLI11", "libcli11-dev"},
      {"OpenCV", "libopencv-dev"},
      {"OpenGL", "libopengl-dev"},
      {"embree", "libembree-dev"},
      {"fcl", "libfcl-dev"},
      {"zstd", "libzstd-dev"},
      {"Boost", "libboost-dev"},
      {"spdlog", "libspdlog-dev"},
      {"benchmark", "libbenchmark-dev"},
      {"PCL", "libpcl-dev"},
      {"orocos_kdl", "liborocos-kdl-dev"},
      {"tubetwin", "cmake"}};  // Of itself, in the test of its installation.
  const std::string dev = ReadFile(kTop + "/dev");
  const std::size_t begin = dev.find("kBuildPackages=(");
  REQUIRE(begin != std::string::npos);
  std::string installed = dev.substr(begin, dev.find(')', begin) - begin) + " ";
  std::replace(installed.begin(), installed.end(), '\n', ' ');
  std::vector<std::string> breaks;
  int found = 0;
  for (const std::string& name : TopLevel(kTop)) {
    if (!fs::is_directory(fs::path(kTop) / name)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(kTop) / name)) {
      if (entry.path().filename() != "CMakeLists.txt") continue;
      const std::string text = ReadFile(entry.path().string());
      const std::string call = "find_package(";
      for (std::size_t at = text.find(call); at != std::string::npos;
           at = text.find(call, at + 1)) {
        const std::size_t first = at + call.size();
        const std::string library = text.substr(first, text.find_first_of(" )", first) - first);
        const auto package = package_of.find(library);
        ++found;
        if (package == package_of.end()) {
          breaks.push_back(library + ": add its package to this test and to ./dev");
        } else if (installed.find(" " + package->second + " ") == std::string::npos) {
          breaks.push_back(library + ": ./dev does not install " + package->second);
        }
      }
    }
  }
  CHECK(found > 5);
  CheckNone(breaks);
}

TEST_CASE("all sources are formatted") {
  const TemporaryFolder folder;
  const std::string log = folder / "log";
  constexpr const char* kVersion = "version 14.";  // Others break lines at other places.
  if (Run("clang-format --version", log) != 0 ||
      ReadFile(log).find(kVersion) == std::string::npos) {
    WARN("SKIPPED: clang-format 14 is not installed, so the format was not checked");
    return;
  }
  std::string list;
  for (const SourceFile& file : Sources()) list += kTop + "/" + file.path + '\0';
  WriteFileAtomically(folder / "list", list);
  const int code =
      Run("xargs -0 clang-format --dry-run --Werror < '" + (folder / "list") + "'", log);
  INFO("run ./dev format:\n" << ReadFile(log).substr(0, 2000));
  CHECK(code == 0);
}

TEST_CASE("each rule finds what breaks it") {
  const std::string mujoco = "#include <mujoco/mujoco.h>\n";
  CHECK(CheckRoomIncludes(One("planner/pick/a.cc", "#include \"scenes/pile.h\"\n")) ==
        std::vector<std::string>{"planner/pick/a.cc includes \"scenes/pile.h\", but planner/pick "
                                 "may not include scenes"});
  CHECK(CheckRoomIncludes(One("perception/a.h", "#include \"hw_bridge/cell/cell.h\"\n")).size() ==
        1);
  CHECK(CheckRoomIncludes(One("hw_bridge/drivers/ati/a.cc", "#  include \"twin/cell/x.h\"\n"))
            .size() == 1);
  CHECK(CheckRoomIncludes(One("models/a.cc", "#include \"arm.h\"\n")).size() == 1);
  CHECK(CheckRoomIncludes(One("extra/a.cc", "")).size() == 1);
  CHECK(CheckRoomIncludes(One("planner/evaluator/a.cc", "#include \"scenes/pile.h\"\n")).empty());
  CHECK(CheckThirdParty(One("planner/pick/a.cc", mujoco)).size() == 1);
  CHECK(CheckThirdParty(One("perception/a.cc", mujoco)).size() == 1);
  CHECK(CheckThirdParty(One("planner/evaluator/a.cc", mujoco)).empty());
  CHECK(CheckThirdParty(One("perception/a.cc", "#include <sys/socket.h>\n")).size() == 1);
  CHECK(CheckThirdParty(One("perception/a.h", "#include <opencv2/core.hpp>\n")).size() == 1);
  CHECK(CheckThirdParty(One("perception/a.cc", "#include <opencv2/core.hpp>\n")).empty());
  CHECK(CheckThirdParty(One("models/a.cc", "#include <newlib/new.h>\n")).size() == 1);
  CHECK(CheckTruthStaysInRound(One("twin/app/a.cc", "#include \"twin/cell/truth.h\"\n")).size() ==
        1);
  CHECK(CheckTruthStaysInRound(One("twin/cell/a.h", "#include \"twin/cell/truth.h\"\n")).size() ==
        1);
  CHECK(CheckTruthStaysInRound(One("twin/round/a.cc", "#include \"twin/cell/truth.h\"\n")).empty());
  CHECK(CheckTruthStaysInRound(
            {ParseSource("twin/round/scoring.h", "#include \"twin/cell/truth.h\"\n"),
             ParseSource("twin/app/a.cc", "#include \"twin/round/scoring.h\"\n")})
            .size() == 1);
  CHECK(CheckForbiddenWords("a", std::string("x\n/wo") + "rk/y").at(0).rfind("a:2 ", 0) == 0);
}

TEST_CASE("each rule of sizes finds what breaks it") {
  std::string lines;
  for (int i = 0; i < 401; ++i) lines += "\n";
  CHECK(CheckFileSizes(One("models/a.cc", lines)).size() == 1);
  CHECK(
      CheckFileSizes(One("models/a.cc", "// Long file: a table of one device.\n" + lines)).empty());

  std::string body;
  for (int i = 0; i < 59; ++i) body += "    x = 1;\n";
  const std::string in_class =
      "struct A {\n  void F(int a,\n         int b) {\n" + body + "  }\n};\n";
  CHECK(CheckFunctionSizes(One("models/a.h", in_class)) ==
        std::vector<std::string>{
            "models/a.h:2 begins a function of 62 lines; split it by named steps, or argue in "
            "a comment \"Long function: REASON\""});
  CHECK(CheckFunctionSizes(One("models/a.cc", "void F() {\n" + body + "}\n")).size() == 1);
  CHECK(CheckFunctionSizes(One("models/a.cc", "void F() {\n  if (a) {\n  }\n}\nint b;\n" + body))
            .empty());
  CHECK(
      CheckFunctionSizes(
          One("models/a.cc",
              "// Long function: one line for each key of the file.\nvoid F() {\n" + body + "}\n"))
          .empty());

  std::vector<SourceFile> files;
  for (int i = 0; i < 26; ++i)
    files.push_back(ParseSource("models/a" + std::to_string(i) + ".cc", ""));
  CHECK(CheckFolderSizes(files).size() == 1);
  files.pop_back();
  CHECK(CheckFolderSizes(files).empty());
}

}  // namespace tubetwin::architecture

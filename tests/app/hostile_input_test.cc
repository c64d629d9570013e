// Files that were damaged or made to do harm, and options that a verb would ignore: each is refused
// by name, with nothing written, and no control character reaches the terminal.

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

const char* const kTubes =
    R"({"schema": "tubetwin/tubes/1", "frame": "bin", "part": "pvc_a",
 "tubes": [{"id": 0, "centerline_m": [[-0.2, 0, 0.02], [0.2, 0, 0.02]], "radius_m": 0.0125,
            "length_m": 0.4, "visible_fraction": 1, "confidence": 1, "class": "free", "over": [],
            "under": []}],
 "crossings": [], "unseen_m3": 0, "unexplained_points": 0, "threads": 1,
 "timing_ms": {"load": 0, "filter": 0, "segment": 0, "fit": 0, "join": 0, "crossings": 0, "total": 0}})";

std::string WithText(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Every control character but line breaks, tabs too.
bool HasControl(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7f;
  });
}

void CheckNothingWritten(const TemporaryFolder& folder, const std::string& name) {
  CHECK_FALSE(std::filesystem::exists(folder.path() + "/" + name));
}

TEST_CASE("A configuration nested thousands deep ends with 78 in every verb", "[app]") {
  const TemporaryFolder folder;
  std::string keys, lists;
  for (int i = 0; i < 20000; ++i) {
    keys += "a.";
    lists += "[";
  }
  Write(folder, "keys.toml", keys + "b = 1\n");
  Write(folder, "lists.toml", "seed = " + lists + "\n");
  for (const std::string& file : {std::string("keys.toml"), std::string("lists.toml")}) {
    const std::string said =
        file + ":1: lists, tables or the parts of a key nest more than 32 deep";
    for (const std::string& verb :
         {"config check " + file, "part check " + file, "run " + file + " --out o",
          "campaign run " + file + " --out o", "emulate --faults " + file + " --out o",
          "doctor --cell " + file, "config check --set cell.model=" + file}) {
      CheckRefused(folder, verb, 78, said);
    }
  }
  CheckRefused(folder, "config check --set " + keys + "b=1", 78, "nest more than 32 deep");
  CheckNothingWritten(folder, "o/campaign.json");
}

TEST_CASE("JSON nested thousands deep ends with 65 in every verb", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "deep.json", std::string(100000, '['));
  for (const std::string verb :
       {"pile show deep.json", "pile import deep.json --out o.json", "plan deep.json --out o.json",
        "render deep.json --out o.png", "run --pile deep.json --out o"}) {
    CheckRefused(folder, verb, 65, "deep.json: byte 65: lists and objects nest more than 64 deep");
  }
  CheckNothingWritten(folder, "o.json");
}

TEST_CASE("Numbers of a tubes.json outside of their range end with 65, at once", "[app]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to, const char* said) {
    Write(folder, "t.json", WithText(kTubes, from, to));
    for (const std::string verb : {"plan t.json --out o.json", "render t.json --out o.png"}) {
      CheckRefused(folder, verb, 65, said);
    }
  };
  refused("[0.2, 0, 0.02]", "[1e300, 0, 0.02]", "t.json: tubes[0].centerline_m[1][0]: is 1e+300");
  refused("[0.2, 0, 0.02]", "[0.2, 3.1, 0.02]",
          "t.json: tubes[0].centerline_m[1][1]: is 3.1, allowed are -3 to 3");
  refused("[0.2, 0, 0.02]", "[-0.2, 0, 0.02]",
          "t.json: tubes[0].centerline_m[1]: is 0 m from the point before");
  refused("\"radius_m\": 0.0125", "\"radius_m\": 0",
          "t.json: tubes[0].radius_m: is 0, allowed are 0.001 to 0.1");
  refused("\"id\": 0", "\"id\": 4294967296", "t.json: tubes[0].id: is 4294967296");
  refused("\"length_m\": 0.4", "\"length_m\": 1e30", "t.json: tubes[0].length_m: is 1e+30");
  Write(folder, "good.json", kTubes);
  CHECK(RunProgram(folder, "render good.json --out o.png").code != 65);
}

TEST_CASE("No control character of a file reaches the terminal", "[app]") {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& verb, int code, const std::string& said) {
    const Outcome outcome = RunProgram(folder, verb);
    CAPTURE(verb, outcome.err);
    CHECK(outcome.code == code);
    CHECK_FALSE(HasControl(outcome.err));
    CHECK_FALSE(HasControl(outcome.out));
    CHECK(Lines(outcome.err) <= 4);
    CHECK_THAT(outcome.out + outcome.err, Catch::Contains(said));
  };
  Write(folder, "p.csv",
        "tube,index,x,y,z\n0,0,0,0.\x13"
        "5,0\n");
  check("pile show p.csv", 65, "p.csv: line 2: y is '0.\\x135'");
  Write(folder, "p.json", R"({"schema": "tubetwin/\u001b[2J\n\n\n\n/1"})");
  check("pile show p.json", 65, "p.json: schema is 'tubetwin/\\x1B[2J");
  Write(folder, "part.toml", "name = \"a\\u001b[31mb\"\n");
  check("part check part.toml", 78, "part.toml: name is 'a\\x1B[31mb'");
  Write(folder, "c.toml", "[[variant]]\npart = '''a\nb'''\ncount = 1\n");
  check("campaign run c.toml --out o", 78,
        "c.toml:2:8: pile.part: is \"a\\nb\"; allowed: texts "
        "without control characters");
  Write(folder, "named.json", WithText(kPile, R"("part": "pvc_a")", R"("part": {"name": "a\nb"})"));
  check("pile show named.json", 65, "named.json: part: name is 'a\\x0Ab'; allowed: UTF-8");
  Write(folder, "named.json", WithText(kPile, R"("part": "pvc_a")", R"("part": "a\nb")"));
  check("pile show named.json", 66, "named.json: part: no part is named 'a\\x0Ab'");
  check("pile show $(printf 'a\\033[2Jb')", 66, "a\\x1B[2Jb: no such file");
  check("pile show $(printf 'a\\302\\233b')", 66, "a\\xC2\\x9Bb: no such file");
  check("pile show --json p.json --pa$(printf 'r\\007t')", 64, "");
}

TEST_CASE("A campaign that names no part of this program says which campaign", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "c.toml", "[[variant]]\npart = 'pvc_a'\n[[variant]]\npart = 'pvc_b'\n");
  CheckRefused(folder, "campaign run c.toml --out o", 66,
               "c.toml: variant 1: no part is named 'pvc_b'; nearest is 'pvc_a'");
}

TEST_CASE("A campaign too large to be run is refused before it takes memory", "[app]") {
  const TemporaryFolder folder;
  std::string forty = "1";
  for (int i = 2; i <= 40; ++i) forty += ", " + std::to_string(i);
  const std::string grid =
      "[[variant]]\npart = 'pvc_a'\n[variant.set]\n"
      "pile.count = [" +
      forty +
      "]\n"
      "planner.samples = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n"
      "planner.exclude_free = [true, false]\nscan.views = [1, 2, 3, 4]\n";
  Write(folder, "grid.toml", grid);
  CheckRefused(folder, "campaign run grid.toml --out o", 78, "make a grid of more than 1000");
  std::string rounds = "rounds = 1000000\n[[variant]]\npart = 'pvc_a'\ncount = [1, 2]\n";
  Write(folder, "rounds.toml", rounds);
  CheckRefused(folder, "campaign run rounds.toml --out o", 78,
               "2 variants of 1000000 rounds are 2000000 rounds; allowed: 1000 variants and "
               "1000000 rounds in all");
}

TEST_CASE("A pipe or device in place of a file ends with 66, at once", "[app]") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder.path() + "/pipe").c_str(), 0600) == 0);
  for (const std::string verb : {"config check pipe", "pile show pipe", "campaign run pipe --out o",
                                 "run --pile pipe --out o", "emulate --faults pipe --out o",
                                 "render pipe --out o.png", "pile show /dev/zero"}) {
    CheckRefused(folder, verb, 66, "is a device, pipe or socket", "timeout 20 ");
  }
}

TEST_CASE("A key that a verb does not use is refused by name, and an unknown one too", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kPile);
  Write(folder, "t.json", kTubes);
  Write(folder, "c.pcd", "");
  struct Verb {
    std::string words, unused;
  };
  for (const Verb& verb :
       std::vector<Verb>{{"pile generate --part pvc_a --count 1 --out o.json", "scan.views=1"},
                         {"pile import p.json --out o.json", "seed=1"},
                         {"pile show p.json", "bin.X_BN=[0,0,0,0]"},
                         {"scan p.json --out o", "planner.samples=1"},
                         {"perceive c.pcd --part pvc_a --out o.json", "planner.samples=1"},
                         {"plan t.json --out o.json", "perception.block_m=0.001"},
                         {"evaluate p.json --out o.json", "scan.views=1"},
                         {"part check pvc_a", "planner.samples=1"},
                         {"part import none.stl --out o.toml", "planner.samples=1"},
                         {"render p.json --out o.png", "planner.samples=1"},
                         {"render t.json --out o.png", "pile.part=pvc_a"},
                         {"replay none.rec", "planner.samples=1"},
                         {"doctor", "cell.rate=1"},
                         {"config model", "seed=1"},
                         {"config schema", "seed=1"},
                         {"campaign status o", "seed=1"},
                         {"campaign merge o --out o", "seed=1"},
                         {"campaign report o", "seed=1"},
                         {"campaign compare o", "seed=1"},
                         {"campaign schema", "seed=1"}}) {
    const std::string key = verb.unused.substr(0, verb.unused.find('='));
    if (verb.words != "doctor") {
      CheckRefused(folder, verb.words + " --set '" + verb.unused + "'", 64, "--set " + key + ": `");
    }
    CheckRefused(folder, verb.words + " --set bogus.key=1", 78, "bogus");
  }
  CheckRefused(folder, "doctor --set seed=1", 64, "--set seed: `tubetwin doctor` does not use");
  CheckRefused(folder, "doctor --set cell.model=ur10e", 64,
               "--set cell.model: `tubetwin doctor without --cell` does not use");
  CheckNothingWritten(folder, "o");
  CheckNothingWritten(folder, "o.json");
}

TEST_CASE("A key of a group that a verb uses only in part is refused by name", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kPile);
  Write(folder, "t.json", kTubes);
  const std::string generate = "pile generate --part pvc_a --count 1 --out o.json";
  const std::string scan = "scan p.json --view 0 --out o";
  const std::string evaluate = "evaluate p.json --out o.json", plan = "plan t.json --out o.json";
  const std::string pose = "[0,0,0.2,1,0,0,0]";
  for (const auto& [verb, text] : std::vector<std::pair<std::string, std::string>>{
           {generate, "physics.pad_friction=[0.6,0.7]"},
           {generate, "physics.pad_torsion_m=[0.004,0.005]"},
           {generate, "physics.depth_noise_scale=[1,1]"},
           {generate, "physics.wrench_noise_counts=2"},
           {generate, "physics.wrench_bias_walk_N=0.2"},
           {generate, "physics.wrench_cross_talk=0.02"},
           {generate, "physics.hand_eye_error_m=0.001"},
           {generate, "physics.hand_eye_error_deg=0.1"},
           {scan, "physics.pad_friction=[0.6,0.7]"},
           {scan, "physics.tube_friction=[0.3,0.4]"},
           {scan, "physics.mass_scale=[1,1]"},
           {scan, "scan.rescan_all=true"},
           {scan, "cell.scanner.host=10.0.0.1"},
           {scan, "cell.scanner.driver=gige"},
           {scan, "cell.scanner.timeout_s=3"},
           {scan, "calibration.X_FE=" + pose},
           {evaluate, "planner.samples=3"},
           {evaluate, "planner.grasp_step_m=0.01"},
           {evaluate, "calibration.X_FS=" + pose},
           {plan, "scan.rescan_all=true"},
           {plan, "scan.resolution=1032x772"},
           {plan, "cycle.settle_s=1"},
           {plan, "cycle.grip_force_N=50"},
           {plan, "cycle.attempts_per_tube=2"}}) {
    const std::string key = text.substr(0, text.find('='));
    CheckRefused(folder, verb + " --set '" + text + "'", 64, "--set " + key + ": `");
  }
  for (const std::string& verb : {generate, scan, evaluate, plan}) {
    CheckRefused(folder, verb + " --set bin.mesh_units=mm", 64,
                 "--set bin.mesh_units: is the unit of bin.mesh, which is not given");
  }
  CheckRefused(folder, generate + " --set bin.mesh=b.stl --set bin.mesh_units=mm", 66, "b.stl");
  CheckNothingWritten(folder, "o");
  CheckNothingWritten(folder, "o.json");
}

TEST_CASE("Keys that make a pile or its scan change it", "[app]") {
  const TemporaryFolder folder;
  const auto made = [&](const std::string& words, const std::string& file) {
    const Outcome outcome = RunProgram(folder, words);
    INFO(words << ": " << outcome.err);
    REQUIRE(outcome.code == 0);
    return ReadFile(folder / file);
  };
  const std::string generate = "pile generate --part hose_b --count 2 --seed 1 --out g.json";
  const std::string pile = made(generate, "g.json");
  for (const char* text :
       {"physics.randomize=false", "physics.tube_friction=[0.9,0.9]",
        "physics.bending_stiffness_Nm2=[0.4,0.4]", "physics.mass_scale=[1.5,1.5]"}) {
    CHECK(made(generate + " --set " + text, "g.json") != pile);
  }
  Write(folder, "p.json", kPile);
  const std::string scan = "scan p.json --view 0 --out s";
  const std::string cloud = made(scan, "s/view_0.pcd");
  for (const char* text :
       {"physics.randomize=false", "physics.depth_noise_scale=[2,2]",
        "physics.hand_eye_error_m=0.002", "physics.hand_eye_error_deg=0.5", "scan.overhead_m=0.45",
        "cell.scanner.hand_eye_error=0", "cell.scanner.noise=false"}) {
    CHECK(made(scan + " --set " + text, "s/view_0.pcd") != cloud);
  }
}

TEST_CASE("What an option and a key say at once is refused", "[app]") {
  const TemporaryFolder folder;
  for (const char* verb : {"run --out o", "campaign run c.toml --out o", "config dump"}) {
    CheckRefused(folder, std::string(verb) + " --seed 1 --set seed=3", 64,
                 "--seed and --set seed say the same thing: give one");
  }
  const auto refused = [&](const std::string& arguments, const std::string& both) {
    CheckRefused(folder, arguments, 64, both + " say the same thing: give one");
  };
  refused("run --out o --part pvc_a --set pile.part=hose_b", "--part and --set pile.part");
  refused("run --out o --pile p.json --set pile.file=q.json", "--pile and --set pile.file");
  refused("pile show p.json --part pvc_a --set part.name=hose_b", "--part and --set part.name");
  refused("scan p.json --out o --bin 1,1,1 --set bin.size_m=[2,2,2]", "--bin and --set bin.size_m");
  refused("perceive c.pcd --part pvc_a --out o --profile best --set profile=leao2020",
          "--profile and --set profile");
}

TEST_CASE("Every verb that reads or makes a pile takes the bin's size from a key", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kPile);
  const std::string size = " --set bin.size_m=[0.9,0.5,0.1]";
  const auto size_in = [&](const std::string& file) {
    return Json::parse(ReadFile(folder.path() + "/" + file))["bin"]["size_m"];
  };
  const Json asked = {0.9, 0.5, 0.1};
  REQUIRE(RunProgram(folder, "pile generate --part pvc_a --count 1 --seed 1 --out g.json" + size)
              .code == 0);
  CHECK(size_in("g.json") == asked);
  REQUIRE(RunProgram(folder, "pile import p.json --out i.json" + size).code == 0);
  CHECK(size_in("i.json") == asked);
  const Outcome shown = RunProgram(folder, "pile show p.json --json" + size);
  REQUIRE(shown.code == 0);
  CHECK(Json::parse(shown.out)["bin"]["size_m"] == asked);
  // In a bin too short for it the tube runs through a wall, for every verb.
  for (const std::string verb : {"scan p.json --out o", "evaluate p.json --out o.json",
                                 "render p.json --out o.png", "pile import p.json --out o.json"}) {
    CheckRefused(folder, verb + " --set bin.size_m=[0.45,0.4,0.1]", 65, "inside the bin's wall");
  }
}

TEST_CASE("A pile that does not lie in the bin is refused by every verb that takes one", "[app]") {
  const TemporaryFolder folder;
  const std::string head = "tube,index,x,y,z\n0,0,-0.2,0,0.0125\n0,1,0.2,0,0.0125\n";
  Write(folder, "outside.csv", head + "3,0,1.0,0,0.0125\n3,1,1.4,0,0.0125\n");
  Write(folder, "under.csv", head + "3,0,-0.2,0.1,-0.05\n3,1,0.2,0.1,-0.05\n");
  Write(folder, "wall.csv", head + "3,0,-0.2,0.1,0.02\n3,1,0.45,0.1,0.02\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"outside.csv",
       "outside.csv: tubes[1] (id 3): its middle is at (1.2, 0, 0.0125) m, 0.8 m outside the bin"},
      {"under.csv", "under it at (-0.2, 0.1, -0.05) m, 0.05 m too low"},
      {"wall.csv", "inside the bin's wall at (0.415"}};
  for (const auto& [file, said] : cases) {
    for (const std::string& verb :
         {"run --pile " + file + " --out o", "scan " + file + " --out o",
          "evaluate " + file + " --out o.json", "render " + file + " --out o.png",
          "pile import " + file + " --out o.json", "pile show " + file}) {
      CheckRefused(folder, verb + " --bin 0.80,0.60,0.09", 65, said);
    }
    Write(folder, "c.toml", "[[variant]]\nset = {pile.file = '" + file + "'}\n");
    CheckRefused(folder, "campaign run c.toml --out o --set bin.size_m=[0.8,0.6,0.09]", 65, said);
  }
  CheckNothingWritten(folder, "o");
  CheckNothingWritten(folder, "o.json");
}

TEST_CASE("A part in place of a pile's own figures is told", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", WithText(kPile, "\"mass_kg\": 0.055", "\"mass_kg\": 0.08"));
  for (const std::string& words :
       {std::string(" --part hose_b"), std::string(" --set pile.part=hose_b")}) {
    const Outcome outcome = RunProgram(folder, "pile import p.json --out o.json" + words);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.err, Catch::Contains("p.json: part hose_b replaces what the file says: "
                                            "radius 0.0125 m by 0.01 m, mass 0.08 kg by 0.1"));
  }
  const Outcome kept = RunProgram(folder, "pile import p.json --out o.json");
  CHECK(kept.err == "");
  CHECK(Json::parse(ReadFile(folder.path() + "/o.json"))["tubes"][0]["mass_kg"] == 0.08);
}

}  // namespace
}  // namespace tubetwin

#include "planner/cell_check/cell_check.h"

#include <functional>

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

using Verdict = Finding::Verdict;

/// A cell with its own bin, as configuration would change it.
struct Case {
  CellModel model;
  Bin bin;
  Part part = LoadPart("pvc_a");
  int count = 7;

  explicit Case(const std::string& name = "leao2020") : model(LoadCellModel(name)) {
    bin.size_m = model.layout.bin_size_m;
    bin.X_BN = model.layout.X_BN;
  }
  std::vector<Finding> Check() const {
    return CheckCell({model, bin, part, ScanPosesOf(model, bin), count, false});
  }
};

std::string Text(const std::vector<Finding>& findings) {
  std::string out;
  for (const Finding& f : findings) {
    out += std::string(ToString(f.verdict)) + " " + f.what + ": " + f.found + " | " + f.allowed +
           " | " + f.remedy + "\n";
  }
  return out;
}

struct Change {
  const char* name;
  Verdict least;      ///< What at least must be said.
  const char* about;  ///< Part of the finding's name.
  std::function<void(Case&)> make;
};

RigidTransform At(double x, double y, double z, double yaw_deg = 90.0) {
  return MakeTransform(RotZ(Radians(yaw_deg)), Vector3(x, y, z));
}

// Long function: it is one table of cells, each with what is wrong about it.
const std::vector<Change>& Broken() {
  static const std::vector<Change> changes = {
      {"bin over the tray", Verdict::kImpossible, "bin and tray",
       [](Case& c) { c.bin.X_BN = At(0.30, -0.60, 0.10); }},
      {"bin 0.6 m lower, through the plate", Verdict::kImpossible, "cell plate",
       [](Case& c) { c.bin.X_BN = At(0.60, 0, -0.50); }},
      {"a bin of 2.5 m", Verdict::kImpossible, "bin and",
       [](Case& c) {
         c.bin.size_m = {2.5, 2.5, 0.09};
       }},
      {"X_FE in millimetres", Verdict::kImpossible, "X_FE",
       [](Case& c) { c.model.layout.X_FE = Translation(0, 0, 177); }},
      {"X_BN in millimetres", Verdict::kImpossible, "X_BN",
       [](Case& c) { c.bin.X_BN = At(600, 0, 100); }},
      {"forty tubes in a small bin", Verdict::kImpossible, "fill",
       [](Case& c) {
         c.bin.size_m = {0.3, 0.3, 0.05};
         c.count = 40;
       }},
      {"X_FK in millimetres", Verdict::kImpossible, "X_FK",
       [](Case& c) { c.model.layout.X_FK = Translation(0, 0, 33); }},
      {"X_FS in millimetres", Verdict::kImpossible, "X_FS",
       [](Case& c) { c.model.layout.X_FS = Translation(0, 115, 30); }},
      {"pads behind the sensor", Verdict::kImpossible, "X_FE",
       [](Case& c) { c.model.layout.X_FE = Translation(0, 0, 0.02); }},
      {"bin at the arm's base", Verdict::kImpossible, "bin and base",
       [](Case& c) { c.bin.X_BN = At(0.15, 0.10, 0.05); }},
      {"tray at the arm's base", Verdict::kImpossible, "tray and base",
       [](Case& c) { c.model.layout.X_BT = Translation(0.05, -0.30, 0.10); }},
      {"tray below the plate", Verdict::kImpossible, "tray and cell plate",
       [](Case& c) { c.model.layout.X_BT = Translation(0.05, -0.78, -0.05); }},
      {"bin out of reach", Verdict::kImpossible, "floor reached upright",
       [](Case& c) { c.bin.X_BN = At(1.6, 0, 0.10); }},
      {"bin too high", Verdict::kImpossible, "floor reached upright",
       [](Case& c) { c.bin.X_BN = At(0.60, 0, 1.30); }},
      {"tray out of reach", Verdict::kImpossible, "tray's slots",
       [](Case& c) { c.model.layout.X_BT = Translation(0.05, -1.9, 0.10); }},
      {"walls higher than the arm carries", Verdict::kImpossible, "height of carrying",
       [](Case& c) {
         c.bin.size_m = {0.77, 0.58, 0.50};
       }},
      {"a post in the bin", Verdict::kImpossible, "bin and post",
       [](Case& c) {
         c.model.layout.keep_out.push_back({"post", Translation(0.6, 0, 0.4), {0.05, 0.05, 0.4}});
       }},
      {"a scanner that sees from too far", Verdict::kImpossible, "floor seen",
       [](Case& c) { c.model.layout.scan_height_m = 1.6; }},
      {"a scanner that looks beside the bin", Verdict::kImpossible, "floor seen",
       [](Case& c) {
         c = Case("gp12_stand");
         c.model.layout.X_BS.translation().y() += 1.0;
       }},
      {"the arm cannot wait where it is told to", Verdict::kImpossible, "place reached",
       [](Case& c) {
         c = Case("gp12_stand");
         c.model.layout.p_BClear = Vector3(0.15, -2.9, 0.6);
       }},
      {"the arm waits in the scanner's view", Verdict::kDoubtful, "past the waiting arm",
       [](Case& c) {
         c = Case("gp12_stand");
         c.model.layout.p_BClear = Vector3(0.90, 0.0, 0.90);
       }},
      {"a flange turned by a quarter", Verdict::kDoubtful, "flange of the arm",
       [](Case& c) {
         c.model.arm.X_6F = c.model.arm.X_6F * MakeTransform(RotY(kPi / 2), Vector3::Zero());
       }},
      {"a working posture with the tool level", Verdict::kDoubtful, "working posture",
       [](Case& c) { c.model.arm.working.q[4] += kPi / 2; }},
      {"one view of eight", Verdict::kDoubtful, "floor seen",
       [](Case& c) { c.model.layout.scan_poses_BS = {ScanPosesOf(c.model, c.bin).front()}; }},
      {"a station that is out of reach", Verdict::kDoubtful, "station",
       [](Case& c) { c.model.layout.p_BTilt = Vector3(1.6, 0, 0.575); }},
      {"a heap", Verdict::kDoubtful, "fill",
       [](Case& c) {
         c.bin.size_m = {0.5, 0.4, 0.05};
         c.count = 18;
       }},
      {"a bin half out of reach", Verdict::kDoubtful, "floor reached upright",
       [](Case& c) { c.bin.X_BN = At(1.05, 0, 0.10); }},
  };
  return changes;
}

}  // namespace

TEST_CASE("Shipped cells are found sound", "[unit]") {
  for (const std::string& name : CellModelNames()) {
    for (const char* part : {"pvc_a", "hose_b"}) {
      Case c(name);
      c.part = LoadPart(part);
      INFO(name << ", " << part << "\n" << Text(c.Check()));
      CHECK(WorstOf(c.Check()) == Verdict::kOk);
    }
  }
}

TEST_CASE("Twenty sound variations of the paper's cell raise no alarm", "[unit]") {
  int n = 0;
  for (const double dx : {-0.03, 0.0, 0.03}) {
    for (const double dy : {-0.04, 0.04}) {
      for (const auto& size :
           {std::array<double, 3>{0.77, 0.58, 0.09}, std::array<double, 3>{0.60, 0.40, 0.12},
            std::array<double, 3>{0.40, 0.40, 0.15}}) {
        Case c;
        c.bin.X_BN.translation() += Vector3(dx, dy, 0.01 * n / 18);
        c.bin.size_m = size;
        INFO(dx << " " << dy << " " << size[0] << "\n" << Text(c.Check()));
        CHECK(WorstOf(c.Check()) == Verdict::kOk);
        ++n;
      }
    }
  }
  for (const double height_m : {0.40, 0.50}) {
    Case c;
    c.model.layout.carry_height_m = height_m;
    INFO(Text(c.Check()));
    CHECK(WorstOf(c.Check()) == Verdict::kOk);
    ++n;
  }
  CHECK(n == 20);
}

TEST_CASE("Broken cells are found out, each for its own reason and with a remedy", "[unit]") {
  for (const Change& change : Broken()) {
    Case c;
    change.make(c);
    const std::vector<Finding> findings = c.Check();
    INFO(change.name << "\n" << Text(findings));
    bool told = false;
    for (const Finding& f : findings) {
      if (f.verdict != Verdict::kOk) CHECK_FALSE(f.remedy.empty());
      told = told || (f.verdict >= change.least && f.what.find(change.about) != std::string::npos);
    }
    CHECK(told);
    CHECK(WorstOf(findings) >= change.least);
  }
}

TEST_CASE("Millimetres are told as metres", "[unit]") {
  Case c;
  c.bin.X_BN = At(600, 0, 100);
  const std::vector<Finding> findings = c.Check();
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].remedy == "these look like millimetres: write 0.6, 0, 0.1");
}

TEST_CASE("A nominal pose of a real scanner is a doubt", "[unit]") {
  Case c;
  const auto findings =
      CheckCell({c.model, c.bin, c.part, ScanPosesOf(c.model, c.bin), c.count, true});
  CHECK(findings.back().what == "pose of the scanner");
  CHECK(WorstOf(findings) == Verdict::kDoubtful);
}

}  // namespace tubetwin

#include <algorithm>
#include <cmath>

#include "models/base/text.h"
#include "models/clearance.h"
#include "planner/cell_check/cell_check.h"

namespace tubetwin {
namespace {

using Verdict = Finding::Verdict;

/// No cell's tool or arm is larger: such a number was meant in millimetres.
constexpr double kLongestTool_m = 1.0, kFarthest_m = 6.0;
constexpr double kApart_m = 0.01;  // what stands this near was hardly meant to

std::string Rounded(double value, double step) { return Number(std::round(value / step) * step); }
std::string Millimetres(double length_m) { return Rounded(1e3 * length_m, 1.0) + " mm"; }

}  // namespace

std::vector<Finding> CheckUnits(const CellModel& model, const Bin& bin) {
  const CellLayout& layout = model.layout;
  const bool flange = layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  struct Pose {
    const char* name;
    Vector3 p;
    double longest_m;
  };
  const std::vector<Pose> poses = {
      {"X_FK", layout.X_FK.translation(), kLongestTool_m},
      {"X_FE", layout.X_FE.translation(), kLongestTool_m},
      {flange ? "X_FS" : "X_BS", (flange ? layout.X_FS : layout.X_BS).translation(),
       flange ? kLongestTool_m : kFarthest_m},
      {"X_BN", bin.X_BN.translation(), kFarthest_m},
      {"X_BT", layout.X_BT.translation(), kFarthest_m},
  };
  std::vector<Finding> findings;
  for (const Pose& pose : poses) {
    if (pose.p.norm() <= pose.longest_m) continue;
    const Vector3 metres = 1e-3 * pose.p;
    findings.push_back(
        {Verdict::kImpossible, pose.name,
         Number(pose.p.x()) + ", " + Number(pose.p.y()) + ", " + Number(pose.p.z()) + " m",
         "within " + Number(pose.longest_m) + " m",
         metres.norm() <= pose.longest_m
             ? "these look like millimetres: write " + Number(metres.x()) + ", " +
                   Number(metres.y()) + ", " + Number(metres.z())
             : "measure it in metres"});
  }
  if (findings.empty() && layout.X_FE.translation().z() <= layout.X_FK.translation().z()) {
    findings.push_back(
        {Verdict::kImpossible, "X_FE",
         Millimetres(layout.X_FE.translation().z()) + " beyond the flange",
         "beyond the sensor's tool face, " + Millimetres(layout.X_FK.translation().z()),
         "X_FE is the middle between the closed pads: measure it from the flange"});
  }
  return findings;
}

std::vector<Finding> CheckStanding(const CellModel& model, const Bin& bin) {
  std::vector<Finding> findings;
  for (const StandingPair& pair : StandingClearances(model, bin)) {
    if (pair.clearance_m >= kApart_m) continue;
    const bool through = pair.clearance_m < 0.0;
    findings.push_back({through ? Verdict::kImpossible : Verdict::kDoubtful,
                        pair.a + " and " + pair.b,
                        through ? "reach " + Millimetres(-pair.clearance_m) + " into each other"
                                : Millimetres(pair.clearance_m) + " apart",
                        "at least " + Millimetres(kApart_m) + " apart",
                        "move the " + pair.a + " (" + pair.remedy_key + ") or the " + pair.b +
                            ", or make one smaller"});
  }
  if (findings.empty()) {
    findings.push_back({Verdict::kOk, "bin, tray, base and stands", "apart", "", ""});
  }
  return findings;
}

Finding CheckFill(const Bin& bin, const Part& part, int count) {
  constexpr double kHeaped = 0.35;  // tubes fall to about that much
  constexpr double kFull = 0.9;
  const double tubes_m3 = count * kPi * part.radius_m * part.radius_m * part.length_m;
  const double bin_m3 = bin.size_m[0] * bin.size_m[1] * bin.size_m[2];
  const double fill = tubes_m3 / bin_m3;
  Finding finding{Verdict::kOk, "fill of the bin", Rounded(100.0 * fill, 1.0) + " % of its volume",
                  "at most 35 %", ""};
  if (fill > kHeaped) {
    const int fewer = static_cast<int>(kHeaped / fill * count);
    finding.verdict = fill > kFull ? Verdict::kImpossible : Verdict::kDoubtful;
    finding.remedy = "at most " + std::to_string(fewer) +
                     " tubes lie below the rim: fewer tubes, or a larger bin (bin.size_m)";
  }
  return finding;
}

}  // namespace tubetwin

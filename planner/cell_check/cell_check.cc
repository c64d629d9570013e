#include "planner/cell_check/cell_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/base/text.h"

namespace tubetwin {
namespace {

using Verdict = Finding::Verdict;

std::string Percent(double share) { return Number(std::round(100.0 * share)) + " %"; }

/// A share that should be nearly all: below `possible` nothing can come of it.
Finding Share(const std::string& what, double share, double wanted, double possible,
              const std::string& remedy) {
  const Verdict verdict = share >= wanted     ? Verdict::kOk
                          : share >= possible ? Verdict::kDoubtful
                                              : Verdict::kImpossible;
  return {verdict, what, Percent(share), "at least " + Percent(wanted),
          verdict == Verdict::kOk ? "" : remedy};
}

std::string Place(const Vector3& p_N) {
  return "(" + Number(std::round(1e2 * p_N.x()) / 1e2) + ", " +
         Number(std::round(1e2 * p_N.y()) / 1e2) + ") m from the bin's middle";
}

void AddReach(const CellCheckInput& input, std::vector<Finding>& findings) {
  const ReachShares reach = ReachOf(input);
  std::string nearer =
      "move the bin (bin.X_BN) to where the arm's wrist is bent, or take another one; not reached, "
      "for instance: " +
      Place(reach.first_missed_N);
  // Bin, tray and station together are rarely all wrong.
  if (reach.floor_upright == 0.0 && reach.tray == 0.0 && reach.station == 0.0) {
    nearer =
        "nothing is reached: working_deg of the arm may be of a family that does not get there, or "
        "X_FE is wrong; else " +
        nearer;
  }
  findings.push_back(Share("bin's floor reached upright", reach.floor_upright, 0.70, 0.1, nearer));
  findings.push_back(
      Share("bin's floor reached leaning by 20 degrees", reach.floor_leaning, 0.85, 0.0, nearer));
  findings.push_back(Share("tray's slots reached", reach.tray, 0.98, 0.25,
                           "move the tray (tray.X_BT) or make its zone smaller (tray.zone_m)"));
  findings.push_back(Share("tilts of 45 degrees at the station", reach.station, 0.70, 0.0,
                           "move the station (station.p_BTilt)"));
  const bool flange = input.model.layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  findings.push_back(
      Share(flange ? "views reached" : "place reached where the arm waits for the scanner",
            reach.views, 1.0, flange ? 0.25 : 1.0,
            flange ? "give [[scan_pose]]s that the arm reaches, or change scan.height_m"
                   : "move scanner_mount.p_BClear"));
}

void AddCoverage(const CellCheckInput& input, std::vector<Finding>& findings) {
  const CoverageShares coverage = CoverageOf(input);
  if (input.model.layout.scanner_mount == CellLayout::ScannerMount::kStand) {
    findings.push_back(Share("bin's floor seen past the waiting arm", 1.0 - coverage.behind_arm,
                             0.99, 0.5, "move scanner_mount.p_BClear out of the scanner's view"));
  }
  const bool flange = input.model.layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  const std::string remedy =
      flange
          ? "more views ([[scan_pose]], scan.views), or a scanner with a larger field"
          : "move or turn the scanner (scanner_mount.X_BS, calibration.X_BS), or take one with a "
            "larger field";
  findings.push_back(Share("bin's floor seen by the scanner", coverage.floor, 0.97, 0.5, remedy));
  findings.push_back(Share("tubes along the walls seen", coverage.walls, 0.90, 0.25, remedy));
}

void AddHeights(const CellCheckInput& input, std::vector<Finding>& findings) {
  const double carry_m = input.model.layout.carry_height_m, wall_m = input.bin.wall_m();
  const bool over = carry_m > wall_m + input.part.radius_m;
  findings.push_back({over ? Verdict::kOk : Verdict::kImpossible, "height of carrying",
                      Number(carry_m) + " m over the bin's floor",
                      "over the walls, " + Number(wall_m) + " m",
                      over ? "" : "raise carry.height_m or take lower walls (bin.size_m)"});
}

}  // namespace

std::vector<Finding> CheckArm(const ArmModel& arm) {
  constexpr double kAlong_deg = 1.0, kDown_deg = 10.0;
  const auto between_deg = [](const Vector3& a, const Vector3& b) {
    return Degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
  };
  std::vector<Finding> findings;
  const Vector3 z_6 = arm.X_6F.linear().col(2), axis_6 = arm.joints[kNumJoints - 1].axis;
  const double off_deg = std::min(between_deg(z_6, axis_6), between_deg(z_6, -axis_6));
  findings.push_back({off_deg <= kAlong_deg ? Verdict::kOk : Verdict::kDoubtful,
                      "flange of the arm",
                      Number(std::round(off_deg)) + " degrees between its z and the last axis",
                      "at most " + Number(kAlong_deg),
                      off_deg <= kAlong_deg ? "" : "z points out of the flange: flange_rpy_deg"});
  const double down_deg =
      between_deg(FlangePose(arm, arm.working.q).linear().col(2), -Vector3::UnitZ());
  findings.push_back(
      {down_deg <= kDown_deg ? Verdict::kOk : Verdict::kDoubtful, "working posture of the arm",
       Number(std::round(down_deg)) + " degrees between its flange and straight down",
       "at most " + Number(kDown_deg),
       down_deg <= kDown_deg ? "" : "working_deg is a posture with the tool down"});
  return findings;
}

std::vector<Finding> CheckCell(const CellCheckInput& input) {
  std::vector<Finding> findings = CheckUnits(input.model, input.bin);
  if (!findings.empty()) return findings;
  findings = CheckArm(input.model.arm);
  for (Finding& finding : CheckStanding(input.model, input.bin)) {
    findings.push_back(std::move(finding));
  }
  AddHeights(input, findings);
  if (input.count > 0) findings.push_back(CheckFill(input.bin, input.part, input.count));
  // Where the bin stands in something, reach and coverage of it say nothing.
  if (WorstOf(findings) == Verdict::kImpossible) return findings;
  AddReach(input, findings);
  AddCoverage(input, findings);
  if (input.nominal_scanner_pose) {
    findings.push_back({Verdict::kDoubtful, "pose of the scanner",
                        "the cell model's nominal one, on a real device",
                        "as measured in this cell",
                        "measure it and write calibration.X_FS (or X_BS on a stand)"});
  }
  return findings;
}

}  // namespace tubetwin

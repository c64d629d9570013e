#include "planner/cell_check/cell_check.h"

#include <cmath>

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
  const std::string nearer =
      "move the bin nearer to the arm or away from its base (bin.X_BN), or "
      "take a smaller one; not reached, for instance: " +
      Place(reach.first_missed_N);
  findings.push_back(Share("bin's floor reached upright", reach.floor_upright, 0.98, 0.5, nearer));
  findings.push_back(
      Share("bin's floor reached leaning by 20 degrees", reach.floor_leaning, 0.90, 0.0, nearer));
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
  const bool flange = input.model.layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  const std::string remedy =
      flange ? "more views ([[scan_pose]], scan.views), or a scanner with a larger field"
             : "move or turn the scanner (calibration.X_BS), or take one with a larger field";
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

std::vector<Finding> CheckCell(const CellCheckInput& input) {
  std::vector<Finding> findings = CheckUnits(input.model, input.bin);
  if (!findings.empty()) return findings;
  findings = CheckStanding(input.model, input.bin);
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

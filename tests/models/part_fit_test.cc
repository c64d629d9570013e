#include "models/part_fit/part_fit.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

using Verdict = Finding::Verdict;

/// The finding about `what`.
Finding About(const std::string& what, const Part& part,
              const PartFitCell& cell = PartFitCell(PaperCell())) {
  for (const Finding& finding : JudgePart(part, cell)) {
    if (finding.what.find(what) != std::string::npos) return finding;
  }
  FAIL("nothing about " << what);
  return {};
}

void CheckVerdict(const Finding& finding, Verdict verdict) {
  INFO(finding.what << ": " << finding.found << "; " << finding.allowed << "; " << finding.remedy);
  CHECK(std::string(ToString(finding.verdict)) == ToString(verdict));
  // A remedy where one is needed, and nowhere else.
  CHECK(finding.remedy.empty() == (finding.verdict == Verdict::kOk));
  CHECK_FALSE(finding.found.empty());
  CHECK_FALSE(finding.allowed.empty());
}

TEST_CASE("The shipped parts go with the shipped devices", "[unit]") {
  for (const std::string& name : PartNames()) {
    for (const Finding& finding : JudgePart(LoadPart(name), PartFitCell(PaperCell()))) {
      INFO(name);
      CheckVerdict(finding, Verdict::kOk);
    }
  }
}

TEST_CASE("A diameter is judged by the room that the stroke leaves on either side", "[unit]") {
  Part part = LoadPart("hose_b");
  const auto with = [&](double radius_m, double stroke_m) {
    part.radius_m = radius_m;
    PartFitCell cell(PaperCell());
    cell.gripper.stroke_m = stroke_m;
    return About("gripper", part, cell);
  };
  CheckVerdict(with(0.0315, 0.085), Verdict::kOk);
  CheckVerdict(with(0.0316, 0.085), Verdict::kDoubtful);
  CheckVerdict(with(0.0379, 0.085), Verdict::kDoubtful);
  CheckVerdict(with(0.038, 0.085), Verdict::kImpossible);  // 76 mm in 85 mm: no plan.
  CheckVerdict(with(0.038, 0.140), Verdict::kOk);
  CHECK_THAT(with(0.038, 0.085).found, Catch::Contains("76 mm of 85 mm, room of 4.5 mm a side"));
  CHECK_THAT(with(0.038, 0.085).remedy, Catch::Contains("stroke of 98 mm"));
  CHECK_THAT(with(0.06, 0.085).found, Catch::Contains("room of 0 mm"));
}

TEST_CASE("A weight is judged by the grip's friction", "[unit]") {
  Part part = LoadPart("pvc_a");
  PartFitCell cell(PaperCell());
  cell.pad_friction = 0.5;
  cell.grip_force_N = 20.0;
  cell.gripper.max_force_N = 40.0;
  cell.carry_acceleration_m_s2 = 0.19;
  // Friction holds 20 N, at most 40 N; carrying takes 10 N a kilogram.
  const auto with = [&](double mass_kg) {
    part.mass_kg = mass_kg;
    return About("weight in the grip", part, cell);
  };
  CheckVerdict(with(1.99), Verdict::kOk);
  CheckVerdict(with(2.01), Verdict::kDoubtful);
  CHECK_THAT(with(2.01).remedy, Catch::Contains("cycle.grip_force_N = 21"));
  CheckVerdict(with(3.99), Verdict::kDoubtful);
  CheckVerdict(with(4.01), Verdict::kImpossible);
  CHECK_THAT(with(4.01).remedy, Catch::Contains("41 N per pad"));
}

TEST_CASE("A weight is judged by the sensor's counts", "[unit]") {
  Part part = LoadPart("pvc_a");
  const auto with = [&](double mass_kg) {
    part.mass_kg = mass_kg;
    return About("sensor", part);
  };
  CheckVerdict(with(0.0256), Verdict::kOk);  // 10.05 counts of 1/40 N.
  CheckVerdict(with(0.0254), Verdict::kDoubtful);
  CHECK_THAT(with(0.0254).remedy, Catch::Contains("from 25 g"));
  CheckVerdict(with(0.0052), Verdict::kDoubtful);
  CheckVerdict(with(0.0050), Verdict::kImpossible);
  CHECK_THAT(with(0.055).found, Catch::Contains("0.54 N = 22 counts, F_tol 0.27 N"));
  PartFitCell small(PaperCell());
  small.max_reading_N = 10.0;
  part.mass_kg = 1.1;
  CheckVerdict(About("sensor", part, small), Verdict::kImpossible);
}

TEST_CASE("Points of a scan follow from the scanner's pitch on the bin's floor", "[unit]") {
  Part part = LoadPart("pvc_a");
  PartFitCell cell(PaperCell());
  cell.scan_distance_m = 0.5;
  cell.scanner.focal_px = 1000.0;  // Half a millimetre apart in full, one in a half image.
  cell.scanner.full_width = 2000;
  cell.scan_width = 1000;
  CHECK_THAT(About("points", part, cell).found,
             Catch::Contains("25 across, 500 along (1 mm apart"));
  CheckVerdict(About("points", part, cell), Verdict::kOk);
  part.radius_m = 0.009;
  CheckVerdict(About("points", part, cell), Verdict::kDoubtful);
  CHECK_THAT(About("points", part, cell).remedy, Catch::Contains("36 across"));
  cell.scan_width = 2000;
  CheckVerdict(About("points", part, cell), Verdict::kOk);
  cell.scanner.focal_px = 150.0;
  CheckVerdict(About("points", part, cell), Verdict::kImpossible);
  CHECK_THAT(About("points", part, cell).remedy, Catch::Contains("0.95 mm apart"));
}

TEST_CASE("The scanner's distance is that of the cell: planned, listed or on a stand", "[unit]") {
  const auto distance_m = [](const CellModel& model) { return PartFitCell(model).scan_distance_m; };
  CHECK(distance_m(PaperCell()) == Approx(0.515));
  CHECK(distance_m(LoadCellModel("gp12_stand")) == Approx(1.15));
  CellModel listed = PaperCell();
  const Vector3 p_BN = listed.layout.X_BN.translation();
  const Matrix3 leaning = RotX(kPi - Radians(30.0));
  listed.layout.scan_poses_BS = {MakeTransform(RotX(kPi), p_BN + Vector3(0.1, 0.0, 0.4)),
                                 MakeTransform(leaning, p_BN + Vector3(0.0, 0.2, 0.6))};
  CHECK(distance_m(listed) == Approx(0.5 * (0.4 + 0.6 / std::cos(Radians(30.0)))));
}

TEST_CASE("A bend is judged by how much of it another tube hides", "[unit]") {
  Part part = LoadPart("pvc_a");
  part.shape = "fixed";
  part.radius_m = 0.01;
  part.length_m = 0.2;
  // A corner of 90 degrees: within 40 mm up to 80.5 degrees look like one tube.
  part.centerline_m = {0, 0, 0, 0.1, 0, 0, 0.1, 0.1, 0};
  CheckVerdict(About("bend", part), Verdict::kDoubtful);
  CHECK_THAT(About("bend", part).found, Catch::Contains("90 degrees within 40 mm"));
  part.centerline_m = {0, 0, 0, 0.1, 0, 0, 0.2, 0.1, 0};
  CheckVerdict(About("bend", part), Verdict::kOk);
  // Two corners of 45 degrees count together within 40 mm, and apart beyond.
  part.centerline_m = {0, 0, 0, 0.1, 0, 0, 0.121, 0.021, 0, 0.121, 0.1, 0};
  CheckVerdict(About("bend", part), Verdict::kDoubtful);
  part.centerline_m = {0, 0, 0, 0.1, 0, 0, 0.13, 0.03, 0, 0.13, 0.1, 0};
  CheckVerdict(About("bend", part), Verdict::kOk);
}

TEST_CASE("A soft hose is said to hang like a rope", "[unit]") {
  Part part = LoadPart("hose_b");
  CHECK_THAT(About("sag", part).found, Catch::Contains("3.6 mm, 10.8 mm at the softest, of 200"));
  part.bending_stiffness_range_Nm2[0] = 0.005;
  CheckVerdict(About("sag", part), Verdict::kOk);  // 86 of 200 mm.
  part.length_m = 0.6;
  CheckVerdict(About("sag", part), Verdict::kDoubtful);
  part.kind = "rigid";
  for (const Finding& finding : JudgePart(part, PartFitCell(PaperCell()))) {
    CHECK(finding.what.find("sag") == std::string::npos);
  }
}

TEST_CASE("What the search was fitted to is said", "[unit]") {
  CHECK_THAT(About("search", LoadPart("hose_b")).found, Catch::Contains("fitted to this part"));
  CHECK_THAT(About("search", LoadPart("pvc_a")).found,
             Catch::Contains("default, fitted to hose_b; not measured for this part"));
  Part own = LoadPart("pvc_a");
  own.search.fitted_to = "pvc_a";
  CHECK_THAT(About("search", own).found, Catch::Contains("fitted to this part"));
}

TEST_CASE("The worst finding is the verdict", "[unit]") {
  CHECK(WorstOf({}) == Verdict::kOk);
  Finding ok, doubtful, impossible;
  doubtful.verdict = Verdict::kDoubtful;
  impossible.verdict = Verdict::kImpossible;
  CHECK(WorstOf({ok, doubtful, ok}) == Verdict::kDoubtful);
  CHECK(WorstOf({impossible, doubtful}) == Verdict::kImpossible);
}

}  // namespace
}  // namespace tubetwin

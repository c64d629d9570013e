#include "models/part_fit/part_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "models/base/frames.h"
#include "models/part_fit/cantilever.h"

namespace tubetwin {
namespace {

using Verdict = Finding::Verdict;

/// A weight of so many counts is told from twice of it, of so many hardly: the limit of one tube is
/// half its weight away (F_tol), which should be some counts and must be one.
constexpr double kGoodCounts = 10.0, kLeastCounts = 2.0;
/// Points across the diameter on the floor with which tubes are modelled well, and below which they
/// are not. Four bent tubes, eight views: with 15 and 17 across one of four was found, with 20 and
/// 29 all.
constexpr double kGoodAcross = 19.0, kLeastAcross = 15.5;
/// What another tube of the kind hides of a tube, in radii: itself and as much for the shadows.
constexpr double kHiddenRadii = 4.0;
/// Hooks of the shape "hooks" (scenes/draw_shape.cc).
constexpr double kHookedAt_m = 0.05;
/// A half that sags by more than this share of its length hangs rather than bends.
constexpr double kRope = 0.5;

/// "%.*f unit" without trailing zeros.
std::string Text(double value, int digits, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  std::string out = text;
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out + " " + unit;
}

std::string Whole(double value) { return std::to_string(std::lround(std::ceil(value))); }
std::string Mm(double m) { return Text(1e3 * m, 1, "mm"); }
std::string Newtons(double N) { return Text(N, N < 1.0 ? 3 : 1, "N"); }

/// From the camera to the bin's floor along its view, on average where views are listed.
double DistanceToFloor(const CellLayout& layout) {
  const bool stand = layout.scanner_mount == CellLayout::ScannerMount::kStand;
  if (!stand && layout.scan_poses_BS.empty()) return layout.scan_height_m;
  const std::vector<RigidTransform> stands = {layout.X_BS};
  const std::vector<RigidTransform>& poses_BS = stand ? stands : layout.scan_poses_BS;
  double sum_m = 0.0;
  for (const RigidTransform& X_BS : poses_BS) {
    const Vector3 to_floor = layout.X_BN.translation() - X_BS.translation();
    sum_m += to_floor.z() / X_BS.linear()(2, 2);
  }
  return sum_m / static_cast<double>(poses_BS.size());
}

Finding JudgeOpening(const Part& part, const PartFitCell& cell) {
  const double stroke_m = cell.gripper.stroke_m;
  const double room_m = 0.5 * stroke_m - part.radius_m;
  Finding out;
  out.what = "diameter in the gripper";
  out.found = Mm(2.0 * part.radius_m) + " of " + Mm(stroke_m) + ", room of " +
              Mm(std::max(0.0, room_m)) + " a side to open around it";
  out.allowed = "more than " + Mm(cell.least_side_room_m) + " a side, in a pile better " +
                Mm(cell.easy_side_room_m);
  // Of exactly the least room nothing is left for the first error.
  if (room_m <= cell.least_side_room_m + 1e-9) {
    out.verdict = Verdict::kImpossible;
    out.remedy = "a gripper with a stroke of " + Mm(2.0 * (part.radius_m + cell.easy_side_room_m)) +
                 ", or a thinner part";
  } else if (room_m < cell.easy_side_room_m) {
    out.verdict = Verdict::kDoubtful;
    out.remedy = "expect few grasps among neighbours; easy with a stroke of " +
                 Mm(2.0 * (part.radius_m + cell.easy_side_room_m));
  }
  return out;
}

Finding JudgeGrip(const Part& part, const PartFitCell& cell) {
  const double needed_N = part.mass_kg * (kGravity + cell.carry_acceleration_m_s2);
  const double held_N = 2.0 * cell.pad_friction * cell.grip_force_N;
  const double most_N = 2.0 * cell.pad_friction * cell.gripper.max_force_N;
  Finding out;
  out.what = "weight in the grip";
  out.found = "carrying takes " + Newtons(needed_N);
  out.allowed = "friction " + Text(cell.pad_friction, 2, "holds ") + Newtons(held_N) + " at " +
                Text(cell.grip_force_N, 0, "N") + " per pad, " + Newtons(most_N) + " at " +
                Text(cell.gripper.max_force_N, 0, "N");
  const double force_N = needed_N / (2.0 * cell.pad_friction);
  if (needed_N > most_N) {
    out.verdict = Verdict::kImpossible;
    out.remedy = "a gripper of " + Whole(force_N) + " N per pad, or pads of higher friction";
  } else if (needed_N > held_N) {
    out.verdict = Verdict::kDoubtful;
    out.remedy = "it slips; set cycle.grip_force_N = " + Whole(force_N);
  }
  return out;
}

Finding JudgeWeight(const Part& part, const PartFitCell& cell) {
  const double weight_N = part.mass_kg * kGravity, counts = weight_N / cell.count_N;
  const double error_N = std::hypot(cell.noise_N, cell.drift_N);
  Finding out;
  out.what = "weight on the sensor";
  out.found = Newtons(weight_N) + " = " + Text(counts, counts < 10.0 ? 1 : 0, "counts") +
              ", F_tol " + Newtons(0.5 * weight_N);
  out.allowed = "at least " + Text(kGoodCounts, 0, "counts") + " of " + Newtons(cell.count_N) +
                "; noise and ten minutes of drift are " + Newtons(error_N);
  if (weight_N > cell.max_reading_N) {
    out.verdict = Verdict::kImpossible;
    out.allowed = "at most " + Newtons(cell.max_reading_N);
    out.remedy = "a sensor of a larger range";
  } else if (counts < kLeastCounts) {
    out.verdict = Verdict::kImpossible;
    out.remedy = "a sensor with counts of " + Newtons(weight_N / kGoodCounts) +
                 " or finer: one tube cannot be told from none";
  } else if (counts < kGoodCounts) {
    out.verdict = Verdict::kDoubtful;
    out.remedy = "one and two tubes may be mistaken; safe from " +
                 Text(1e3 * kGoodCounts * cell.count_N / kGravity, 0, "g") + " on";
  }
  return out;
}

Finding JudgePoints(const Part& part, const PartFitCell& cell) {
  const ScannerSpec& s = cell.scanner;
  const double pitch_m = cell.scan_distance_m / s.focal_px * s.full_width / cell.scan_width;
  const double across = 2.0 * part.radius_m / pitch_m, along = part.length_m / pitch_m;
  Finding out;
  out.what = "points of a scan";
  out.found = Text(across, 0, "across") + ", " + Text(along, 0, "along") + " (" +
              Text(1e3 * pitch_m, 2, "mm") + " apart at " + Mm(cell.scan_distance_m) + ")";
  out.allowed = "at least " + Text(kGoodAcross, 0, "across");
  if (across < kGoodAcross) {
    out.verdict = across < kLeastAcross ? Verdict::kImpossible : Verdict::kDoubtful;
    const double full = across * s.full_width / cell.scan_width;
    out.remedy = full >= kGoodAcross
                     ? "scan.resolution = " + std::to_string(s.full_width) + "x" +
                           std::to_string(s.full_height) + ": " + Text(full, 0, "across")
                     : "a scanner of a smaller field: points " +
                           Text(2e3 * part.radius_m / kGoodAcross, 2, "mm") + " apart";
  }
  return out;
}

/// Largest turn of the axis within a piece of `gap_m`, radians, as the part's shapes are drawn.
double SharpestTurn(const Part& part, double gap_m) {
  if (part.shape == "hooks") return std::min(gap_m / kHookedAt_m, Radians(part.bend_deg[1]));
  if (part.shape == "polyline") return Radians(part.bend_deg[1]);
  if (part.shape == "arcs") {
    return Radians(part.bend_deg[1]) * part.bends[1] * gap_m / part.length_m;
  }
  const Polyline line = part.centerline();
  const std::vector<double> at = ArcLengths(line);
  double sharpest = 0.0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    double turn = 0.0;
    for (std::size_t k = i; k + 1 < line.size() && at[k] - at[i] <= gap_m; ++k) {
      const Vector3 in = line[k] - line[k - 1], out = line[k + 1] - line[k];
      turn += std::atan2(in.cross(out).norm(), in.dot(out));
    }
    sharpest = std::max(sharpest, turn);
  }
  return sharpest;
}

Finding JudgeBends(const Part& part, const PartFitCell& cell) {
  const double gap_m = kHiddenRadii * part.radius_m;
  const double turn = SharpestTurn(part, gap_m), even = std::sqrt(cell.even_turn_m / gap_m);
  Finding out;
  out.what = "sharpest bend under another tube";
  out.found = Text(Degrees(turn), 0, "degrees") + " within " + Mm(gap_m);
  out.allowed = "up to " + Text(Degrees(even), 0, "degrees") +
                " the two sides look like one tube rather than two";
  if (turn > even) {
    out.verdict = Verdict::kDoubtful;
    out.remedy = "expect tubes to be cut or joined wrongly where a bend is hidden; more views help";
  }
  return out;
}

Finding JudgeSag(const Part& part) {
  const double half_m = 0.5 * part.length_m, weight_N_m = part.mass_kg * kGravity / part.length_m;
  const double sag_m = CantileverSag(weight_N_m, half_m, part.bending_stiffness_Nm2);
  const double most_m = CantileverSag(weight_N_m, half_m, part.bending_stiffness_range_Nm2[0]);
  Finding out;
  out.what = "sag of a half, held in the middle";
  out.found = Mm(sag_m) + ", " + Mm(most_m) + " at the softest, of " + Mm(half_m);
  out.allowed = "up to " + Mm(kRope * half_m);
  if (most_m > kRope * half_m) {
    out.verdict = Verdict::kDoubtful;
    out.remedy = "it hangs like a rope: it is laid down bent, and drags along what it hangs over";
  }
  return out;
}

Finding JudgeSearch(const Part& part) {
  Finding out;
  out.what = "fitted numbers of the search";
  const bool own = part.search.fitted_to == part.name;
  out.found = own ? "fitted to this part"
                  : "default, fitted to " + part.search.fitted_to + "; not measured for this part";
  out.allowed = "any; own numbers choose better among motions that may bring another tube along";
  return out;
}

}  // namespace

PartFitCell::PartFitCell(const CellModel& model)
    : gripper(model.gripper),
      scanner(model.scanner),
      count_N(model.wrist.count[2]),
      noise_N(model.wrist.count[2]),
      max_reading_N(model.wrist.range[2]),
      scan_width(SizeOfScan(model.scanner, "").width),
      scan_distance_m(DistanceToFloor(model.layout)) {}

std::vector<Finding> JudgePart(const Part& part, const PartFitCell& cell) {
  std::vector<Finding> out = {JudgeOpening(part, cell), JudgeGrip(part, cell),
                              JudgeWeight(part, cell), JudgePoints(part, cell),
                              JudgeBends(part, cell)};
  if (part.is_hose()) out.push_back(JudgeSag(part));
  out.push_back(JudgeSearch(part));
  return out;
}

}  // namespace tubetwin

#include "perception/calibration/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

#include "models/base/error.h"
#include "models/base/text.h"
#include "perception/calibration/pose_variety.h"
#include "perception/calibration/solver.h"
#include "perception/view/bin_evidence.h"
#include "perception/view/floor_ways.h"

namespace tubetwin {
namespace {

using namespace calibration_internal;

/// Edges of walls and pixels between two surfaces: this share of a view's points may be off.
constexpr double kEdges = 0.05;
/// More points inside the bin than this share are parts, not noise.
constexpr double kMaxInside = 0.01;
/// What is looked for must be known this well in each direction.
constexpr double kMaxSigma_m = 0.001;
/// Of the floor, to see whether it leans; of the walls, to see yaw and place twice over.
constexpr std::size_t kFewestFloorTouches = 3, kFewestWallTouches = 4;
/// Touches this near to two walls may be of either.
constexpr double kCorner_m = 0.03;
constexpr double kTouchSlack_m = 0.01;  ///< A tip is round, a rim is rounded.

[[noreturn]] void Refuse(const std::string& why) { throw Error(ErrorKind::kBadData, why); }

/// Of N's z axis against B's.
double LeanOf(const RigidTransform& X_NB) {
  return std::acos(std::clamp(X_NB.linear()(2, 2), -1.0, 1.0));
}

double TurnOf(const Matrix3& R) { return Eigen::AngleAxisd(R).angle(); }

/// A pose whose z axis is up, with the place and yaw of `X`.
RigidTransform Level(const RigidTransform& X) {
  const Vector3 x = X.linear().col(0);
  return MakeTransform(RotZ(std::atan2(x.y(), x.x())), X.translation());
}

std::vector<std::vector<SurfacePoint>> SurfacePoints(const CalibrationInput& input,
                                                     Parallelism parallelism) {
  std::vector<std::vector<SurfacePoint>> out(input.views.size());
  ParallelFor(static_cast<int>(out.size()), parallelism, [&](int i, int) {
    const auto v = static_cast<std::size_t>(i);
    out[v] = SurfacePointsOf(input.views[v].cloud);
  });
  return out;
}

/// The clouds with X_NS as they would be with the bin's frame in place of B.
std::vector<OrganizedCloud> CloudsIn(const CalibrationInput& input, const RigidTransform& X_NB,
                                     const RigidTransform& X_FS) {
  std::vector<OrganizedCloud> out;
  for (const CalibrationView& view : input.views) {
    out.push_back(view.cloud);
    out.back().X_NS = X_NB * view.X_BF * X_FS;
  }
  return out;
}

/// Where the bin may be, best first: as floor and walls alone tell, turned nearest to what is said;
/// then what is said.
std::vector<RigidTransform> BinStarts(const CalibrationInput& input) {
  std::vector<RigidTransform> out;
  const RigidTransform& X_BN = input.bin.X_BN;
  if (!input.views.empty()) {
    const auto clouds = CloudsIn(input, RigidTransform::Identity(), input.X_FS);
    for (const FloorWay& way : FindFloorWays(clouds, input.bin).ways) {
      for (const RigidTransform& turn : TurnsOf(input.bin)) {
        out.push_back((turn * way.X_NC).inverse());
      }
    }
    std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
      const auto off = [&](const RigidTransform& X) {
        return kLever_m * TurnOf(X.linear().transpose() * X_BN.linear()) +
               (X.translation() - X_BN.translation()).norm();
      };
      return off(a) < off(b);
    });
    if (out.size() > 1) out.resize(1);
  }
  out.push_back(X_BN);
  return out;
}

void RequireTouches(const CalibrationInput& input) {
  if (input.touches.empty()) return;
  std::size_t floor = 0;
  for (const CalibrationTouch& touch : input.touches) floor += touch.on_floor;
  const std::size_t walls = input.touches.size() - floor;
  if (input.views.empty() && (floor < kFewestFloorTouches || walls < kFewestWallTouches)) {
    Refuse("there are " + std::to_string(floor) + " touches of the floor and " +
           std::to_string(walls) + " of walls; needed are " + std::to_string(kFewestFloorTouches) +
           " of the floor, far apart, and " + std::to_string(kFewestWallTouches) +
           " of walls, two of them far apart on one and at least one on a wall that meets it");
  }
}

/// Throws unless floor and two walls that meet are among the groups.
void RequirePlanes(const std::vector<PlanePoints>& groups) {
  std::set<std::size_t> seen;
  for (const PlanePoints& group : groups) seen.insert(group.plane);
  const bool along_x = seen.count(1) + seen.count(2) > 0,
             along_y = seen.count(3) + seen.count(4) > 0;
  if (seen.count(0) > 0 && along_x && along_y) return;
  std::vector<std::string> names;
  for (const std::size_t k : seen) names.emplace_back(NameOfPlane(k));
  Refuse("of the bin " + (names.empty() ? "nothing" : "only " + Join(names)) +
         " is found where it is thought to be; needed are its floor and two walls that meet: look "
         "into a corner, and check bin.size_m, bin.X_BN and the poses of the views");
}

/// Floor is touched between the walls, walls between floor and rim: else it was something else, or
/// the bin is found in a wrong place.
void RequireInside(const CalibrationTouch& touch, const Vector3& p_N, const Bin& bin) {
  const double beyond_m = touch.on_floor ? std::max(std::abs(p_N.x()) - bin.half_x_m(),
                                                    std::abs(p_N.y()) - bin.half_y_m())
                                         : std::max(-p_N.z(), p_N.z() - bin.wall_m());
  if (beyond_m <= kTouchSlack_m) return;
  char text[200];
  std::snprintf(text, sizeof text,
                ": lies %.0f mm %s of the bin that all touches and views together tell; look "
                "whether floor and wall are named rightly, and at bin.size_m",
                1e3 * beyond_m,
                touch.on_floor ? "beyond a wall" : "under the floor or over the rim");
  Refuse(touch.name + text);
}

void RequireClearTouches(const CalibrationInput& input, const RigidTransform& X_NB) {
  for (const CalibrationTouch& touch : input.touches) {
    const Vector3 p_N = X_NB * touch.p_B;
    const double to_x = std::abs(std::abs(p_N.x()) - input.bin.half_x_m());
    const double to_y = std::abs(std::abs(p_N.y()) - input.bin.half_y_m());
    if (!touch.on_floor && std::max(to_x, to_y) < kCorner_m) {
      char text[160];
      std::snprintf(text, sizeof text,
                    ": is %.0f and %.0f mm from two walls, so it may be of either: touch walls at "
                    "least 30 mm from a corner",
                    1e3 * to_x, 1e3 * to_y);
      Refuse(touch.name + text);
    }
    RequireInside(touch, p_N, input.bin);
  }
}

/// Residuals of all groups and over all.
void SetResiduals(const PlaneSolver& solver, const CalibrationInput& input,
                  const std::vector<PlanePoints>& groups, const Estimate& at, Calibration& out) {
  double sum = 0.0, count = 0.0;
  out.residuals.clear();
  for (const PlanePoints& group : groups) {
    std::vector<double> off_m = solver.Distances(group, at);
    for (double& d : off_m) d = std::abs(d);
    std::sort(off_m.begin(), off_m.end());
    if (group.seen) {
      off_m.resize(off_m.size() -
                   static_cast<std::size_t>(kEdges * static_cast<double>(off_m.size())));
    }
    double squares = 0.0;
    for (const double d : off_m) squares += d * d;
    const double n = static_cast<double>(off_m.size());
    const std::string& name = group.seen ? input.views[group.source].name
                                         : input.touches[group.source - input.views.size()].name;
    out.residuals.push_back(
        {name, NameOfPlane(group.plane), static_cast<int>(off_m.size()), std::sqrt(squares / n)});
    sum += squares;
    count += n;
  }
  out.rms_m = std::sqrt(sum / count);
}

const PlaneResidual& Worst(const Calibration& found) {
  return *std::max_element(found.residuals.begin(), found.residuals.end(),
                           [](const auto& a, const auto& b) { return a.rms_m < b.rms_m; });
}

/// One solution from one start.
struct Solution {
  Estimate at;
  std::vector<PlanePoints> groups;
  Calibration found;
};

Solution SolveFrom(const PlaneSolver& solver, const CalibrationInput& input,
                   const RigidTransform& X_BN, Unknown unknown) {
  Solution out;
  Estimate start;
  start.X_FS = input.X_FS;
  start.X_NB = (unknown == Unknown::kBinLevel ? Level(X_BN) : X_BN).inverse();
  out.at = solver.Solve(start, unknown);
  out.groups = solver.Assign(out.at);
  if (!out.groups.empty()) SetResiduals(solver, input, out.groups, out.at, out.found);
  return out;
}

/// The solution that most points lie on.
Solution BestSolution(const PlaneSolver& solver, const CalibrationInput& input, Unknown unknown) {
  std::optional<Solution> best;
  std::size_t most = 0;
  for (const RigidTransform& X_BN : BinStarts(input)) {
    Solution one = SolveFrom(solver, input, X_BN, unknown);
    std::size_t points = 0;
    for (const PlanePoints& group : one.groups) points += group.points.size();
    if (best && points <= most) continue;
    best = std::move(one);
    most = points;
  }
  return *best;
}

/// What else the residual may come from, as the data itself says.
std::string LeanText(const PlaneSolver& solver, const CalibrationInput& input,
                     const Solution& level) {
  const Solution free = SolveFrom(solver, input, level.at.X_NB.inverse(), Unknown::kBin);
  if (free.groups.empty() || Worst(free.found).rms_m > kMaxResidual_m) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                ": the floor leans by %.2f degrees against the arm's base, and X_BN has a yaw "
                "alone: level the bin",
                Degrees(LeanOf(free.at.X_NB)));
  return text;
}

/// Throws when what lies in the bin, or where its walls are, is not as it was said to be.
void RequireEmptyBin(const PlaneSolver& solver, const CalibrationInput& input, const Estimate& at) {
  const double inside = solver.ShareInside(at);
  if (inside > kMaxInside) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%.1f %% of the points lie inside the bin, off its floor and walls, allowed is "
                  "%.0f %%: take out what is in it, and check bin.size_m and the views' poses",
                  100.0 * inside, 100.0 * kMaxInside);
    Refuse(text);
  }
  const auto clouds = CloudsIn(input, at.X_NB, at.X_FS);
  BinEvidence seen;
  for (const OrganizedCloud& cloud : clouds) {
    seen += CompareWithBin(cloud.p_SP, cloud.X_NS, input.bin);
  }
  std::string why = BinWarning(seen);
  if (why.empty()) why = OtherBinSeen(clouds, input.bin);
  if (!why.empty()) Refuse(why);
}

/// Throws when two walls that face each other are seen at another distance than the bin's size.
void RequireSize(const CalibrationInput& input, const Estimate& at) {
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(at.longer_m[axis]) <= kMaxResidual_m) continue;
    const double said_m = input.bin.size_m[static_cast<std::size_t>(axis)];
    char text[240];
    std::snprintf(text, sizeof text,
                  "bin.size_m: is %.4f m along %s, as all views and touches together tell it is "
                  "%.4f m, allowed are %.1f mm of difference: measure it inside, and check the "
                  "poses of views and touches",
                  said_m, axis == 0 ? "x" : "y", said_m + at.longer_m[axis], 1e3 * kMaxResidual_m);
    Refuse(text);
  }
}

void RequireSmallResidual(const Solution& solution, const std::string& cause) {
  const PlaneResidual& worst = Worst(solution.found);
  if (worst.rms_m <= kMaxResidual_m) return;
  char text[200];
  std::snprintf(text, sizeof text,
                ": %s: its points are %.2f mm (rms) from where all others put that plane, over all "
                "%.2f mm, allowed are %.1f mm",
                worst.plane.c_str(), 1e3 * worst.rms_m, 1e3 * solution.found.rms_m,
                1e3 * kMaxResidual_m);
  Refuse(worst.name + text + cause);
}

/// What was found, with what is said about it.
Calibration Told(const PlaneSolver& solver, const CalibrationInput& input, const Solution& solution,
                 Unknown unknown) {
  Calibration out = solution.found;
  out.X_FS = solution.at.X_FS;
  out.X_BN = solution.at.X_NB.inverse();
  out.lean_rad = LeanOf(solution.at.X_NB);
  out.uncertainty_m = WorstSigma(solver.Information(solution.groups, solution.at), unknown);
  const bool scanner = unknown == Unknown::kScanner;
  const RigidTransform moved = scanner ? input.X_FS.inverse() * out.X_FS
                                       : RigidTransform(input.bin.X_BN.inverse() * out.X_BN);
  out.moved_m = moved.translation().norm();
  out.turned_rad = TurnOf(moved.linear());
  return out;
}

std::string UncertaintyText(double sigma_m) {
  if (!(sigma_m < 1.0)) return "not at all in one direction";
  char text[80];
  std::snprintf(text, sizeof text, "to %.1f mm in its worst direction", 1e3 * sigma_m);
  return text;
}

void RequireTold(const Calibration& found, const std::string& what, const std::string& remedy) {
  if (found.uncertainty_m <= kMaxSigma_m) return;
  Refuse(what + " is known " + UncertaintyText(found.uncertainty_m) + ", allowed are " +
         Number(1e3 * kMaxSigma_m) + " mm: " + remedy);
}

/// Planes that fit worse than was counted on tell less: a wall that stands elsewhere may show as a
/// small residual and a large shift.
void WidenByResiduals(const Solution& solution, const std::string& what, Calibration& found) {
  double worst = 1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < solution.groups.size(); ++i) {
    const double sigma_m = solution.groups[i].seen ? kPlaneSigma_m : kTouchSigma_m;
    if (found.residuals[i].rms_m <= worst * sigma_m) continue;
    worst = found.residuals[i].rms_m / sigma_m;
    at = i;
  }
  found.uncertainty_m *= worst;
  const PlaneResidual& residual = found.residuals[at];
  char text[240];
  std::snprintf(text, sizeof text,
                "the points of %s (%s) are %.2f mm (rms) from their plane; check bin.size_m and "
                "the views' poses, or add views that tell more",
                residual.plane.c_str(), residual.name.c_str(), 1e3 * residual.rms_m);
  RequireTold(found, what, text);
}

std::vector<Matrix3> TurnsOfFlange(const CalibrationInput& input) {
  std::vector<Matrix3> out;
  for (const CalibrationView& view : input.views) out.push_back(view.X_BF.linear());
  return out;
}

/// Solves and judges. `what` is looked for, `remedy` helps where the data tells too little of it.
Calibration Find(Unknown unknown, const CalibrationInput& input, const std::string& what,
                 const std::string& remedy, Parallelism parallelism) {
  const auto points = SurfacePoints(input, parallelism);
  const PlaneSolver solver(input, points);
  const Solution solution = BestSolution(solver, input, unknown);
  RequirePlanes(solution.groups);
  RequireClearTouches(input, solution.at.X_NB);
  Calibration out = Told(solver, input, solution, unknown);
  RequireTold(out, what, remedy);
  RequireEmptyBin(solver, input, solution.at);
  RequireSize(input, solution.at);
  const bool leans = unknown == Unknown::kBinLevel && Worst(solution.found).rms_m > kMaxResidual_m;
  RequireSmallResidual(solution, leans ? LeanText(solver, input, solution) : "");
  WidenByResiduals(solution, what, out);
  return out;
}

}  // namespace

Calibration CalibrateBin(const CalibrationInput& input, Parallelism parallelism) {
  if (input.views.empty() && input.touches.empty()) Refuse("there is neither a view nor a touch");
  RequireTouches(input);
  return Find(Unknown::kBinLevel, input, "the bin's place",
              "touch floor and walls further apart, or add views that show more of the walls",
              parallelism);
}

Calibration CalibrateHandEye(const CalibrationInput& input, Parallelism parallelism) {
  if (input.views.empty()) Refuse("there is no view, so that nothing tells where the scanner is");
  if (input.on_stand && input.touches.empty()) {
    Refuse(
        "a scanner on a stand sees the bin alike from every pose of the arm: touch floor and walls "
        "with a tool besides, which tells where the bin is");
  }
  RequireTouches(input);
  const std::string lack =
      input.touches.empty() ? WhatPosesLack(TurnsOfFlange(input)) : std::string();
  if (!lack.empty()) Refuse(lack);
  return Find(Unknown::kScanner, input, "the scanner's pose",
              input.on_stand
                  ? "the scanner must see the floor and two walls that meet"
                  : "add views turned and tilted otherwise, into several corners of the bin",
              parallelism);
}

}  // namespace tubetwin

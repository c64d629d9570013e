#pragma once

#include <cstddef>
#include <vector>

#include "models/base/frames.h"

namespace tubetwin {

/// A curve as straight pieces between points, metres. Frame by context (suffix of the variable).
using Polyline = std::vector<Vector3>;

/// Sum of the pieces' lengths.
double Length(const Polyline& line);

/// Arc length of every point from the first; empty for an empty line.
std::vector<double> ArcLengths(const Polyline& line);

/// Point at arc length `s` (clamped). Precondition: at least one point.
Vector3 PointAt(const Polyline& line, double s);

/// Unit tangent at arc length `s` (clamped), averaged over +-`window_m`/2.
/// Precondition: at least two points, length > 0.
Vector3 TangentAt(const Polyline& line, double s, double window_m = 0.0);

/// Points at equal arc-length steps, both ends kept: the smallest number of pieces of at most
/// `step_m`.
Polyline Resample(const Polyline& line, double step_m);

/// Exactly `count` points at equal arc-length steps, both ends kept. Precondition: count >= 2.
Polyline ResampleCount(const Polyline& line, int count);

/// As few of the line's points as keep every other within `tolerance_m` of the pieces, both ends
/// kept (Douglas and Peucker 1973).
Polyline Simplified(const Polyline& line, double tolerance_m);

/// Part of the line between two arc lengths (clamped, from < to).
Polyline SubLine(const Polyline& line, double from_m, double to_m);

/// Mean over the curve (centre of mass of a uniform tube).
Vector3 CurveCentre(const Polyline& line);

/// Where on the line a point projects to.
struct ClosestOnLine {
  double distance_m = 0.0;
  double s_m = 0.0;  ///< Arc length of the foot point.
  Vector3 point = Vector3::Zero();
};
ClosestOnLine Closest(const Polyline& line, const Vector3& p);

/// Closest points of two segments a0-a1 and b0-b1.
struct SegmentPair {
  double distance_m = 0.0;
  double s = 0.0;  ///< Parameter in [0, 1] on a.
  double t = 0.0;  ///< Parameter in [0, 1] on b.
};
SegmentPair ClosestOfSegments(const Vector3& a0, const Vector3& a1, const Vector3& b0,
                              const Vector3& b1);

/// Smallest distance between two lines, with the arc lengths where it is reached.
struct LinePair {
  double distance_m = 0.0;
  double s_m = 0.0;
  double t_m = 0.0;
};
LinePair ClosestOfLines(const Polyline& a, const Polyline& b);

/// Part of a tube's axis that is `radius_m` or more from both ends, piece by piece: the tube is all
/// within one radius of it, and reaches from tip to tip of `line` with round ends. Nothing where a
/// piece belongs to the ends wholly. A tube no longer than thick keeps its middle.
struct AxisPiece {
  std::size_t piece = 0;  ///< Between nodes `piece` and `piece` + 1.
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();
};
std::vector<AxisPiece> PiecesWithin(const Polyline& line, double radius_m);

/// Every point mapped by X_AB: from frame B to frame A.
Polyline Transformed(const RigidTransform& X_AB, const Polyline& line_B);

}  // namespace tubetwin

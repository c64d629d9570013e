#include "models/base/polyline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"

namespace tubetwin {
namespace {

double DistanceToSegment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(d.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

}  // namespace

std::vector<double> ArcLengths(const Polyline& line) {
  std::vector<double> out(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i)
    out[i] = out[i - 1] + (line[i] - line[i - 1]).norm();
  return out;
}

double Length(const Polyline& line) {
  double sum = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
  return sum;
}

Vector3 PointAt(const Polyline& line, double s) {
  TT_CHECK(!line.empty());
  double before = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double piece = (line[i] - line[i - 1]).norm();
    if (s <= before + piece && piece > 0.0) {
      const double u = std::clamp((s - before) / piece, 0.0, 1.0);
      return line[i - 1] + u * (line[i] - line[i - 1]);
    }
    before += piece;
  }
  return line.back();
}

Vector3 TangentAt(const Polyline& line, double s, double window_m) {
  const double length = Length(line);
  TT_CHECK(line.size() >= 2 && length > 0.0);
  const double half = std::clamp(0.5 * window_m, 1e-6 * length, 0.5 * length);
  const double centre = std::clamp(s, half, length - half);
  return (PointAt(line, centre + half) - PointAt(line, centre - half)).normalized();
}

Polyline Simplified(const Polyline& line, double tolerance_m) {
  if (line.size() < 3) return line;
  std::vector<char> kept(line.size(), 0);
  kept.front() = kept.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    double max_off_m = tolerance_m;
    std::size_t at = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double off = DistanceToSegment(line[i], line[from], line[to]);
      if (off <= max_off_m) continue;
      max_off_m = off;
      at = i;
    }
    if (at == from) continue;
    kept[at] = 1;
    open.push_back({from, at});
    open.push_back({at, to});
  }
  Polyline out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) out.push_back(line[i]);
  }
  return out;
}

Polyline ResampleCount(const Polyline& line, int count) {
  TT_CHECK(count >= 2 && !line.empty());
  const std::vector<double> s = ArcLengths(line);
  Polyline out;
  out.reserve(static_cast<std::size_t>(count));
  std::size_t i = 1;
  for (int k = 0; k < count; ++k) {
    const double target = s.back() * k / (count - 1);
    while (i + 1 < line.size() && s[i] < target) ++i;
    if (k == 0 || line.size() == 1) {
      out.push_back(line.front());
    } else if (k == count - 1) {
      out.push_back(line.back());
    } else {
      const double piece = s[i] - s[i - 1];
      const double u = piece > 0.0 ? std::clamp((target - s[i - 1]) / piece, 0.0, 1.0) : 0.0;
      out.push_back(line[i - 1] + u * (line[i] - line[i - 1]));
    }
  }
  return out;
}

Polyline Resample(const Polyline& line, double step_m) {
  TT_CHECK(step_m > 0.0);
  const int pieces = std::max(1, static_cast<int>(std::ceil(Length(line) / step_m - 1e-9)));
  return ResampleCount(line, pieces + 1);
}

Polyline SubLine(const Polyline& line, double from_m, double to_m) {
  const std::vector<double> s = ArcLengths(line);
  Polyline out{PointAt(line, from_m)};
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (s[i] > from_m && s[i] < to_m) out.push_back(line[i]);
  }
  out.push_back(PointAt(line, to_m));
  return out;
}

Vector3 CurveCentre(const Polyline& line) {
  TT_CHECK(!line.empty());
  Vector3 sum = Vector3::Zero();
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double piece = (line[i] - line[i - 1]).norm();
    sum += 0.5 * piece * (line[i] + line[i - 1]);
    length += piece;
  }
  return length > 0.0 ? Vector3(sum / length) : line.front();
}

ClosestOnLine Closest(const Polyline& line, const Vector3& p) {
  TT_CHECK(!line.empty());
  ClosestOnLine best{(line.front() - p).norm(), 0.0, line.front()};
  double before = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector3 d = line[i] - line[i - 1];
    const double piece = d.norm();
    const double u =
        piece > 0.0 ? std::clamp((p - line[i - 1]).dot(d) / (piece * piece), 0.0, 1.0) : 0.0;
    const Vector3 foot = line[i - 1] + u * d;
    const double distance = (foot - p).norm();
    if (distance < best.distance_m) best = {distance, before + u * piece, foot};
    before += piece;
  }
  return best;
}

SegmentPair ClosestOfSegments(const Vector3& a0, const Vector3& a1, const Vector3& b0,
                              const Vector3& b1) {
  // Minimise |a0 + s u - b0 - t v| over the unit square: inner solution, clamped one side at a
  // time.
  const Vector3 u = a1 - a0;
  const Vector3 v = b1 - b0;
  const Vector3 w = a0 - b0;
  const double uu = u.dot(u), vv = v.dot(v), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  SegmentPair out;
  double s = 0.0;
  if (determinant > 1e-12 * uu * vv) s = std::clamp((uv * vw - vv * uw) / determinant, 0.0, 1.0);
  double t = vv > 0.0 ? (uv * s + vw) / vv : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0.0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  }
  out.s = s;
  out.t = t;
  out.distance_m = (w + s * u - t * v).norm();
  return out;
}

LinePair ClosestOfLines(const Polyline& a, const Polyline& b) {
  TT_CHECK(!a.empty() && !b.empty());
  LinePair best;
  best.distance_m = std::numeric_limits<double>::infinity();
  double before_a = 0.0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    const double piece_a = (a[i] - a[i - 1]).norm();
    double before_b = 0.0;
    for (std::size_t j = 1; j < b.size(); ++j) {
      const double piece_b = (b[j] - b[j - 1]).norm();
      const SegmentPair pair = ClosestOfSegments(a[i - 1], a[i], b[j - 1], b[j]);
      if (pair.distance_m < best.distance_m) {
        best = {pair.distance_m, before_a + pair.s * piece_a, before_b + pair.t * piece_b};
      }
      before_b += piece_b;
    }
    before_a += piece_a;
  }
  return best;
}

Polyline Transformed(const RigidTransform& X_AB, const Polyline& line_B) {
  Polyline out;
  out.reserve(line_B.size());
  for (const Vector3& p : line_B) out.push_back(X_AB * p);
  return out;
}

std::vector<AxisPiece> PiecesWithin(const Polyline& line, double radius_m) {
  constexpr double kShortest_m = 1e-4;  // The engine wants ends of a capsule apart.
  const std::vector<double> at = ArcLengths(line);
  const double length_m = at.back();
  const double end_m = std::min(radius_m, 0.5 * (length_m - kShortest_m));
  std::vector<AxisPiece> pieces;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double from = std::max(at[i], end_m), to = std::min(at[i + 1], length_m - end_m);
    if (to - from < 0.999 * kShortest_m) continue;
    const Vector3 step = (line[i + 1] - line[i]) / (at[i + 1] - at[i]);
    pieces.push_back({i, line[i] + (from - at[i]) * step, line[i] + (to - at[i]) * step});
  }
  if (pieces.empty()) {
    // The middle of a ball-like tube sits on a node.
    std::size_t i = 0;
    while (i + 2 < at.size() && at[i + 1] < 0.5 * length_m) ++i;
    const Vector3 half = 0.5 * kShortest_m * (line[i + 1] - line[i]).normalized();
    const Vector3 middle = PointAt(line, 0.5 * length_m);
    pieces.push_back({i, middle - half, middle + half});
  }
  return pieces;
}

}  // namespace tubetwin

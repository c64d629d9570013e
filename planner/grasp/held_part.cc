#include "planner/grasp/held_part.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tubetwin {
namespace {

constexpr double kFirstMode = 3.5160;  // (1.8751)^2, clamped and free.

/// Arc length of the line's point that is nearest to E's z axis.
double HeldAt(const Polyline& line_E, const std::vector<double>& at_m) {
  double held_m = 0.0, min_m = line_E.front().head<2>().norm();
  for (std::size_t i = 1; i < line_E.size(); ++i) {
    const auto a = line_E[i - 1].head<2>(), b = line_E[i].head<2>();
    const double length2 = (b - a).squaredNorm();
    const double t = length2 > 0.0 ? std::clamp(-a.dot(b - a) / length2, 0.0, 1.0) : 0.0;
    const double off_m = (a + t * (b - a)).norm();
    if (off_m >= min_m) continue;
    min_m = off_m;
    held_m = at_m[i - 1] + t * (at_m[i] - at_m[i - 1]);
  }
  return held_m;
}

double WeightPerLength(const Part& part) { return part.mass_kg / part.length_m * kGravity; }

/// What a level cantilever of length `free_m` bends down at `s_m` from the clamp.
double Deflection(double s_m, double free_m, const Part& part) {
  return WeightPerLength(part) * s_m * s_m *
         (6.0 * free_m * free_m - 4.0 * free_m * s_m + s_m * s_m) /
         (24.0 * part.bending_stiffness_Nm2);
}

}  // namespace

HeldPart HeldPartOf(const Polyline& line_E, const Part& part) {
  HeldPart out;
  if (!part.is_hose() || line_E.size() < 2) return out;
  const std::vector<double> at_m = ArcLengths(line_E);
  const double held_m = HeldAt(line_E, at_m);
  const double free_m = std::max(held_m, at_m.back() - held_m);
  const double per_length_kg_m = part.mass_kg / part.length_m;
  out.sag_m = Deflection(free_m, free_m, part);
  out.period_s = 2.0 * kPi * free_m * free_m / kFirstMode *
                 std::sqrt(per_length_kg_m / part.bending_stiffness_Nm2);
  return out;
}

Polyline Sagged(const Polyline& line_E, const Part& part) {
  if (!part.is_hose() || line_E.size() < 2) return line_E;
  const std::vector<double> at_m = ArcLengths(line_E);
  const double held_m = HeldAt(line_E, at_m);
  const Vector3 p_EHeld = PointAt(line_E, held_m);
  Polyline out = line_E;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double s_m = std::abs(at_m[i] - held_m);
    if (s_m < 1e-9) continue;
    const double free_m = at_m[i] < held_m ? held_m : at_m.back() - held_m;
    const Vector3 out_E = line_E[i] - p_EHeld;
    const double level = out_E.head<2>().norm() / std::max(out_E.norm(), 1e-9);
    out[i].z() += level * Deflection(s_m, free_m, part);
  }
  return out;
}

}  // namespace tubetwin

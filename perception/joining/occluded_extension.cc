#include "perception/joining/occluded_extension.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

/// With this much of its cap seen, the tube ends here.
constexpr double kClosedCap = 0.5;
/// Distance to the axes of other fragments, in radii. Two touching tubes are 2 apart; less is asked
/// because an extension is a guess.
constexpr double kClearance = 1.6;
/// Larger curvatures (1/m) of an end are errors of its fit.
constexpr double kMaxCurvature = 25.0;
/// An extension that is tried later must be this much longer than an earlier one.
constexpr double kClearly_m = 0.010;
/// Curvatures (1/m) that are tried to all sides, and to how many sides each.
constexpr double kTurns[] = {5.0, 12.0, 20.0};
constexpr int kDirections = 8;

}  // namespace

OccludedExtensions::OccludedExtensions(const std::vector<Fragment>& fragments,
                                       const OccludedSpace& space)
    : fragments_(fragments), space_(space) {
  for (const Fragment& fragment : fragments) lines_.Add(fragment.line_N);
}

Polyline OccludedExtensions::Follow(const FragmentEnd& end, int fragment, const Vector3& bend_N,
                                    double wanted_m) const {
  const double bend = bend_N.norm();
  Vector3 p = end.p_N, t = end.outward_N;
  Vector3 side = bend > 1e-6 ? Vector3(bend_N / bend) : Vector3::Zero();
  Polyline out;
  std::size_t hidden = 0;  // Number of nodes up to the last occluded one.
  double left_m = wanted_m;
  for (int denied = 0; left_m > 1e-6 && denied < 2;) {
    const double step_m = std::min(kNodeStep_m, left_m);
    // Along a circle: the chord's direction is half way between the two tangents.
    const double c = std::cos(0.5 * bend * step_m), s = std::sin(0.5 * bend * step_m);
    p += step_m * (c * t + s * side);
    const Vector3 turned = std::cos(bend * step_m) * t + std::sin(bend * step_m) * side;
    side = std::cos(bend * step_m) * side - std::sin(bend * step_m) * t;
    t = turned;
    if (!space_.FitsBin(p)) break;
    const double min_m = kClearance * space_.radius_m();
    if (lines_.Distance(p, 2 * min_m, fragment) < min_m) break;
    out.push_back(p);
    left_m -= step_m;
    // Close to the fragment a view may see the fragment's own edge instead: one such node is let
    // pass, two in a row are not.
    const Visibility visibility = space_.Query(p);
    const bool seen = visibility == Visibility::kSurface || visibility == Visibility::kSeenThrough;
    denied = seen ? denied + 1 : 0;
    if (!seen) hidden = out.size();
  }
  out.resize(hidden);
  return out;
}

Polyline OccludedExtensions::Find(int end, double wanted_m, bool any_direction) const {
  const FragmentEnd& e = fragments_[static_cast<std::size_t>(end / 2)].ends[end % 2];
  if (e.cap >= kClosedCap || wanted_m <= 0.0) return {};
  const double enough_m = wanted_m - 1e-6;
  Polyline best;
  double best_m = 0.0;
  const auto offer = [&](const Vector3& bend_N, double advantage_m) {
    Polyline extension = Follow(e, end / 2, bend_N, wanted_m);
    const double length_m = std::min(wanted_m, kNodeStep_m * static_cast<double>(extension.size()));
    if (length_m > best_m + advantage_m || (length_m > best_m && length_m >= enough_m)) {
      best = std::move(extension);
      best_m = length_m;
    }
    return best_m >= enough_m;
  };
  const double sharp = e.bend_N.norm();
  const Vector3 bend_N =
      sharp > kMaxCurvature ? Vector3(kMaxCurvature / sharp * e.bend_N) : e.bend_N;
  if (offer(bend_N, 0.0) || offer(0.5 * bend_N, kClearly_m) || offer(Vector3::Zero(), kClearly_m) ||
      !any_direction) {
    return best;
  }
  const Vector3 u = e.outward_N.unitOrthogonal(), v = e.outward_N.cross(u);
  for (const double turn : kTurns) {
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * kPi * k / kDirections;
      if (offer(turn * (std::cos(angle) * u + std::sin(angle) * v), kClearly_m)) return best;
    }
  }
  return best;
}

std::vector<double> MaxOccludedExtensions(const std::vector<Fragment>& fragments,
                                          const OccludedSpace& space, double longest_m) {
  const OccludedExtensions extensions(fragments, space);
  std::vector<double> out;
  for (int end = 0; end < 2 * static_cast<int>(fragments.size()); ++end) {
    const Polyline extension = extensions.Find(end, longest_m, false);
    out.push_back(std::min(longest_m, kNodeStep_m * static_cast<double>(extension.size())));
  }
  return out;
}

}  // namespace tubetwin

#include "perception/leao2020/join.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

double AngleDeg(const Vector3& a, const Vector3& b) {
  return Degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

/// What one view says about a gap.
enum class GapVisibility { kNothing, kHidden, kSeen };

GapVisibility QueryGap(const ViewImage& view, const Vector3& p_NA, const Vector3& p_NB,
                       double window_m) {
  if (view.width == 0) return GapVisibility::kNothing;
  const Vector3 a = view.X_SN * p_NA, b = view.X_SN * p_NB;
  if (a.z() <= 0.0 || b.z() <= 0.0) return GapVisibility::kNothing;
  const auto column_of = [&](const Vector3& p) { return view.fx * p.x() / p.z() + view.cx; };
  const auto row_of = [&](const Vector3& p) { return view.fy * p.y() / p.z() + view.cy; };
  const long column = std::lround(0.5 * (column_of(a) + column_of(b)));
  const long row = std::lround(0.5 * (row_of(a) + row_of(b)));
  const double deepest = std::max(a.z(), b.z());
  const long half = std::max(1L, std::lround(window_m / view.pitch_m));
  if (column + half < 0 || row + half < 0 || column - half >= view.width ||
      row - half >= view.height) {
    return GapVisibility::kNothing;
  }
  bool returns = false;
  for (long j = std::max(0L, row - half); j <= std::min<long>(view.height - 1, row + half); ++j) {
    for (long i = std::max(0L, column - half); i <= std::min<long>(view.width - 1, column + half);
         ++i) {
      const float z = view.z_near[view.Index(static_cast<int>(i), static_cast<int>(j))];
      if (!(z == z)) continue;
      returns = true;
      if (z < deepest) return GapVisibility::kHidden;
    }
  }
  return returns ? GapVisibility::kSeen : GapVisibility::kNothing;
}

struct Pair {
  double cost;
  int a, b;  ///< 2 * cylinder + end.
  double distance_m;
};

/// Pairs of ends of different cylinders within the limits, cheapest first.
std::vector<Pair> FindPairs(const std::vector<LeaoCylinder>& cylinders, double radius_m,
                            const Leao2020Config& config) {
  std::vector<Pair> pairs;
  const int ends = 2 * static_cast<int>(cylinders.size());
  for (int a = 0; a < ends; ++a) {
    for (int b = 2 * (a / 2) + 2; b < ends; ++b) {
      const LeaoJoint joint =
          MeasureJoint(cylinders[static_cast<std::size_t>(a / 2)], a % 2,
                       cylinders[static_cast<std::size_t>(b / 2)], b % 2, radius_m);
      if (joint.distance_m > config.join_distance_m) continue;
      if (joint.angle_deg > config.join_angle_deg) continue;
      pairs.push_back(
          {joint.distance_m + config.join_m_per_deg * joint.angle_deg, a, b, joint.distance_m});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& x, const Pair& y) { return x.cost < y.cost; });
  return pairs;
}

/// From a tube's one end cylinder by cylinder to the other.
LeaoTube Walk(int entry, const std::vector<int>& partner,
              const std::vector<LeaoCylinder>& cylinders) {
  LeaoTube tube;
  for (int end = entry; end >= 0; end = partner[static_cast<std::size_t>(end ^ 1)]) {
    const LeaoCylinder& cylinder = cylinders[static_cast<std::size_t>(end / 2)];
    if (!tube.ends.empty()) {
      const int last = tube.ends.back() ^ 1;
      tube.length_m +=
          (cylinder.end_N[static_cast<std::size_t>(end % 2)] -
           cylinders[static_cast<std::size_t>(last / 2)].end_N[static_cast<std::size_t>(last % 2)])
              .norm();
    }
    tube.ends.push_back(end);
    tube.length_m += cylinder.length_m();
  }
  return tube;
}

}  // namespace

LeaoJoint MeasureJoint(const LeaoCylinder& a, int end_a, const LeaoCylinder& b, int end_b,
                       double radius_m) {
  const Vector3 chord =
      b.end_N[static_cast<std::size_t>(end_b)] - a.end_N[static_cast<std::size_t>(end_a)];
  const Vector3 out = a.Outward(end_a), in = -b.Outward(end_b);
  const double ahead_m = chord.dot(out);
  const double aside_m = (chord - ahead_m * out).norm();
  const bool overlap = ahead_m < 0 && aside_m < radius_m;
  LeaoJoint joint;
  joint.distance_m = chord.norm();
  joint.angle_deg = joint.distance_m < radius_m || overlap
                        ? AngleDeg(out, in)
                        : AngleDeg(out, chord) + AngleDeg(chord, in);
  return joint;
}

bool IsGapHidden(const std::vector<ViewImage>& views, const Vector3& p_NA, const Vector3& p_NB,
                 double window_m) {
  bool hidden = false;
  for (const ViewImage& view : views) {
    const GapVisibility visibility = QueryGap(view, p_NA, p_NB, window_m);
    if (visibility == GapVisibility::kSeen) return false;
    hidden = hidden || visibility == GapVisibility::kHidden;
  }
  return hidden;
}

std::vector<LeaoTube> JoinCylinders(const std::vector<LeaoCylinder>& cylinders,
                                    const std::vector<ViewImage>& views, double radius_m,
                                    double longest_m, const Leao2020Config& config) {
  std::vector<int> partner(2 * cylinders.size(), -1);
  std::vector<int> tube_of(cylinders.size());
  std::vector<double> length_m(cylinders.size());
  for (std::size_t k = 0; k < cylinders.size(); ++k) {
    tube_of[k] = static_cast<int>(k);
    length_m[k] = cylinders[k].length_m();
  }
  for (const Pair& pair : FindPairs(cylinders, radius_m, config)) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const int tube_a = tube_of[a / 2], tube_b = tube_of[b / 2];
    if (tube_a == tube_b || partner[a] >= 0 || partner[b] >= 0) continue;
    const double joined_m = length_m[static_cast<std::size_t>(tube_a)] +
                            length_m[static_cast<std::size_t>(tube_b)] + pair.distance_m;
    if (joined_m > longest_m) continue;
    if (!IsGapHidden(views, cylinders[a / 2].end_N[a % 2], cylinders[b / 2].end_N[b % 2],
                     config.gap_window_m)) {
      continue;
    }
    partner[a] = pair.b;
    partner[b] = pair.a;
    length_m[static_cast<std::size_t>(tube_a)] = joined_m;
    std::replace(tube_of.begin(), tube_of.end(), tube_b, tube_a);
  }
  std::vector<LeaoTube> tubes;
  std::vector<char> done(cylinders.size(), 0);
  for (std::size_t k = 0; k < cylinders.size(); ++k) {
    if (done[k] != 0) continue;
    // Back to the tube's free end first.
    int entry = 2 * static_cast<int>(k);
    while (partner[static_cast<std::size_t>(entry)] >= 0) {
      entry = partner[static_cast<std::size_t>(entry)] ^ 1;
    }
    tubes.push_back(Walk(entry, partner, cylinders));
    for (const int end : tubes.back().ends) done[static_cast<std::size_t>(end / 2)] = 1;
  }
  return tubes;
}

int CountOccludedJoints(const LeaoTube& tube, const std::vector<LeaoCylinder>& cylinders) {
  int count = 0;
  for (std::size_t i = 1; i < tube.ends.size(); ++i) {
    count += cylinders[static_cast<std::size_t>(tube.ends[i - 1] / 2)].segment !=
             cylinders[static_cast<std::size_t>(tube.ends[i] / 2)].segment;
  }
  return count;
}

}  // namespace tubetwin

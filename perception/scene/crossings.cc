// Who lies over whom: FindCrossings and AssignClasses of tube_scene.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "models/base/error.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {
namespace {

/// Spacing of the samples that the rule runs over: far below the radius of any part.
constexpr double kSample_m = 0.001;

/// A line with what the search needs of it.
struct Covering {
  const Polyline* line = nullptr;
  std::vector<double> s_m;
  double z_max = 0.0;
  Eigen::AlignedBox2d box;
};

Covering MakeCovering(const Polyline& line) {
  Covering out;
  out.line = &line;
  out.s_m = ArcLengths(line);
  out.z_max = -std::numeric_limits<double>::infinity();
  for (const Vector3& p : line) {
    out.z_max = std::max(out.z_max, p.z());
    out.box.extend(Eigen::Vector2d(p.x(), p.y()));
  }
  return out;
}

/// How one sample is covered by another line: the point above it that is horizontally nearest.
struct Cover {
  bool covered = false;
  double horizontal_m = std::numeric_limits<double>::infinity();
  double s_over_m = 0.0;
  double height_m = 0.0;  ///< Axis over axis.
};

/// The part of the segment a-b within `r` of p horizontally and more than `r` above p: exact, the
/// horizontal condition cuts an interval of the segment, the vertical one a half of that.
void CoverBySegment(const Vector3& a, const Vector3& b, double s_a_m, const Vector3& p, double r,
                    Cover& best) {
  const double reach_low = std::min(a.x(), b.x()) - r, reach_high = std::max(a.x(), b.x()) + r;
  if (p.x() < reach_low || p.x() > reach_high) return;
  if (p.y() < std::min(a.y(), b.y()) - r || p.y() > std::max(a.y(), b.y()) + r) return;
  const Eigen::Vector2d d = (b - a).head<2>();
  const Eigen::Vector2d w = (a - p).head<2>();
  const double dd = d.squaredNorm(), dw = d.dot(w);
  double low = 0.0, high = 1.0;
  if (dd > 1e-18) {
    const double discriminant = dw * dw - dd * (w.squaredNorm() - r * r);
    if (discriminant < 0.0) return;
    low = std::max(low, (-dw - std::sqrt(discriminant)) / dd);
    high = std::min(high, (-dw + std::sqrt(discriminant)) / dd);
  } else if (w.squaredNorm() > r * r) {
    return;
  }
  const double dz = b.z() - a.z();
  const double need = p.z() + r - a.z();  // dz * t > need
  if (std::abs(dz) < 1e-12) {
    if (need >= 0.0) return;
  } else if (dz > 0.0) {
    low = std::max(low, need / dz);
  } else {
    high = std::min(high, need / dz);
  }
  if (low >= high) return;
  const double t = dd > 1e-18 ? std::clamp(-dw / dd, low, high) : 0.5 * (low + high);
  const double horizontal = (w + t * d).norm();
  if (best.covered && horizontal >= best.horizontal_m) return;
  best = {true, horizontal, s_a_m + t * (b - a).norm(), a.z() + t * dz - p.z()};
}

Cover FindCover(const Covering& over, const Vector3& p, double r) {
  Cover best;
  if (over.z_max <= p.z() + r) return best;
  if (over.box.squaredExteriorDistance(Eigen::Vector2d(p.x(), p.y())) > r * r) return best;
  const Polyline& line = *over.line;
  for (std::size_t k = 1; k < line.size(); ++k) {
    CoverBySegment(line[k - 1], line[k], over.s_m[k - 1], p, r, best);
  }
  return best;
}

/// All runs of samples of `under` that `over` covers; each is reported where the two lines are
/// horizontally nearest.
void AppendRuns(const Covering& over, int over_index, const Polyline& samples, double length_m,
                int under_index, double r, std::vector<Crossing>& out) {
  bool in_run = false;
  double nearest = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Cover cover = FindCover(over, samples[k], r);
    const double s_m = length_m * static_cast<double>(k) / static_cast<double>(samples.size() - 1);
    if (cover.covered && !in_run) {
      out.emplace_back();
      out.back().under_from_m = s_m;
    }
    if (cover.covered) out.back().under_to_m = s_m;
    if (cover.covered && (!in_run || cover.horizontal_m < nearest)) {
      nearest = cover.horizontal_m;
      Crossing& crossing = out.back();
      crossing.over = over_index;
      crossing.under = under_index;
      crossing.at_over_m = cover.s_over_m;
      crossing.at_under_m = s_m;
      crossing.gap_m = cover.height_m - 2.0 * r;
      crossing.confidence = 1.0;
    }
    in_run = cover.covered;
  }
}

/// Whether the node nearest to an arc length was seen.
bool SeenAt(const PerceivedTube& tube, double s_m) {
  const std::vector<double> s = ArcLengths(tube.centerline_N);
  auto after = std::lower_bound(s.begin(), s.end(), s_m);
  if (after == s.end()) after = std::prev(s.end());
  if (after != s.begin() && s_m - *std::prev(after) < *after - s_m) --after;
  return tube.node_visible[static_cast<std::size_t>(after - s.begin())] != 0;
}

/// The lower tube shows itself within `reach_m` before or behind the covered run, or ends there.
bool ShowsBeside(const PerceivedTube& tube, double s_m, double sign, double reach_m) {
  const double length_m = Length(tube.centerline_N);
  for (double d = 0.0; d <= reach_m; d += 0.0025) {
    const double s = s_m + sign * d;
    if (s < 0.0 || s > length_m || SeenAt(tube, s)) return true;
  }
  return false;
}

bool IsVisible(const Crossing& c, const PerceivedTube& over, const PerceivedTube& under, double r) {
  if (over.node_visible.empty() || under.node_visible.empty()) return true;
  return SeenAt(over, c.at_over_m) && ShowsBeside(under, c.under_from_m, -1.0, 2.0 * r) &&
         ShowsBeside(under, c.under_to_m, 1.0, 2.0 * r);
}

/// Probability-like certainty of one crossing: that of both tubes, less where the height of the
/// upper axis is close to the rule's limit of one radius.
double CrossingConfidence(const Crossing& c, const PerceivedTube& over, const PerceivedTube& under,
                          double r) {
  const double margin_m = c.gap_m + 2.0 * r - r;
  const double clear = std::clamp(0.5 + margin_m / (0.4 * r), 0.5, 1.0);
  return clear * std::min(over.confidence, under.confidence);
}

void SortUnique(std::vector<int>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace

std::vector<Crossing> FindCrossings(const std::vector<Polyline>& lines_N, double radius_m) {
  TT_CHECK(radius_m > 0.0);
  std::vector<Covering> coverings;
  coverings.reserve(lines_N.size());
  for (const Polyline& line : lines_N) coverings.push_back(MakeCovering(line));
  std::vector<Crossing> out;
  for (std::size_t under = 0; under < lines_N.size(); ++under) {
    if (lines_N[under].size() < 2) continue;
    const Polyline samples = Resample(lines_N[under], kSample_m);
    const double length_m = coverings[under].s_m.back();
    for (std::size_t over = 0; over < lines_N.size(); ++over) {
      if (over == under || lines_N[over].size() < 2) continue;
      AppendRuns(coverings[over], static_cast<int>(over), samples, length_m,
                 static_cast<int>(under), radius_m, out);
    }
  }
  return out;
}

void AssignClasses(TubeScene& scene, double radius_m) {
  std::vector<Polyline> lines_N;
  for (PerceivedTube& tube : scene.tubes) {
    lines_N.push_back(tube.centerline_N);
    tube.over.clear();
    tube.under.clear();
  }
  scene.crossings = FindCrossings(lines_N, radius_m);
  std::vector<int> times_under(scene.tubes.size(), 0);
  for (Crossing& c : scene.crossings) {
    PerceivedTube& over = scene.tubes[static_cast<std::size_t>(c.over)];
    PerceivedTube& under = scene.tubes[static_cast<std::size_t>(c.under)];
    ++times_under[static_cast<std::size_t>(c.under)];
    c.visible = IsVisible(c, over, under, radius_m);
    c.confidence = CrossingConfidence(c, over, under, radius_m);
    c.over = over.id;
    c.under = under.id;
    over.over.push_back(under.id);
    under.under.push_back(over.id);
  }
  for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
    PerceivedTube& tube = scene.tubes[i];
    SortUnique(tube.over);
    SortUnique(tube.under);
    tube.hooked.clear();
    std::set_intersection(tube.over.begin(), tube.over.end(), tube.under.begin(), tube.under.end(),
                          std::back_inserter(tube.hooked));
    tube.tube_class = times_under[i] == 0   ? TubeClass::kFree
                      : times_under[i] == 1 ? TubeClass::kWeak
                                            : TubeClass::kStrong;
  }
}

}  // namespace tubetwin

#include "tests/support/graph_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace tubetwin {
namespace {

constexpr double kBin_m = 0.005;
constexpr double kSeenShare = 0.2;
constexpr double kShortestRun_m = 0.015;
constexpr double kShortestGap_m = 0.010;
constexpr double kSameRun_m = 0.020;
constexpr double kReachRadii = 1.6;

}  // namespace

bool SeenProfile::At(double s_m) const {
  if (seen.empty()) return false;
  const auto last = static_cast<std::ptrdiff_t>(seen.size()) - 1;
  const auto k = static_cast<std::ptrdiff_t>(std::floor(s_m / bin_m));
  return seen[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last))] != 0;
}

std::vector<SeenProfile> FindSeen(const std::vector<Polyline>& true_lines_N,
                                  const std::vector<TubePoint>& points) {
  std::vector<SeenProfile> out(true_lines_N.size());
  std::vector<std::vector<int>> count(out.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    const double length_m = Length(true_lines_N[t]);
    const auto bins = std::max<std::size_t>(1, std::lround(length_m / kBin_m));
    out[t].bin_m = length_m / static_cast<double>(bins);
    out[t].seen.assign(bins, 0);
    count[t].assign(bins, 0);
  }
  for (const TubePoint& point : points) {
    const auto t = static_cast<std::size_t>(point.tube);
    const double s = Closest(true_lines_N[t], point.p_N).s_m / out[t].bin_m;
    ++count[t][std::min(count[t].size() - 1, static_cast<std::size_t>(s))];
  }
  std::vector<int> filled;
  for (const auto& bins : count) {
    for (const int n : bins) {
      if (n > 0) filled.push_back(n);
    }
  }
  if (filled.empty()) return out;
  // The upper quartile: bins without any cover.
  const auto usual = filled.begin() + static_cast<std::ptrdiff_t>(3 * filled.size() / 4);
  std::nth_element(filled.begin(), usual, filled.end());
  for (std::size_t t = 0; t < out.size(); ++t) {
    for (std::size_t k = 0; k < count[t].size(); ++k) {
      out[t].seen[k] = count[t][k] >= kSeenShare * *usual;
    }
  }
  return out;
}

namespace {

/// Whether the tube shows itself within `reach_m` of `s_m` in the direction `sign`, or ends there.
bool ShowsOrEnds(const SeenProfile& profile, double s_m, double sign, double reach_m) {
  const double length_m = profile.bin_m * static_cast<double>(profile.seen.size());
  for (double d = 0.0; d <= reach_m; d += 0.5 * profile.bin_m) {
    const double s = s_m + sign * d;
    if (s < 0.0 || s > length_m || profile.At(s)) return true;
  }
  return false;
}

/// Whether nothing is seen of the tube between `s_m` and one of its ends.
bool OnUnseenEnd(const SeenProfile& profile, double s_m) {
  const auto here = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(s_m / profile.bin_m), 0,
                                               std::ssize(profile.seen));
  const auto at = profile.seen.begin() + here;
  const auto shows = [](char seen) { return seen != 0; };
  return std::none_of(profile.seen.begin(), at, shows) ||
         std::none_of(at, profile.seen.end(), shows);
}

/// A perceived crossing in terms of true tubes.
struct Placed {
  int over = -1, under = -1;
  std::size_t lower = 0;          ///< Index of the lower perceived tube.
  double from_m = 0.0, to_m = 0;  ///< Covered run of that.
};

std::vector<Placed> PlacePerceived(const TubeScene& scene, const TubeScore& pairs) {
  std::map<int, std::size_t> index_of_id;
  for (std::size_t i = 0; i < scene.tubes.size(); ++i) index_of_id[scene.tubes[i].id] = i;
  std::vector<int> true_of(scene.tubes.size(), -1);
  for (std::size_t t = 0; t < pairs.pair_of_true.size(); ++t) {
    if (pairs.pair_of_true[t] >= 0) {
      true_of[static_cast<std::size_t>(pairs.pair_of_true[t])] = static_cast<int>(t);
    }
  }
  std::vector<Placed> out;
  for (const Crossing& c : scene.crossings) {
    const std::size_t over = index_of_id.at(c.over), under = index_of_id.at(c.under);
    if (true_of[over] < 0 || true_of[under] < 0) continue;
    out.push_back({true_of[over], true_of[under], under, c.under_from_m, c.under_to_m});
  }
  return out;
}

/// Whether a perceived crossing's run and a run given by two of its points meet along a line.
bool Meet(const Placed& q, const Polyline& lower_N, const Vector3& from_N, const Vector3& to_N) {
  const double a = Closest(lower_N, from_N).s_m, b = Closest(lower_N, to_N).s_m;
  return q.from_m <= std::max(a, b) + kSameRun_m && q.to_m >= std::min(a, b) - kSameRun_m;
}

}  // namespace

CrossingScore ScoreCrossings(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                             const std::vector<SeenProfile>& seen, const TubeScore& pairs,
                             double radius_m) {
  CrossingScore score;
  const std::vector<Placed> perceived = PlacePerceived(scene, pairs);
  std::vector<char> explained(perceived.size(), 0);
  for (const Crossing& c : FindCrossings(true_lines_N, radius_m)) {
    const auto over = static_cast<std::size_t>(c.over), under = static_cast<std::size_t>(c.under);
    if (pairs.pair_of_true[over] < 0 || pairs.pair_of_true[under] < 0) continue;
    const Vector3 from_N = PointAt(true_lines_N[under], c.under_from_m);
    const Vector3 to_N = PointAt(true_lines_N[under], c.under_to_m);
    bool right = false, reversed = false;
    for (std::size_t k = 0; k < perceived.size(); ++k) {
      const Placed& q = perceived[k];
      const bool same = q.over == c.over && q.under == c.under;
      const bool other = q.over == c.under && q.under == c.over;
      if (!same && !other) continue;
      // A reversed one runs along the other tube.
      if (!Meet(q, scene.tubes[q.lower].centerline_N, from_N, to_N)) continue;
      right |= same;
      reversed |= other;
      explained[k] = 1;
    }
    const double reach_m = 4.0 * radius_m;
    const bool visible = seen[over].At(c.at_over_m) &&
                         ShowsOrEnds(seen[under], c.at_under_m, 1.0, reach_m) &&
                         ShowsOrEnds(seen[under], c.at_under_m, -1.0, reach_m);
    ++(visible ? score.visible : score.hidden);
    if (right) ++(visible ? score.visible_right : score.hidden_right);
    if (!visible &&
        (OnUnseenEnd(seen[over], c.at_over_m) || OnUnseenEnd(seen[under], c.at_under_m))) {
      ++score.on_unseen_end;
      if (right) ++score.on_unseen_end_right;
    }
    if (!right && reversed) ++(visible ? score.visible_reversed : score.hidden_reversed);
  }
  score.spurious = static_cast<int>(std::count(explained.begin(), explained.end(), 0));
  return score;
}

namespace {

/// A seen run of a true tube and where it lies along the perceived tube that owns it.
struct Run {
  std::size_t tube = 0;
  double from_m = 0.0, to_m = 0.0;
  int owner = -1;
  double at_from_m = 0.0, at_to_m = 0.0;  ///< Arc length along the owner.
};

std::vector<Run> RunsOf(std::size_t tube, const SeenProfile& profile) {
  std::vector<Run> out;
  for (std::size_t k = 0; k < profile.seen.size(); ++k) {
    if (profile.seen[k] == 0) continue;
    const double from = profile.bin_m * static_cast<double>(k);
    if (!out.empty() && from - out.back().to_m < kShortestGap_m) {
      out.back().to_m = from + profile.bin_m;
    } else {
      out.push_back({tube, from, from + profile.bin_m});
    }
  }
  std::erase_if(out, [](const Run& run) { return run.to_m - run.from_m < kShortestRun_m; });
  return out;
}

void FindOwner(Run& run, const TubeScene& scene, const Polyline& true_line_N) {
  std::vector<int> votes(scene.tubes.size(), 0);
  for (const Vector3& p : Resample(SubLine(true_line_N, run.from_m, run.to_m), 0.002)) {
    double nearest = -1.0;
    std::size_t best = 0;
    for (std::size_t k = 0; k < scene.tubes.size(); ++k) {
      const double d = Closest(scene.tubes[k].centerline_N, p).distance_m;
      // An axis point: half a radius off is another tube or none.
      if (d > (kReachRadii - 1.0) * scene.tubes[k].radius_m || (nearest >= 0.0 && d >= nearest)) {
        continue;
      }
      nearest = d;
      best = k;
    }
    if (nearest >= 0.0) ++votes[best];
  }
  const auto most = std::max_element(votes.begin(), votes.end());
  if (most == votes.end() || *most == 0) return;
  run.owner = static_cast<int>(most - votes.begin());
  const Polyline& line = scene.tubes[static_cast<std::size_t>(run.owner)].centerline_N;
  run.at_from_m = Closest(line, PointAt(true_line_N, run.from_m)).s_m;
  run.at_to_m = Closest(line, PointAt(true_line_N, run.to_m)).s_m;
}

/// Two facing ends: run index and 0 for its `from`, 1 for its `to`, the smaller first.
using Joint = std::array<std::size_t, 2>;

Joint MakeJoint(std::size_t end_a, std::size_t end_b) {
  return {std::min(end_a, end_b), std::max(end_a, end_b)};
}

}  // namespace

JointScore ScoreJoints(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                       const std::vector<SeenProfile>& seen) {
  std::vector<Run> runs;
  std::set<Joint> truth, perceived;
  for (std::size_t t = 0; t < seen.size(); ++t) {
    const std::size_t first = runs.size();
    for (Run& run : RunsOf(t, seen[t])) {
      FindOwner(run, scene, true_lines_N[t]);
      if (runs.size() > first) truth.insert(MakeJoint(2 * runs.size() - 1, 2 * runs.size()));
      runs.push_back(run);
    }
  }
  std::map<int, std::vector<std::size_t>> of_owner;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].owner >= 0) of_owner[runs[i].owner].push_back(i);
  }
  for (auto& [owner, list] : of_owner) {
    std::sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) {
      return runs[a].at_from_m + runs[a].at_to_m < runs[b].at_from_m + runs[b].at_to_m;
    });
    for (std::size_t k = 1; k < list.size(); ++k) {
      const Run& a = runs[list[k - 1]];
      const Run& b = runs[list[k]];
      perceived.insert(MakeJoint(2 * list[k - 1] + (a.at_from_m < a.at_to_m ? 1 : 0),
                                 2 * list[k] + (b.at_from_m < b.at_to_m ? 0 : 1)));
    }
  }
  JointScore score{static_cast<int>(truth.size()), static_cast<int>(perceived.size()), 0};
  for (const Joint& joint : truth) score.right += perceived.contains(joint);
  return score;
}

CenterlineErrors MeasureErrors(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                               const std::vector<SeenProfile>& seen, const TubeScore& pairs) {
  CenterlineErrors out;
  for (std::size_t t = 0; t < true_lines_N.size(); ++t) {
    if (!pairs.found_true[t]) continue;
    const auto pair = static_cast<std::size_t>(pairs.pair_of_true[t]);
    for (const Vector3& p : Resample(scene.tubes[pair].centerline_N, 0.005)) {
      const ClosestOnLine at = Closest(true_lines_N[t], p);
      (seen[t].At(at.s_m) ? out.seen_m : out.hidden_m).push_back(at.distance_m);
    }
  }
  return out;
}

}  // namespace tubetwin

#include "perception/joining/assemble.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "perception/joining/occluded_extension.h"

namespace tubetwin {
namespace {

/// Least seen part of a tube that is reported, as a share of its length and in radii.
constexpr double kMinSeen = 0.15;
constexpr double kMinSeenRadii = 4.0;
/// Radius by the points, as a share of the part's, from which on a chain is no tube of that part,
/// and the weight of evidence that this needs. A part file that is 20 % wrong still gets its tubes.
constexpr double kThinnest = 0.7, kThickest = 1.4;
constexpr double kRadiusWeight = 20.0;
/// Somewhere a tube shows enough of its roundness (rms sine of the normals; a strip of a third of
/// the upper half has this): a stick's edge or a fold does not.
constexpr double kRound = 0.3;
/// A wall's shadow leaves one side of a tube beside it: less of the roundness, but normals that
/// meet at the part's radius, which no edge has.
constexpr double kOneSideRound = 0.2;
constexpr double kSameRadius = 0.1;
/// Shorter lacks are within the error of two ends.
constexpr double kLack_m = 0.002;

void Append(PerceivedTube& tube, const Vector3& p_N, bool visible) {
  tube.centerline_N.push_back(p_N);
  tube.node_visible.push_back(visible ? 1 : 0);
}

/// Fragments and bridges one after another; the nodes of the fragments are the visible ones.
PerceivedTube Concatenate(const Chain& chain, const std::vector<Fragment>& fragments,
                          const std::vector<Bridge>& bridges) {
  PerceivedTube tube;
  for (std::size_t i = 0; i < chain.ends.size(); ++i) {
    const int entry = chain.ends[i];
    if (i > 0) {
      const Bridge& bridge = bridges[static_cast<std::size_t>(chain.bridges[i - 1])];
      Polyline line = bridge.line_N;
      if (bridge.end_b != entry) std::reverse(line.begin(), line.end());
      for (std::size_t k = 1; k + 1 < line.size(); ++k) Append(tube, line[k], false);
    }
    Polyline line = fragments[static_cast<std::size_t>(entry / 2)].line_N;
    if (entry % 2 == 1) std::reverse(line.begin(), line.end());
    for (const Vector3& p : line) Append(tube, p, true);
  }
  return tube;
}

double SeenLength(const PerceivedTube& tube) {
  double sum = 0.0;
  for (std::size_t i = 1; i < tube.centerline_N.size(); ++i) {
    if (tube.node_visible[i - 1] != 0 && tube.node_visible[i] != 0) {
      sum += (tube.centerline_N[i] - tube.centerline_N[i - 1]).norm();
    }
  }
  return sum;
}

const FragmentEnd& OuterEnd(const Chain& chain, const std::vector<Fragment>& fragments, int side) {
  const int end = side == 0 ? chain.ends.front() : chain.ends.back() ^ 1;
  return fragments[static_cast<std::size_t>(end / 2)].ends[static_cast<std::size_t>(end % 2)];
}

/// Prolongs a tube's open ends by `lack_m` in all, evenly as far as both have room, into what no
/// view saw. At which ends.
std::array<bool, 2> Complete(PerceivedTube& tube, const Chain& chain,
                             const OccludedExtensions& extensions, double lack_m) {
  Polyline added[2] = {extensions.Find(chain.ends.front(), lack_m, true),
                       extensions.Find(chain.ends.back() ^ 1, lack_m, true)};
  const auto wanted = static_cast<std::size_t>(std::ceil(lack_m / kNodeStep_m - 1e-9));
  // Both offer what is lacking, each takes its part; whole steps, the last one may be shorter.
  const std::size_t first = std::min(
      added[0].size(), std::max((wanted + 1) / 2, wanted - std::min(wanted, added[1].size())));
  added[0].resize(first);
  added[1].resize(std::min(added[1].size(), wanted - first));
  std::reverse(added[0].begin(), added[0].end());
  tube.centerline_N.insert(tube.centerline_N.begin(), added[0].begin(), added[0].end());
  tube.node_visible.insert(tube.node_visible.begin(), added[0].size(), 0);
  for (const Vector3& q : added[1]) Append(tube, q, false);
  return {!added[0].empty(), !added[1].empty()};
}

/// Takes the ends of the centerline that were not prolonged to the tips that were seen.
void ReachTips(PerceivedTube& tube, const Chain& chain, const std::vector<Fragment>& fragments,
               const std::array<bool, 2>& prolonged) {
  for (int side = 0; side < 2; ++side) {
    const FragmentEnd& end = OuterEnd(chain, fragments, side);
    const int steps = static_cast<int>(std::ceil(end.tip_m / kNodeStep_m - 1e-9));
    if (prolonged[static_cast<std::size_t>(side)]) continue;
    for (int k = 1; k <= steps; ++k) {
      const Vector3 p = end.p_N + end.tip_m * k / steps * end.outward_N;
      if (side == 1) {
        Append(tube, p, true);
        continue;
      }
      tube.centerline_N.insert(tube.centerline_N.begin(), p);
      tube.node_visible.insert(tube.node_visible.begin(), 1);
    }
  }
}

/// 0..1 from how well the pieces fit, how much better this way to join them is than the next best,
/// joints that are unlikely in themselves, how much was seen, and how far the length is from the
/// part's.
double Confidence(const PerceivedTube& tube, const Chain& chain,
                  const std::vector<Fragment>& fragments, const std::vector<Bridge>& bridges,
                  double tube_length_m) {
  double fit = 1.0, joints = 0.0;
  for (const int e : chain.ends)
    fit = std::min(fit, fragments[static_cast<std::size_t>(e / 2)].fit);
  for (const int b : chain.bridges) {
    joints += std::max(0.0, bridges[static_cast<std::size_t>(b)].cost);
  }
  const double only = 1.0 / (1.0 + std::exp(-chain.margin));
  const double lack = std::abs(tube.length_m - tube_length_m) / tube_length_m;
  const double seen = std::min(1.0, tube.visible_fraction / 0.7);
  return std::clamp(std::min(1.0, fit / 0.8) * only * std::exp(-joints / 6.0) *
                        std::exp(-3.0 * lack) * (0.4 + 0.6 * seen),
                    0.0, 1.0);
}

/// Whether the points themselves speak for another radius: a cable, a thicker pipe.
bool HasOtherRadius(const Chain& chain, const std::vector<Fragment>& fragments, double radius_m) {
  double sum = 0.0, weight = 0.0;
  for (const int e : chain.ends) {
    const Fragment& f = fragments[static_cast<std::size_t>(e / 2)];
    sum += f.radius_weight * f.radius_m;
    weight += f.radius_weight;
  }
  return weight > kRadiusWeight &&
         (sum < kThinnest * radius_m * weight || sum > kThickest * radius_m * weight);
}

bool IsRound(const Chain& chain, const std::vector<Fragment>& fragments, double radius_m) {
  return std::any_of(chain.ends.begin(), chain.ends.end(), [&](int e) {
    const Fragment& f = fragments[static_cast<std::size_t>(e / 2)];
    if (f.normal_spread >= kRound) return true;
    return f.normal_spread >= kOneSideRound && f.radius_weight > kRadiusWeight &&
           std::abs(f.radius_m - radius_m) <= kSameRadius * radius_m;
  });
}

bool TouchesBin(const Polyline& line, const Bin& bin) {
  return std::any_of(line.begin(), line.end(), [&bin](const Vector3& p) {
    return std::abs(p.x()) < bin.half_x_m() && std::abs(p.y()) < bin.half_y_m();
  });
}

}  // namespace

std::vector<PerceivedTube> AssembleTubes(const std::vector<Chain>& chains,
                                         const std::vector<Fragment>& fragments,
                                         const std::vector<Bridge>& bridges,
                                         const OccludedSpace& space, const Bin& bin,
                                         double tube_length_m) {
  std::vector<const Chain*> order;
  for (const Chain& chain : chains) order.push_back(&chain);
  std::sort(order.begin(), order.end(), [](const Chain* a, const Chain* b) {
    return *std::min_element(a->ends.begin(), a->ends.end()) <
           *std::min_element(b->ends.begin(), b->ends.end());
  });
  const double min_m = std::max(kMinSeen * tube_length_m, kMinSeenRadii * space.radius_m());
  const OccludedExtensions extensions(fragments, space);
  std::vector<PerceivedTube> out;
  for (const Chain* chain : order) {
    PerceivedTube tube = Concatenate(*chain, fragments, bridges);
    const double seen_m = SeenLength(tube);
    if (seen_m < min_m || !IsRound(*chain, fragments, space.radius_m())) continue;
    if (HasOtherRadius(*chain, fragments, space.radius_m())) continue;
    if (!TouchesBin(tube.centerline_N, bin)) continue;
    double lack_m = tube_length_m - chain->length_m;
    for (int side = 0; side < 2; ++side) lack_m -= OuterEnd(*chain, fragments, side).tip_m;
    std::array<bool, 2> prolonged = {false, false};
    if (lack_m > kLack_m) prolonged = Complete(tube, *chain, extensions, lack_m);
    ReachTips(tube, *chain, fragments, prolonged);
    tube.id = static_cast<int>(out.size());
    tube.radius_m = space.radius_m();
    tube.length_m = Length(tube.centerline_N);
    tube.visible_fraction = std::clamp(SeenLength(tube) / tube.length_m, 0.0, 1.0);
    tube.confidence = Confidence(tube, *chain, fragments, bridges, tube_length_m);
    out.push_back(std::move(tube));
  }
  return out;
}

}  // namespace tubetwin

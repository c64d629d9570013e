#include "perception/joining/bridges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "perception/scene/near_lines.h"

namespace tubetwin {
namespace {

/// How much deeper than a tube's surface a view must see, in radii: a bridge is a guess and may be
/// that far off.
constexpr double kSlack = 0.4;
/// Axes of touching tubes come this much closer than two radii in piles where contacts give.
constexpr double kContact_m = 0.001;
/// A bridge is a guess: it may come closer to another tube, at a price (1 for the square of this
/// depth), but not closer than so many radii.
constexpr double kPenetrationUnit_m = 0.003;
constexpr double kClosestRadii = 1.5;
/// Log-odds (nats) of a bridge from the bending energy E (1/m) over a gap g: kOdds ln(E g^2 /
/// kEven), from counts of true and false candidates in generated piles: at 60 mm a turn of 30
/// degrees is as often true as false, at 110 mm one of 17. Straight long gaps are more often chance
/// than short ones.
constexpr double kOdds = 3.0;
constexpr double kLongGap_m = 0.1;
constexpr double kLongGapUnit_m = 0.1;
/// Cost of a way that no view confirms to be hidden, and of leaving through a closed end.
constexpr double kUnconfirmed = 0.7;
constexpr double kClosedEnd = 3.0;
/// Costs beyond this are no explanation.
constexpr double kDearest = 8.0;
/// Ends closer than this (in radii) belong to one tube, whatever they look like: axes of two tubes
/// stay two radii apart. A sharp bend breaks a fragment and looks like a cap from both sides.
constexpr double kSameTubeRadii = 1.6;
constexpr double kSameTubeCost = -5.0;
/// Shorter gaps say nothing about direction.
constexpr double kShortestChord_m = 0.02;

}  // namespace

OccludedSpace::OccludedSpace(const std::vector<ViewImage>& views, const Bin& bin, double radius_m)
    : views_(views), bin_(bin), radius_m_(radius_m) {}

Visibility OccludedSpace::Query(const Vector3& p_N) const {
  Visibility out = Visibility::kOutside;
  for (const ViewImage& view : views_) {
    const Visibility visibility = QueryVisibility(view, p_N, radius_m_, kSlack * radius_m_);
    if (visibility == Visibility::kSeenThrough) return visibility;
    // The most telling of the others: enumerators grow with what they say.
    out = std::max(out, visibility);
  }
  return out;
}

bool OccludedSpace::FitsBin(const Vector3& p_N) const {
  const double r = radius_m_;
  if (p_N.z() < r - 0.003) return false;
  if (p_N.z() > bin_.wall_m()) return true;
  const double out =
      std::max(std::abs(p_N.x()) - bin_.half_x_m(), std::abs(p_N.y()) - bin_.half_y_m());
  return out < 0.003 - r || out > Bin::kWallThickness_m + r - 0.003;
}

namespace {

/// Cubic between two ends that leaves and arrives along their tangents; the smaller `stiffness`,
/// the closer to the chord it runs in between.
Polyline Cubic(const FragmentEnd& a, const FragmentEnd& b, double stiffness) {
  const double chord = (b.p_N - a.p_N).norm();
  const Vector3 m0 = stiffness * chord * a.outward_N, m1 = -stiffness * chord * b.outward_N;
  const int pieces = std::max(1, static_cast<int>(std::ceil(1.2 * chord / kNodeStep_m)));
  Polyline line;
  for (int i = 0; i <= pieces; ++i) {
    const double t = static_cast<double>(i) / pieces, t2 = t * t, t3 = t2 * t;
    line.push_back((2 * t3 - 3 * t2 + 1) * a.p_N + (t3 - 2 * t2 + t) * m0 +
                   (3 * t2 - 2 * t3) * b.p_N + (t3 - t2) * m1);
  }
  return line;
}

/// Straight on from both ends to where the two rays come closest: the way of a tube with a corner.
/// Empty when the rays part, or come closest beyond the chord's length.
Polyline Corner(const FragmentEnd& a, const FragmentEnd& b) {
  const Vector3 w = b.p_N - a.p_N;
  const double c = a.outward_N.dot(b.outward_N), parallel = 1.0 - c * c;
  if (parallel < 1e-3) return {};
  const double s = (w.dot(a.outward_N) - c * w.dot(b.outward_N)) / parallel;
  const double t = (c * w.dot(a.outward_N) - w.dot(b.outward_N)) / parallel;
  if (s <= 0.0 || t <= 0.0 || std::max(s, t) > w.norm()) return {};
  const Vector3 corner = 0.5 * (a.p_N + s * a.outward_N + b.p_N + t * b.outward_N);
  return Resample({a.p_N, corner, b.p_N}, kNodeStep_m);
}

/// Energy of a thin beam between two tangents, closed form, over the chord.
double BendingEnergy(const FragmentEnd& a, const FragmentEnd& b) {
  const Vector3 chord = b.p_N - a.p_N;
  const double length = std::max(chord.norm(), kShortestChord_m);
  const Vector3 c = chord.normalized();
  auto angle = [&c](const Vector3& t) -> Vector3 {
    const Vector3 across = t - t.dot(c) * c;
    const double sine = across.norm();
    return sine < 1e-9 ? Vector3::Zero() : Vector3(std::atan2(sine, t.dot(c)) / sine * across);
  };
  const Vector3 alpha = angle(a.outward_N), beta = angle(-b.outward_N);
  return 4.0 / length * (alpha.squaredNorm() + alpha.dot(beta) + beta.squaredNorm());
}

/// What a way through the unseen costs beyond its shape; nothing when something forbids it.
std::optional<double> CostOfPlace(const Bridge& bridge, const NearLines& lines,
                                  const OccludedSpace& space) {
  const double r = space.radius_m();
  int unknown = 0, denied_in_a_row = 0;
  double nearest = 2 * r;  // What is further away costs nothing.
  // Next to its ends a bridge is where the fragments' own edges are seen.
  for (std::size_t i = 1; i + 1 < bridge.line_N.size(); ++i) {
    const Vector3& p = bridge.line_N[i];
    if (!space.FitsBin(p)) return std::nullopt;
    nearest = lines.Distance(p, nearest, bridge.end_a / 2, bridge.end_b / 2);
    if (nearest < kClosestRadii * r) return std::nullopt;
    const Visibility visibility = space.Query(p);
    denied_in_a_row = visibility == Visibility::kSeenThrough ? denied_in_a_row + 1 : 0;
    if (denied_in_a_row >= 2) return std::nullopt;
    unknown += visibility == Visibility::kUnknown || visibility == Visibility::kOutside;
  }
  const double depth = std::max(0.0, 2 * r - kContact_m - nearest) / kPenetrationUnit_m;
  return depth * depth +
         kUnconfirmed * static_cast<double>(unknown) / static_cast<double>(bridge.line_N.size());
}

/// The cheapest bridge between two ends; nothing when every way is forbidden or too dear.
std::optional<Bridge> BestWay(const std::vector<Fragment>& fragments, const NearLines& lines, int i,
                              int k, const OccludedSpace& space, double longest_m) {
  const FragmentEnd& a = fragments[static_cast<std::size_t>(i / 2)].ends[i % 2];
  const FragmentEnd& b = fragments[static_cast<std::size_t>(k / 2)].ends[k % 2];
  const double chord = (b.p_N - a.p_N).norm();
  if (chord > longest_m) return std::nullopt;
  if (chord < kSameTubeRadii * space.radius_m()) {
    return Bridge{i, k, {a.p_N, b.p_N}, chord, kSameTubeCost};
  }
  const double bent_m = BendingEnergy(a, b) * chord * chord;
  const double cost_of_shape = kOdds * std::log((bent_m + kStraightest_m) / kEven_m) +
                               std::max(0.0, chord - kLongGap_m) / kLongGapUnit_m +
                               kClosedEnd * (a.cap + b.cap);
  if (cost_of_shape > kDearest) return std::nullopt;
  std::optional<Bridge> best;
  for (Polyline& line : std::array{Cubic(a, b, 1.0), Cubic(a, b, 0.4), Corner(a, b)}) {
    if (line.empty()) continue;
    Bridge way{i, k, std::move(line), 0.0, 0.0};
    const auto cost = CostOfPlace(way, lines, space);
    if (!cost) continue;
    way.cost = cost_of_shape + *cost;
    way.length_m = Length(way.line_N);
    if (way.cost <= kDearest && (!best || way.cost < best->cost)) best = std::move(way);
  }
  return best;
}

}  // namespace

std::vector<Bridge> FindBridges(const std::vector<Fragment>& fragments, const OccludedSpace& space,
                                double longest_m) {
  std::vector<Bridge> out;
  NearLines lines;
  for (const Fragment& fragment : fragments) lines.Add(fragment.line_N);
  const int ends = 2 * static_cast<int>(fragments.size());
  for (int i = 0; i < ends; ++i) {
    for (int k = i + 1; k < ends; ++k) {
      if (i / 2 == k / 2) continue;
      auto bridge = BestWay(fragments, lines, i, k, space, longest_m);
      if (bridge) out.push_back(std::move(*bridge));
    }
  }
  return out;
}

}  // namespace tubetwin

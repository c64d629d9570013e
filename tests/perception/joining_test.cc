#include "perception/joining/joining.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "models/base/random.h"
#include "perception/joining/chains.h"
#include "tests/support/catch.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

/// A straight fragment between two points, ends open.
Fragment Piece(const Vector3& from, const Vector3& to) {
  Fragment out;
  out.line_N = Resample({from, to}, kNodeStep_m);
  out.length_m = (to - from).norm();
  out.fit = 1.0;
  out.normal_spread = 0.5;
  const Vector3 t = (to - from).normalized();
  out.ends = {FragmentEnd{from, -t, 0.0}, FragmentEnd{to, t, 0.0}};
  return out;
}

/// Bridges of fragments that no view looks at: shape and bin alone decide.
struct Unseen {
  explicit Unseen(std::vector<Fragment> pieces) : fragments(std::move(pieces)) {
    const OccludedSpace space(views, bin, kRadius);
    bridges = FindBridges(fragments, space, 0.3);
  }
  std::vector<Chain> Join(double tube_length_m) const {
    return JoinFragments(fragments, bridges, std::vector<double>(2 * fragments.size(), 0.0),
                         tube_length_m);
  }
  std::vector<ViewImage> views;
  Bin bin;
  std::vector<Fragment> fragments;
  std::vector<Bridge> bridges;
};

std::set<std::set<int>> MembersOf(const std::vector<Chain>& chains) {
  std::set<std::set<int>> out;
  for (const Chain& chain : chains) {
    std::set<int> members;
    for (const int e : chain.ends) members.insert(e / 2);
    out.insert(members);
  }
  return out;
}

/// Two straight tubes of 0.4 m that cross at `angle` behind something 0.1 m wide.
std::vector<Fragment> HiddenCrossing(double angle, double height_m) {
  const Vector3 u(1, 0, 0), v(std::cos(angle), std::sin(angle), 0);
  const Vector3 low(0, 0, kRadius), high(0, 0, kRadius + height_m);
  return {Piece(low - 0.2 * u, low - 0.05 * u), Piece(low + 0.05 * u, low + 0.2 * u),
          Piece(high - 0.2 * v, high - 0.05 * v), Piece(high + 0.05 * v, high + 0.2 * v)};
}

TEST_CASE("Two tubes that cross out of sight go straight on, with a margin", "[unit]") {
  for (const double angle_deg : {25.0, 40.0, 60.0, 90.0}) {
    const Unseen scene(HiddenCrossing(Radians(angle_deg), 2 * kRadius));
    const auto chains = scene.Join(0.4);
    INFO(angle_deg);
    CHECK(MembersOf(chains) == std::set<std::set<int>>{{0, 1}, {2, 3}});
    for (const Chain& chain : chains) {
      CHECK(chain.length_m == Approx(0.4).epsilon(1e-3));
      CHECK(chain.margin > 2.0);
    }
  }
}

TEST_CASE("An end with two continuations that are as good leaves hardly any margin", "[unit]") {
  // A stem and two branches, mirror images of one another.
  const Vector3 branch(std::cos(0.15), std::sin(0.15), 0);
  const Vector3 mirrored(branch.x(), -branch.y(), 0);
  const Vector3 from(0.10, 0.0, kRadius), apart(0, 0.02, 0);
  const Unseen scene({Piece({-0.2, 0, kRadius}, {0, 0, kRadius}),
                      Piece(from + apart, from + apart + 0.1 * branch),
                      Piece(from - apart, from - apart + 0.1 * mirrored)});
  for (const Chain& chain : scene.Join(0.4)) CHECK(chain.margin < 0.1);
}

TEST_CASE("The length of a tube decides between two ways to go on", "[unit]") {
  // Straight on lies a piece that would make a tube of 0.55 m, beside it one that makes 0.40 m.
  const Vector3 aside = 0.06 * Vector3(std::cos(0.5), std::sin(0.5), 0);
  const auto pieces = [&](double straight_m, double bent_m) {
    return std::vector<Fragment>{
        Piece({-0.2, 0, kRadius}, {0, 0, kRadius}),
        Piece({0.06, 0, kRadius}, {0.06 + straight_m, 0, kRadius}),
        Piece(Vector3(0, 0, kRadius) + aside,
              Vector3(0, 0, kRadius) + aside + bent_m * Vector3(std::cos(1.0), std::sin(1.0), 0))};
  };
  CHECK(MembersOf(Unseen(pieces(0.29, 0.14)).Join(0.4)).contains({0, 2}));
  CHECK(MembersOf(Unseen(pieces(0.14, 0.29)).Join(0.4)).contains({0, 1}));
}

TEST_CASE("A sharp bend that broke a fragment is joined across its two caps", "[unit]") {
  std::vector<Fragment> pieces = {Piece({-0.2, 0, kRadius}, {0, 0, kRadius}),
                                  Piece({0.012, 0.008, kRadius}, {0.012, 0.2, kRadius})};
  pieces[0].ends[1].cap = pieces[1].ends[0].cap = 1.0;
  CHECK(MembersOf(Unseen(pieces).Join(0.41)) == std::set<std::set<int>>{{0, 1}});
}

TEST_CASE("Two closed ends in line are two tubes when the length allows both", "[unit]") {
  std::vector<Fragment> pieces = {Piece({-0.25, 0, kRadius}, {-0.05, 0, kRadius}),
                                  Piece({0.05, 0, kRadius}, {0.25, 0, kRadius})};
  for (Fragment& piece : pieces) piece.ends[0].cap = piece.ends[1].cap = 1.0;
  CHECK(Unseen(pieces).Join(0.2).size() == 2);
}

/// Cost of the best set of chains over the fragments from `first` on, by trying all.
double BestOfAll(const std::vector<Chain>& chains, std::vector<char>& covered, int banned) {
  const auto open = std::find(covered.begin(), covered.end(), 0);
  if (open == covered.end()) return 0.0;
  const int row = static_cast<int>(open - covered.begin());
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const auto& ends = chains[c].ends;
    const bool holds = std::any_of(ends.begin(), ends.end(), [row](int e) { return e / 2 == row; });
    const bool fits = std::none_of(ends.begin(), ends.end(), [&](int e) {
      return covered[static_cast<std::size_t>(e / 2)] != 0;
    });
    if (!holds || !fits || static_cast<int>(c) == banned) continue;
    for (const int e : ends) covered[static_cast<std::size_t>(e / 2)] = 1;
    best = std::min(best, chains[c].cost + BestOfAll(chains, covered, banned));
    for (const int e : ends) covered[static_cast<std::size_t>(e / 2)] = 0;
  }
  return best;
}

TEST_CASE("The chosen chains cost as little as the best of all sets, margins are exact", "[unit]") {
  RandomStream stream(4, 0, "joining");
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Fragment> pieces;
    const int count = 3 + static_cast<int>(stream.Index(5));
    for (int i = 0; i < count; ++i) {
      const Vector3 from(0.3 * i, 0, kRadius);
      pieces.push_back(Piece(from, from + Vector3(stream.Uniform(0.02, 0.2), 0, 0)));
    }
    std::vector<Bridge> bridges;
    std::vector<double> max_extensions_m;
    for (int a = 0; a < 2 * count; ++a) {
      max_extensions_m.push_back(stream.Uniform() < 0.5 ? 0.0 : stream.Uniform(0.0, 0.2));
      for (int b = a + 1; b < 2 * count; ++b) {
        if (a / 2 == b / 2 || stream.Uniform() < 0.4) continue;
        bridges.push_back({a, b, {}, stream.Uniform(0.02, 0.1), stream.Uniform(-5.0, 6.0)});
      }
    }
    const auto all = FindChains(pieces, bridges, max_extensions_m, 0.4);
    const auto chosen = JoinFragments(pieces, bridges, max_extensions_m, 0.4);
    std::vector<char> covered(pieces.size(), 0);
    double cost = 0.0;
    std::multiset<int> members;
    for (const Chain& chain : chosen) {
      cost += chain.cost;
      for (const int e : chain.ends) members.insert(e / 2);
    }
    REQUIRE(members.size() == pieces.size());
    CHECK(std::set<int>(members.begin(), members.end()).size() == pieces.size());
    const double best = BestOfAll(all, covered, -1);
    CHECK(cost == Approx(best).margin(1e-9));
    for (const Chain& chain : chosen) {
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const Chain& c) { return c.ends == chain.ends; });
      const double without = BestOfAll(all, covered, static_cast<int>(same - all.begin()));
      CHECK(chain.margin == Approx(std::min(kMaxMargin, without - best)).margin(1e-9));
    }
  }
}

}  // namespace
}  // namespace tubetwin

#include "perception/joining.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tubetwin {
namespace {

/// A chain may be this much longer than the part says (share, and at least so many metres).
constexpr double kLonger = 0.03;
constexpr double kLonger_m = 0.012;
/// Missing length that costs 1, and the most that missing length can cost.
constexpr double kMissingUnit_m = 0.03;
constexpr double kMostMissing = 4.0;
/// A missing piece is believed more easily where an end is open.
constexpr double kOpenDiscount = 0.2;
/// Bounds on the search; never reached by piles of a dozen tubes.
constexpr std::size_t kMostChains = 20000;
constexpr std::size_t kMostFragments = 10;
constexpr int kMostSteps = 400000;
constexpr int kBridgesPerEnd = 6;

class ChainFinder {
 public:
  ChainFinder(const std::vector<Fragment>& fragments, const std::vector<Bridge>& bridges,
              double tube_length_m)
      : fragments_(fragments),
        bridges_(bridges),
        tube_length_m_(tube_length_m),
        at_end_(2 * fragments.size()) {
    std::vector<int> order(bridges.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return bridges[static_cast<std::size_t>(a)].cost < bridges[static_cast<std::size_t>(b)].cost;
    });
    for (const int i : order) {
      const Bridge& b = bridges[static_cast<std::size_t>(i)];
      auto& from = at_end_[static_cast<std::size_t>(b.end_a)];
      auto& to = at_end_[static_cast<std::size_t>(b.end_b)];
      if (static_cast<int>(from.size()) < kBridgesPerEnd) from.push_back(i);
      if (static_cast<int>(to.size()) < kBridgesPerEnd) to.push_back(i);
    }
  }

  std::vector<Chain> FindAll() {
    for (std::size_t f = 0; f < fragments_.size(); ++f) {
      for (int entry = 0; entry < 2; ++entry) {
        Chain chain;
        chain.ends.push_back(2 * static_cast<int>(f) + entry);
        chain.length_m = fragments_[f].length_m;
        Extend(chain);
      }
    }
    return std::move(chains_);
  }

 private:
  double longest() const { return tube_length_m_ + std::max(kLonger_m, kLonger * tube_length_m_); }

  double CapAt(int end) const {
    return fragments_[static_cast<std::size_t>(end / 2)].ends[end % 2].cap;
  }

  /// The chain with what its ends and its length cost.
  Chain Closed(Chain chain) const {
    const double open = 2.0 - CapAt(chain.ends.front()) - CapAt(chain.ends.back() ^ 1);
    const double missing_m = std::max(0.0, tube_length_m_ - chain.length_m);
    chain.cost += std::min(kMostMissing, missing_m / kMissingUnit_m) * (1.0 - kOpenDiscount * open);
    return chain;
  }

  void Extend(const Chain& chain) {
    // Each chain is found from both sides: keep the one that starts at the lower end.
    const int exit = chain.ends.back() ^ 1;
    if (chain.ends.front() < exit && chains_.size() < kMostChains) {
      chains_.push_back(Closed(chain));
    }
    if (chain.ends.size() >= kMostFragments || chains_.size() >= kMostChains) return;
    for (const int i : at_end_[static_cast<std::size_t>(exit)]) {
      const Bridge& bridge = bridges_[static_cast<std::size_t>(i)];
      const int entry = bridge.end_a == exit ? bridge.end_b : bridge.end_a;
      const bool used = std::any_of(chain.ends.begin(), chain.ends.end(),
                                    [entry](int e) { return e / 2 == entry / 2; });
      if (used) continue;
      const double length_m = chain.length_m + bridge.length_m +
                              fragments_[static_cast<std::size_t>(entry / 2)].length_m;
      if (length_m > longest()) continue;
      Chain next = chain;
      next.ends.push_back(entry);
      next.bridges.push_back(i);
      next.length_m = length_m;
      next.cost += bridge.cost;
      Extend(next);
    }
  }

  const std::vector<Fragment>& fragments_;
  const std::vector<Bridge>& bridges_;
  double tube_length_m_;
  std::vector<std::vector<int>> at_end_;
  std::vector<Chain> chains_;
};

/// Chooses chains that cover every fragment once at the least cost.
class Partition {
 public:
  Partition(std::vector<Chain> chains, std::size_t fragments)
      : chains_(std::move(chains)),
        of_fragment_(fragments),
        share_(fragments, 1e9),
        covered_(fragments, 0) {
    std::stable_sort(chains_.begin(), chains_.end(), [](const Chain& a, const Chain& b) {
      return a.cost / static_cast<double>(a.ends.size()) <
             b.cost / static_cast<double>(b.ends.size());
    });
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      for (const int end : chains_[c].ends) {
        const auto f = static_cast<std::size_t>(end / 2);
        of_fragment_[f].push_back(static_cast<int>(c));
        share_[f] =
            std::min(share_[f], chains_[c].cost / static_cast<double>(chains_[c].ends.size()));
      }
    }
  }

  std::vector<Chain> Solve() {
    double bound = 0.0;
    for (const double s : share_) bound += s;
    Search(0.0, bound);
    std::vector<Chain> out;
    for (const int c : best_) out.push_back(chains_[static_cast<std::size_t>(c)]);
    return out;
  }

 private:
  bool Fits(const Chain& chain) const {
    return std::none_of(chain.ends.begin(), chain.ends.end(),
                        [this](int e) { return covered_[static_cast<std::size_t>(e / 2)] != 0; });
  }

  void Search(double cost, double bound) {
    if (cost + bound >= best_cost_ - 1e-12 || ++steps_ > kMostSteps) return;
    std::size_t open = covered_.size();
    for (std::size_t f = 0; f < covered_.size(); ++f) {
      if (covered_[f] == 0 &&
          (open == covered_.size() || of_fragment_[f].size() < of_fragment_[open].size())) {
        open = f;
      }
    }
    if (open == covered_.size()) {
      best_cost_ = cost;
      best_ = chosen_;
      return;
    }
    for (const int c : of_fragment_[open]) {
      const Chain& chain = chains_[static_cast<std::size_t>(c)];
      if (!Fits(chain)) continue;
      double rest = bound;
      for (const int e : chain.ends) {
        covered_[static_cast<std::size_t>(e / 2)] = 1;
        rest -= share_[static_cast<std::size_t>(e / 2)];
      }
      chosen_.push_back(c);
      Search(cost + chain.cost, rest);
      chosen_.pop_back();
      for (const int e : chain.ends) covered_[static_cast<std::size_t>(e / 2)] = 0;
    }
  }

  std::vector<Chain> chains_;
  std::vector<std::vector<int>> of_fragment_;
  std::vector<double> share_;
  std::vector<char> covered_;
  std::vector<int> chosen_, best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
  int steps_ = 0;
};

}  // namespace

std::vector<Chain> JoinFragments(const std::vector<Fragment>& fragments,
                                 const std::vector<Bridge>& bridges, double tube_length_m) {
  ChainFinder finder(fragments, bridges, tube_length_m);
  Partition partition(finder.FindAll(), fragments.size());
  return partition.Solve();
}

}  // namespace tubetwin

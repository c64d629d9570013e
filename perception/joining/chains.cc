#include "perception/joining/chains.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

/// Costs are negative log-odds (nats).
///
/// A chain may be this much longer than a tube; deviations of its length in both directions are
/// normal with these sigmas: of two ends, and per metre of bridges, whose way is a guess.
constexpr double kLonger_m = 0.030;
constexpr double kLengthSigma_m = 0.004;
constexpr double kBridgeSigma = 0.06;
/// The most that a wrong length costs: chains of fragments that are no whole tube exist (debris,
/// fragments that were not found).
constexpr double kMaxLength = 7.0;
/// Hidden length that costs 1, and what hiding costs at all.
constexpr double kHiddenUnit_m = 0.12;
constexpr double kHidden = 0.5;
/// A hidden end may turn: it hides this much more than straight on.
constexpr double kRoomSlack = 1.3;
constexpr double kRoomSlack_m = 0.015;
/// Bounds on the search; never reached by piles of two dozen tubes.
constexpr std::size_t kMaxTried = 300000;
constexpr std::size_t kMaxFragments = 12;
constexpr int kBridgesPerEnd = 8;

class ChainFinder {
 public:
  ChainFinder(const std::vector<Fragment>& fragments, const std::vector<Bridge>& bridges,
              const std::vector<double>& max_extensions_m, double tube_length_m)
      : fragments_(fragments),
        bridges_(bridges),
        max_extensions_m_(max_extensions_m),
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
      Chain chain;
      chain.ends.push_back(2 * static_cast<int>(f));
      chain.length_m = fragments_[f].length_m;
      chain.cost = EndCost(chain);
      chains_.push_back(chain);
    }
    for (std::size_t f = 0; f < fragments_.size(); ++f) {
      for (int entry = 0; entry < 2; ++entry) {
        Chain chain;
        chain.ends.push_back(2 * static_cast<int>(f) + entry);
        chain.length_m = fragments_[f].length_m;
        Extend(chain);
      }
    }
    std::stable_sort(chains_.begin(), chains_.end(),
                     [](const Chain& a, const Chain& b) { return a.cost < b.cost; });
    return std::move(chains_);
  }

 private:
  /// What the length and the two ends of a chain cost.
  double EndCost(const Chain& chain) const {
    double bridged_m = 0.0;
    for (const int b : chain.bridges) bridged_m += bridges_[static_cast<std::size_t>(b)].length_m;
    const double sigma_m = kLengthSigma_m + kBridgeSigma * bridged_m;
    double off_m = chain.length_m - tube_length_m_;
    double cost = 0.0;
    if (off_m < -sigma_m) {
      const double max_extension_m =
          max_extensions_m_[static_cast<std::size_t>(chain.ends.front())] +
          max_extensions_m_[static_cast<std::size_t>(chain.ends.back() ^ 1)];
      const double slack_m =
          max_extension_m > 0.0 ? kRoomSlack * max_extension_m + kRoomSlack_m : 0.0;
      const double hidden_m = std::min(-off_m, slack_m);
      if (hidden_m > 0.0) cost = kHidden + hidden_m / kHiddenUnit_m;
      off_m += hidden_m;
    }
    return cost + std::min(kMaxLength, 0.5 * off_m * off_m / (sigma_m * sigma_m));
  }

  /// Cost of the part of a chain from fragment `from` to `to`, the latter excluded.
  double CostOfPart(const Chain& chain, std::size_t from, std::size_t to) const {
    Chain part;
    part.ends.assign(chain.ends.begin() + static_cast<std::ptrdiff_t>(from),
                     chain.ends.begin() + static_cast<std::ptrdiff_t>(to));
    part.bridges.assign(chain.bridges.begin() + static_cast<std::ptrdiff_t>(from),
                        chain.bridges.begin() + static_cast<std::ptrdiff_t>(to - 1));
    for (const int e : part.ends) {
      part.length_m += fragments_[static_cast<std::size_t>(e / 2)].length_m;
    }
    double cost = 0.0;
    for (const int b : part.bridges) {
      part.length_m += bridges_[static_cast<std::size_t>(b)].length_m;
      cost += bridges_[static_cast<std::size_t>(b)].cost;
    }
    return cost + EndCost(part);
  }

  /// Whether a chain is cheaper when it is cut somewhere: then no best solution holds it.
  bool CheaperCut(const Chain& chain) const {
    for (std::size_t k = 1; k < chain.ends.size(); ++k) {
      if (CostOfPart(chain, 0, k) + CostOfPart(chain, k, chain.ends.size()) <= chain.cost) {
        return true;
      }
    }
    return false;
  }

  void Extend(const Chain& chain) {
    const int exit = chain.ends.back() ^ 1;
    // Each chain is found from both sides: keep the one that starts at the lower end.
    if (chain.ends.size() > 1 && chain.ends.front() < exit) {
      Chain closed = chain;
      closed.cost += EndCost(chain);
      if (!CheaperCut(closed)) chains_.push_back(std::move(closed));
    }
    if (chain.ends.size() >= kMaxFragments || ++tried_ > kMaxTried) return;
    for (const int i : at_end_[static_cast<std::size_t>(exit)]) {
      const Bridge& bridge = bridges_[static_cast<std::size_t>(i)];
      const int entry = bridge.end_a == exit ? bridge.end_b : bridge.end_a;
      const bool used = std::any_of(chain.ends.begin(), chain.ends.end(),
                                    [entry](int e) { return e / 2 == entry / 2; });
      if (used) continue;
      const double length_m = chain.length_m + bridge.length_m +
                              fragments_[static_cast<std::size_t>(entry / 2)].length_m;
      if (length_m > tube_length_m_ + kLonger_m) continue;
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
  const std::vector<double>& max_extensions_m_;
  double tube_length_m_;
  std::vector<std::vector<int>> at_end_;
  std::vector<Chain> chains_;
  std::size_t tried_ = 0;
};

}  // namespace

std::vector<Chain> FindChains(const std::vector<Fragment>& fragments,
                              const std::vector<Bridge>& bridges,
                              const std::vector<double>& max_extensions_m, double tube_length_m) {
  return ChainFinder(fragments, bridges, max_extensions_m, tube_length_m).FindAll();
}

}  // namespace tubetwin

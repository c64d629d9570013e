#include "perception/joining/joining.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/joining/chains.h"

namespace tubetwin {
namespace {

/// Steps of the search for the best set and for each runner-up.
constexpr int kMaxSteps = 200000;
constexpr int kRunnerUpSteps = 3000;
/// Steps of the ascent to the duals.
constexpr int kAscents = 120;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Chooses columns (chains) that cover every row (fragment) exactly once at the least cost.
class SetPartition {
 public:
  SetPartition(const std::vector<Chain>& chains, std::size_t rows)
      : chains_(chains), of_row_(rows), dual_(rows, 0.0), reduced_(chains.size()), covered_(rows) {
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      for (const int e : chains_[c].ends) of_row_[Row(e)].push_back(static_cast<int>(c));
    }
    FindDuals();
    for (std::size_t c = 0; c < chains_.size(); ++c) reduced_[c] = Reduced(chains_[c], dual_);
    for (auto& list : of_row_) {
      std::stable_sort(list.begin(), list.end(), [this](int a, int b) {
        return reduced_[static_cast<std::size_t>(a)] < reduced_[static_cast<std::size_t>(b)];
      });
    }
  }

  /// Columns of the best set without column `banned` (-1: none banned) that costs less than
  /// `limit`; empty when there is none, or none was found in `steps`.
  std::vector<int> Solve(int banned, double limit, int steps) {
    banned_ = banned;
    best_cost_ = limit;
    best_.clear();
    chosen_.clear();
    steps_left_ = steps;
    std::fill(covered_.begin(), covered_.end(), 0);
    double bound = 0.0;
    for (const double u : dual_) bound += u;
    Search(0, bound);
    return best_;
  }

  double best_cost() const { return best_cost_; }

 private:
  static std::size_t Row(int end) { return static_cast<std::size_t>(end / 2); }

  static double Reduced(const Chain& chain, const std::vector<double>& dual) {
    double out = chain.cost;
    for (const int e : chain.ends) out -= dual[Row(e)];
    return out;
  }

  /// Values of the rows whose sum over no column exceeds that column's cost: their sum over the
  /// rows that are still open is a lower bound (Held and Karp's subgradient ascent, then repaired).
  void FindDuals() {
    // From the even share of the cheapest column on.
    std::fill(dual_.begin(), dual_.end(), kInfinity);
    for (const Chain& chain : chains_) {
      for (const int e : chain.ends) {
        dual_[Row(e)] =
            std::min(dual_[Row(e)], chain.cost / static_cast<double>(chain.ends.size()));
      }
    }
    std::vector<double> best = dual_;
    double best_bound = Repaired(best);
    std::vector<double> excess(dual_.size());
    double step = 1.0;
    for (int i = 0; i < kAscents; ++i, step *= 0.97) {
      // Columns that would be taken at these values cover rows too often, others not at all.
      std::fill(excess.begin(), excess.end(), 1.0);
      double norm = 0.0;
      for (const Chain& chain : chains_) {
        if (Reduced(chain, dual_) >= 0.0) continue;
        for (const int e : chain.ends) excess[Row(e)] -= 1.0;
      }
      for (const double x : excess) norm += x * x;
      if (norm == 0.0) break;
      const double length = 2.0 * step / std::sqrt(norm);
      for (std::size_t f = 0; f < dual_.size(); ++f) dual_[f] += length * excess[f];
      if (i % 4 != 3) continue;
      std::vector<double> tried = dual_;
      const double bound = Repaired(tried);
      if (bound > best_bound) {
        best_bound = bound;
        best = std::move(tried);
      }
    }
    dual_ = std::move(best);
  }

  /// Lowers the values until no column's sum exceeds its cost, then raises each as far as it goes.
  /// Returns their sum.
  double Repaired(std::vector<double>& dual) const {
    std::vector<double> slack(chains_.size());
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      const Chain& chain = chains_[c];
      const double reduced = Reduced(chain, dual);
      if (reduced >= 0.0) continue;
      const double share = reduced / static_cast<double>(chain.ends.size());
      for (const int e : chain.ends) dual[Row(e)] += share;
    }
    for (std::size_t c = 0; c < chains_.size(); ++c) slack[c] = Reduced(chains_[c], dual);
    double sum = 0.0;
    for (std::size_t f = 0; f < dual.size(); ++f) {
      double min_slack = kInfinity;
      for (const int c : of_row_[f])
        min_slack = std::min(min_slack, slack[static_cast<std::size_t>(c)]);
      dual[f] += min_slack;
      for (const int c : of_row_[f]) slack[static_cast<std::size_t>(c)] -= min_slack;
      sum += dual[f];
    }
    return sum;
  }

  bool Fits(const Chain& chain) const {
    return std::none_of(chain.ends.begin(), chain.ends.end(),
                        [this](int e) { return covered_[Row(e)] != 0; });
  }

  void Search(double excess, double bound) {
    if (bound + excess >= best_cost_ - 1e-9 || --steps_left_ < 0) return;
    // The open row with the fewest columns that can still be part of a better set.
    const double left = best_cost_ - bound - excess;
    std::size_t open = covered_.size(), fewest = chains_.size() + 1;
    for (std::size_t f = 0; f < covered_.size() && fewest > 1; ++f) {
      if (covered_[f] != 0) continue;
      std::size_t count = 0;
      for (const int c : of_row_[f]) {
        if (reduced_[static_cast<std::size_t>(c)] >= left || count >= fewest) break;
        count += Fits(chains_[static_cast<std::size_t>(c)]);
      }
      if (count < fewest) {
        fewest = count;
        open = f;
      }
    }
    if (open == covered_.size()) {
      best_cost_ = bound + excess;
      best_ = chosen_;
      return;
    }
    for (const int c : of_row_[open]) {
      const double more = reduced_[static_cast<std::size_t>(c)];
      if (bound + excess + more >= best_cost_ - 1e-9) return;
      const Chain& chain = chains_[static_cast<std::size_t>(c)];
      if (c == banned_ || !Fits(chain)) continue;
      for (const int e : chain.ends) covered_[Row(e)] = 1;
      chosen_.push_back(c);
      Search(excess + more, bound);
      chosen_.pop_back();
      for (const int e : chain.ends) covered_[Row(e)] = 0;
    }
  }

  const std::vector<Chain>& chains_;
  std::vector<std::vector<int>> of_row_;  ///< Columns of a row, ascending in reduced cost.
  std::vector<double> dual_, reduced_;
  std::vector<char> covered_;
  std::vector<int> chosen_, best_;
  int banned_ = -1;
  double best_cost_ = kInfinity;
  int steps_left_ = 0;
};

}  // namespace

std::vector<Chain> JoinFragments(const std::vector<Fragment>& fragments,
                                 const std::vector<Bridge>& bridges,
                                 const std::vector<double>& max_extensions_m,
                                 double tube_length_m) {
  const std::vector<Chain> chains = FindChains(fragments, bridges, max_extensions_m, tube_length_m);
  SetPartition partition(chains, fragments.size());
  const std::vector<int> best = partition.Solve(-1, kInfinity, kMaxSteps);
  const double cost = partition.best_cost();
  std::vector<Chain> out;
  for (const int c : best) {
    out.push_back(chains[static_cast<std::size_t>(c)]);
    partition.Solve(c, cost + kMaxMargin, kRunnerUpSteps);
    out.back().margin = partition.best_cost() - cost;
  }
  return out;
}

}  // namespace tubetwin

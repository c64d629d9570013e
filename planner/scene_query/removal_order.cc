#include "planner/scene_query/removal_order.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace tubetwin {
namespace {

/// over[i]: indices of the tubes that lie over tube i, each once.
using Covers = std::vector<std::vector<int>>;

int CountBlockers(const Covers& over, int tube) {
  std::vector<char> seen(over.size(), 0);
  std::vector<int> open = {tube};
  seen[tube] = 1;
  int count = 0;
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    for (const int next : over[at]) {
      if (seen[next]) continue;
      seen[next] = 1;
      ++count;
      open.push_back(next);
    }
  }
  return count;
}

/// How many tubes come free one after the other when `gone` (or none: -1) is taken out first; it is
/// not counted.
int CountFreed(const Covers& over, int gone) {
  std::vector<char> taken(over.size(), 0);
  if (gone >= 0) taken[gone] = 1;
  int count = 0;
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < over.size(); ++i) {
      if (taken[i]) continue;
      if (!std::all_of(over[i].begin(), over[i].end(), [&](int k) { return taken[k] != 0; })) {
        continue;
      }
      taken[i] = 1;
      ++count;
      more = true;
    }
  }
  return count;
}

}  // namespace

std::vector<RemovalRank> RemovalOrder(const TubeScene& scene) {
  const int count = static_cast<int>(scene.tubes.size());
  std::map<int, int> index;
  for (int i = 0; i < count; ++i) index[scene.tubes[i].id] = i;
  Covers over(count);
  std::vector<RemovalRank> ranks(count);
  for (const Crossing& crossing : scene.crossings) {
    const auto upper = index.find(crossing.over), lower = index.find(crossing.under);
    if (upper == index.end() || lower == index.end()) continue;
    ++ranks[lower->second].covers;
    std::vector<int>& list = over[lower->second];
    if (std::find(list.begin(), list.end(), upper->second) == list.end()) {
      list.push_back(upper->second);
    }
  }
  const int freed = CountFreed(over, -1);
  for (int i = 0; i < count; ++i) {
    ranks[i].tube = scene.tubes[i].id;
    ranks[i].blockers = CountBlockers(over, i);
    // A tube that comes free by itself sets free what it would have anyway.
    ranks[i].released = std::max(0, CountFreed(over, i) - freed);
  }
  std::stable_sort(ranks.begin(), ranks.end(), [](const RemovalRank& a, const RemovalRank& b) {
    return std::tuple(a.covers, a.blockers, -a.released) <
           std::tuple(b.covers, b.blockers, -b.released);
  });
  return ranks;
}

}  // namespace tubetwin

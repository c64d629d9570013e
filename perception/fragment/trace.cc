#include "perception/fragment/trace.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace tubetwin {
namespace {

/// Voxels further than this from the traced curve belong to another piece.
constexpr double kOffCurve_m = 0.006;
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Voxels of one piece, ascending, with their neighbours by local number.
struct Graph {
  std::vector<int> voxels;
  std::vector<std::vector<int>> neighbours;
};

Graph MakeGraph(const AxisSpace& space, const std::vector<int>& voxels) {
  Graph graph{voxels, std::vector<std::vector<int>>(voxels.size())};
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const AxisVoxel& v = space.voxels[static_cast<std::size_t>(voxels[i])];
    space.grid.ForNeighbours(v.cell, 1, [&](int k) {
      if (k == voxels[i]) return;
      const auto found = std::lower_bound(voxels.begin(), voxels.end(), k);
      if (found != voxels.end() && *found == k) {
        graph.neighbours[i].push_back(static_cast<int>(found - voxels.begin()));
      }
    });
  }
  return graph;
}

/// Distance along the graph from `start` to every voxel (Dijkstra).
std::vector<double> DistancesFrom(const AxisSpace& space, const Graph& graph, int start) {
  std::vector<double> distance(graph.voxels.size(), kFar);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance[static_cast<std::size_t>(start)] = 0.0;
  queue.push({0.0, start});
  auto mean = [&](int i) -> const Eigen::Vector3f& {
    return space.voxels[static_cast<std::size_t>(graph.voxels[static_cast<std::size_t>(i)])].mean_N;
  };
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > distance[static_cast<std::size_t>(i)]) continue;
    for (const int k : graph.neighbours[static_cast<std::size_t>(i)]) {
      const double through = d + (mean(k) - mean(i)).norm();
      if (through >= distance[static_cast<std::size_t>(k)]) continue;
      distance[static_cast<std::size_t>(k)] = through;
      queue.push({through, k});
    }
  }
  return distance;
}

int Farthest(const std::vector<double>& distance) {
  int best = 0;
  for (std::size_t i = 1; i < distance.size(); ++i) {
    if (distance[i] < kFar && distance[i] > distance[static_cast<std::size_t>(best)]) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

/// Weighted means of the voxels in successive slices of `step_m` along the way back from the
/// farthest voxel: a voxel off the shortest way stands at its own distance.
Polyline SliceMeans(const AxisSpace& space, const Graph& graph, const std::vector<double>& distance,
                    const std::vector<char>& on_path, double step_m) {
  double longest = 0.0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (on_path[i]) longest = std::max(longest, distance[i]);
  }
  const int slices = std::max(2, static_cast<int>(longest / step_m + 0.5));
  std::vector<Vector3> sum(static_cast<std::size_t>(slices), Vector3::Zero());
  std::vector<double> weight(sum.size(), 0.0);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (!on_path[i]) continue;
    const AxisVoxel& v = space.voxels[static_cast<std::size_t>(graph.voxels[i])];
    const int k = std::clamp(static_cast<int>(distance[i] / longest * slices), 0, slices - 1);
    sum[static_cast<std::size_t>(k)] += v.weight * v.mean_N.cast<double>();
    weight[static_cast<std::size_t>(k)] += v.weight;
  }
  Polyline line;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    if (weight[k] > 0.0) line.push_back(sum[k] / weight[k]);
  }
  return line;
}

/// Voxels within kOffCurve_m of the shortest way between the two ends.
std::vector<char> NearShortestWay(const AxisSpace& space, const Graph& graph,
                                  const std::vector<double>& from_start,
                                  const std::vector<double>& from_end, double length) {
  std::vector<char> near(graph.voxels.size(), 0);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (from_start[i] + from_end[i] <= length + 1e-9) order.push_back({from_start[i], i});
  }
  std::sort(order.begin(), order.end());
  auto mean = [&](std::size_t i) -> const Eigen::Vector3f& {
    return space.voxels[static_cast<std::size_t>(graph.voxels[i])].mean_N;
  };
  // A place of the way that is near has about the voxel's own distance from the start.
  constexpr double kWindow_m = 3.0 * kOffCurve_m;
  constexpr float kNear2 = static_cast<float>(kOffCurve_m * kOffCurve_m);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Eigen::Vector3f& p = mean(i);
    auto it = std::lower_bound(order.begin(), order.end(),
                               std::pair{from_start[i] - kWindow_m, std::size_t{0}});
    for (; it != order.end() && it->first <= from_start[i] + kWindow_m; ++it) {
      const Eigen::Vector3f& a = mean(it->second);
      const Eigen::Vector3f d = it + 1 != order.end() ? Eigen::Vector3f(mean((it + 1)->second) - a)
                                                      : Eigen::Vector3f::Zero();
      const float u = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-12f), 0.0f, 1.0f);
      near[i] = (p - a - u * d).squaredNorm() < kNear2;
      if (near[i] != 0) break;
    }
  }
  return near;
}

}  // namespace

std::vector<Trace> TraceComponent(const AxisSpace& space, const std::vector<int>& component,
                                  double step_m, double shortest_m) {
  std::vector<Trace> out;
  std::vector<int> left = component;
  while (left.size() >= 3) {
    const Graph graph = MakeGraph(space, left);
    const int start = Farthest(DistancesFrom(space, graph, 0));
    const std::vector<double> from_start = DistancesFrom(space, graph, start);
    const int end = Farthest(from_start);
    const double length = from_start[static_cast<std::size_t>(end)];
    std::vector<int> rest;
    if (length < shortest_m) {
      // What is connected to this stub is dropped with it.
      for (std::size_t i = 0; i < left.size(); ++i) {
        if (!(from_start[i] < kFar)) rest.push_back(left[i]);
      }
      left.swap(rest);
      continue;
    }
    const std::vector<double> from_end = DistancesFrom(space, graph, end);
    const std::vector<char> near = NearShortestWay(space, graph, from_start, from_end, length);
    Trace trace;
    trace.line_N = SliceMeans(space, graph, from_start, near, step_m);
    for (std::size_t i = 0; i < left.size(); ++i)
      (near[i] ? trace.voxels : rest).push_back(left[i]);
    if (trace.line_N.size() >= 2) out.push_back(std::move(trace));
    left.swap(rest);
  }
  return out;
}

}  // namespace tubetwin

#include "scenes/pile_text.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>

#include "scenes/text_lines.h"

namespace tubetwin {
namespace {

constexpr int kMaxTubes = 1000, kMaxNodes = 10000;

std::vector<std::string_view> SplitLine(const TextLines& lines, std::size_t count,
                                        const std::string& what) {
  std::vector<std::string_view> fields;
  std::string_view rest = lines.line();
  while (true) {
    const std::size_t begin = rest.find_first_not_of(" \t");
    if (begin == std::string_view::npos) break;
    rest = rest.substr(begin);
    const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
    fields.push_back(rest.substr(0, end));
    rest = rest.substr(end);
  }
  if (fields.size() != count) {
    lines.Fail("has " + std::to_string(fields.size()) +
               " fields; allowed: " + std::to_string(count) + " (" + what + ")");
  }
  return fields;
}

struct Node {
  Vector3 p_N;
  double radius_m;
};
struct Edge {
  int from, to, order;
};

Node ReadNode(TextLines& lines, int& id) {
  lines.Need("a node");
  const auto fields = SplitLine(lines, 5, "id x y z radius");
  id = lines.AsInteger(fields[0], "node id", 0, std::numeric_limits<int>::max());
  Node node;
  const char* const names[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    node.p_N[k] = lines.AsNumber(fields[static_cast<std::size_t>(k) + 1], names[k]);
  }
  node.radius_m = lines.AsNumber(fields[4], "radius");
  return node;
}

Edge ReadEdge(TextLines& lines, const std::map<int, Node>& nodes) {
  lines.Need("an edge");
  const auto fields = SplitLine(lines, 13, "name n1 n2 order radius cx cy cz qw qx qy qz length");
  Edge edge;
  const int max = std::numeric_limits<int>::max();
  edge.from = lines.AsInteger(fields[1], "n1", 0, max);
  edge.to = lines.AsInteger(fields[2], "n2", 0, max);
  edge.order = lines.AsInteger(fields[3], "order", 0, max);
  for (std::size_t i = 4; i < 13; ++i) lines.AsNumber(fields[i], "edge field");
  for (const int end : {edge.from, edge.to}) {
    if (!nodes.contains(end))
      lines.Fail("edge ends at node " + std::to_string(end) + ", which the tube lacks");
  }
  return edge;
}

TextTube ReadTube(TextLines& lines) {
  lines.Need("a tube's `id nodes edges`");
  const auto head = SplitLine(lines, 3, "tube id, number of nodes, number of edges");
  TextTube tube;
  tube.id = lines.AsInteger(head[0], "tube id", 0, std::numeric_limits<int>::max());
  const int num_nodes = lines.AsInteger(head[1], "number of nodes", 2, kMaxNodes);
  const int num_edges = lines.AsInteger(head[2], "number of edges", 1, kMaxNodes);
  std::map<int, Node> nodes;
  for (int i = 0; i < num_nodes; ++i) {
    int id = 0;
    const Node node = ReadNode(lines, id);
    if (!nodes.emplace(id, node).second) lines.Fail("node " + std::to_string(id) + " comes twice");
  }
  std::vector<Edge> edges;
  for (int i = 0; i < num_edges; ++i) edges.push_back(ReadEdge(lines, nodes));
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.order < b.order; });
  const auto add = [&](int id) {
    tube.centerline_N.push_back(nodes.at(id).p_N);
    tube.radius_m = nodes.at(id).radius_m;
  };
  add(edges.front().from);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool goes_on = i == 0 || edges[i].from == edges[i - 1].to;
    if (!goes_on || (i > 0 && edges[i].order == edges[i - 1].order)) {
      lines.Fail("tube " + std::to_string(tube.id) +
                 " is no chain: its edges, by order, must each begin where the one before ends "
                 "(branching tubes are not supported)");
    }
    add(edges[i].to);
  }
  return tube;
}

}  // namespace

std::vector<TextTube> ParsePileConfiguration(const std::string& text, const std::string& source,
                                             std::optional<double> unit_m) {
  TextLines lines(text, source);
  lines.Need("the number of tubes");
  const auto head = SplitLine(lines, 1, "number of tubes");
  const int count = lines.AsInteger(head[0], "number of tubes", 0, kMaxTubes);
  std::vector<TextTube> tubes;
  for (int i = 0; i < count; ++i) {
    tubes.push_back(ReadTube(lines));
    for (Vector3& p : tubes.back().centerline_N) p *= unit_m.value_or(1.0);
    tubes.back().radius_m *= unit_m.value_or(1.0);
  }
  if (lines.Next()) lines.Fail("goes on after the last of " + std::to_string(count) + " tubes");
  return tubes;
}

}  // namespace tubetwin

#include "scenes/pile_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr const char kHeader[] = "tube,index,x,y,z";
constexpr int kMaxTubes = 1000, kMaxNodes = 10000;

// Lines of a text with their numbers, for errors.
class Lines {
 public:
  Lines(const std::string& text, const std::string& source) : rest_(text), source_(source) {}

  // Next line that is not blank; false at the end.
  bool Next() {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
      ++number_;
      while (!line_.empty() && std::isspace(static_cast<unsigned char>(line_.back()))) {
        line_.remove_suffix(1);
      }
      if (!line_.empty()) return true;
    }
    return false;
  }
  void Need(const std::string& what) {
    if (!Next()) {
      throw Error(ErrorKind::kBadData, source_ + ": line " + std::to_string(number_) +
                                           ": the file ends where " + what + " is needed");
    }
  }
  std::string_view line() const { return line_; }

  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorKind::kBadData,
                source_ + ": line " + std::to_string(number_) + ": " + problem);
  }

  std::vector<std::string_view> Split(const char* separators, std::size_t count,
                                      const std::string& what) const {
    std::vector<std::string_view> fields;
    std::string_view rest = line_;
    const bool blanks = separators[0] == ' ';
    while (true) {
      const std::size_t end = rest.find_first_of(separators);
      const std::string_view field = rest.substr(0, end);
      if (!(blanks && field.empty())) fields.push_back(field);
      if (end == std::string_view::npos) break;
      rest = rest.substr(end + 1);
    }
    if (fields.size() != count) {
      Fail("has " + std::to_string(fields.size()) + " fields; allowed: " + std::to_string(count) +
           " (" + what + ")");
    }
    return fields;
  }

  double AsNumber(std::string_view field, const char* name) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
      Fail(std::string(name) + " is '" + std::string(field.substr(0, 40)) +
           "'; allowed: a finite number");
    }
    return value;
  }

  int AsInteger(std::string_view field, const char* name, int low, int high) const {
    int value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || value < low || value > high) {
      Fail(std::string(name) + " is '" + std::string(field.substr(0, 40)) +
           "'; allowed: a whole number from " + std::to_string(low) + " to " +
           std::to_string(high));
    }
    return value;
  }

 private:
  std::string_view rest_;
  std::string source_;
  std::string_view line_;
  int number_ = 0;
};

struct Node {
  Vector3 p_N;
  double radius_m;
};
struct Edge {
  int from, to, order;
};

Node ReadNode(Lines& lines, int& id) {
  lines.Need("a node");
  const auto fields = lines.Split(" \t", 5, "id x y z radius");
  id = lines.AsInteger(fields[0], "node id", 0, std::numeric_limits<int>::max());
  Node node;
  const char* const names[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    node.p_N[k] = lines.AsNumber(fields[static_cast<std::size_t>(k) + 1], names[k]);
  }
  node.radius_m = lines.AsNumber(fields[4], "radius");
  return node;
}

Edge ReadEdge(Lines& lines, const std::map<int, Node>& nodes) {
  lines.Need("an edge");
  const auto fields = lines.Split(" \t", 13, "name n1 n2 order radius cx cy cz qw qx qy qz length");
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

TextTube ReadTube(Lines& lines) {
  lines.Need("a tube's `id nodes edges`");
  const auto head = lines.Split(" \t", 3, "tube id, number of nodes, number of edges");
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

std::vector<TextTube> ParsePileCsv(const std::string& text, const std::string& source) {
  Lines lines(text, source);
  lines.Need(std::string("the header ") + kHeader);
  if (lines.line() != kHeader) {
    lines.Fail("header is '" + std::string(lines.line().substr(0, 60)) + "'; allowed: " + kHeader);
  }
  std::vector<TextTube> tubes;
  while (lines.Next()) {
    const auto fields = lines.Split(",", 5, kHeader);
    const int id = lines.AsInteger(fields[0], "tube", 0, std::numeric_limits<int>::max());
    if (tubes.empty() || tubes.back().id != id) {
      const bool seen = std::any_of(tubes.begin(), tubes.end(),
                                    [id](const TextTube& tube) { return tube.id == id; });
      if (seen) lines.Fail("tube " + std::to_string(id) + " comes again after another tube");
      if (tubes.size() >= kMaxTubes) lines.Fail("more than 1000 tubes");
      tubes.push_back({id, {}, 0.0});
    }
    Polyline& line = tubes.back().centerline_N;
    const int expected = static_cast<int>(line.size());
    lines.AsInteger(fields[1], "index", expected, std::min(expected, kMaxNodes));
    line.push_back({lines.AsNumber(fields[2], "x"), lines.AsNumber(fields[3], "y"),
                    lines.AsNumber(fields[4], "z")});
  }
  return tubes;
}

std::vector<TextTube> ParsePileConfiguration(const std::string& text, const std::string& source) {
  Lines lines(text, source);
  lines.Need("the number of tubes");
  const auto head = lines.Split(" \t", 1, "number of tubes");
  const int count = lines.AsInteger(head[0], "number of tubes", 0, kMaxTubes);
  std::vector<TextTube> tubes;
  for (int i = 0; i < count; ++i) tubes.push_back(ReadTube(lines));
  if (lines.Next()) lines.Fail("goes on after the last of " + std::to_string(count) + " tubes");
  return tubes;
}

}  // namespace tubetwin

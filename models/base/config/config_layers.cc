#include "models/base/config/config_layers.h"

#include <algorithm>
#include <sstream>

#define TOML_ENABLE_FORMATTERS 0
// The parser asserts what a misprint may break ("[=a]"), and then refuses the same with a place and
// a reason: a file must not end the program.
#define TOML_ASSERT(expr) static_cast<void>(0)
#include <toml++/toml.h>

#include "models/base/config/nesting.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"

namespace tubetwin::config_internal {
namespace {

std::string Place(const std::string& file, const toml::source_region& region) {
  return file + ":" + std::to_string(region.begin.line) + ":" + std::to_string(region.begin.column);
}

constexpr std::size_t kShown = 40;        // Errors stay one line even for a pasted file.
constexpr std::size_t kShownPlace = 200;  // Long enough for a path.

std::string Shown(const std::string& text) {
  return Printable(text.substr(0, kShownPlace)) + (text.size() > kShownPlace ? "..." : "");
}

Node FromToml(const toml::node& in, const std::string& file);

Node::Table TableFromToml(const toml::table& in, const std::string& file) {
  Node::Table out;
  for (const auto& [key, value] : in) {
    Node node = FromToml(value, file);
    node.key_place = Place(file, key.source());
    out.push_back({std::string(key.str()), std::move(node)});
  }
  return out;
}

Node FromToml(const toml::node& in, const std::string& file) {
  Node out;
  out.place = out.key_place = Place(file, in.source());
  if (const auto* flag = in.as_boolean()) {
    out.value = flag->get();
  } else if (const auto* integer = in.as_integer()) {
    out.value = integer->get();
  } else if (const auto* real = in.as_floating_point()) {
    out.value = real->get();
  } else if (const auto* text = in.as_string()) {
    out.value = text->get();
  } else if (const auto* list = in.as_array()) {
    std::vector<Node> items;
    for (const toml::node& item : *list) items.push_back(FromToml(item, file));
    out.value = std::move(items);
  } else if (const auto* table = in.as_table()) {
    out.value = TableFromToml(*table, file);
  } else {
    out.value = Node::Unsupported{"a date or time"};
  }
  return out;
}

std::string TooDeep(const std::string& place) {
  return place + ": lists, tables or the parts of a key nest more than " +
         std::to_string(kDeepestNesting) + " deep; allowed: up to that";
}

/// "NAME:LINE:COLUMN" of a byte, the column in characters from 1.
std::string PlaceOfByte(const std::string& name, std::string_view toml, std::size_t at) {
  const std::string_view before = toml.substr(0, at);
  const std::size_t end = before.rfind('\n');
  const std::string_view line = end == std::string_view::npos ? before : before.substr(end + 1);
  const auto column = std::count_if(line.begin(), line.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  });
  return name + ":" + std::to_string(1 + std::count(before.begin(), before.end(), '\n')) + ":" +
         std::to_string(1 + column);
}

void RequireParsable(const std::string& toml, const std::string& name) {
  if (const auto line = LineOfDeepNesting(toml)) {
    throw Error(ErrorKind::kConfig, TooDeep(name + ":" + std::to_string(*line)));
  }
  if (const auto at = FindBareNonAscii(toml)) {
    std::size_t size = 1;
    while (*at + size < toml.size() &&
           (static_cast<unsigned char>(toml[*at + size]) & 0xC0) == 0x80)
      ++size;
    throw Error(ErrorKind::kConfig, PlaceOfByte(name, toml, *at) + ": not valid TOML: '" +
                                        Printable(toml.substr(*at, size)) +
                                        "' stands outside quotes and comments; keys are letters a "
                                        "to z, digits, _ and -, anything else stands in quotes");
  }
}

/// The value of an override: TOML if it is one value, else the text as typed: a path or a name, the
/// usual case on a command line.
Node OverrideValue(const std::string& raw, const std::string& place) {
  if (LineOfDeepNesting(raw)) throw Error(ErrorKind::kConfig, TooDeep(place));
  Node node;
  node.value = raw;
  if (FindBareNonAscii(raw)) return node;
  try {
    const toml::table parsed = toml::parse("v = " + raw);
    if (parsed.size() == 1) {
      Node value = FromToml(*parsed.get("v"), "");
      if (!std::holds_alternative<Node::Unsupported>(value.value)) return value;
    }
  } catch (const toml::parse_error&) {
    // No TOML, but a text.
  }
  return node;
}

void SetPlace(Node& node, const std::string& place) {
  node.place = node.key_place = place;
  if (auto* items = std::get_if<std::vector<Node>>(&node.value)) {
    for (Node& item : *items) SetPlace(item, place);
  } else if (auto* table = std::get_if<Node::Table>(&node.value)) {
    for (auto& [key, below] : *table) SetPlace(below, place);
  }
}

void SetFolder(Node& node, const std::string& folder) {
  node.folder = folder;
  if (auto* items = std::get_if<std::vector<Node>>(&node.value)) {
    for (Node& item : *items) SetFolder(item, folder);
  } else if (auto* table = std::get_if<Node::Table>(&node.value)) {
    for (auto& [key, below] : *table) SetFolder(below, folder);
  }
}

}  // namespace

const Node* Find(const Node::Table& table, const std::string& key) {
  for (const auto& [name, node] : table) {
    if (name == key) return &node;
  }
  return nullptr;
}

void Merge(Node::Table& below, Node::Table top) {
  if (below.empty()) {
    below = std::move(top);
    return;
  }
  for (auto& [key, node] : top) {
    Node* old = const_cast<Node*>(Find(below, key));
    if (old == nullptr) {
      below.push_back({key, std::move(node)});
    } else if (auto* table = std::get_if<Node::Table>(&node.value);
               table != nullptr && std::holds_alternative<Node::Table>(old->value)) {
      Merge(std::get<Node::Table>(old->value), std::move(*table));
    } else {
      *old = std::move(node);
    }
  }
}

Node::Table ParseLayer(const std::string& toml, const std::string& name,
                       const std::string& folder) {
  RequireParsable(toml, name);
  try {
    Node::Table table = TableFromToml(toml::parse(toml, name), name);
    for (auto& [key, node] : table) SetFolder(node, folder);
    return table;
  } catch (const toml::parse_error& e) {
    throw Error(ErrorKind::kConfig,
                Place(name, e.source()) + ": not valid TOML: " + Printable(e.description()));
  }
}

Node::Table ParseOverride(const std::string& text) {
  const std::string place = "--set " + Shown(text);
  const std::size_t equals = text.find('=');
  const auto trim = [](const std::string& s) {
    const std::size_t first = s.find_first_not_of(" \t");
    return first == std::string::npos ? "" : s.substr(first, s.find_last_not_of(" \t") - first + 1);
  };
  const std::string path = trim(text.substr(0, equals));
  std::vector<std::string> keys;
  std::istringstream parts(path + ".");
  bool good = equals != std::string::npos;
  for (std::string key; std::getline(parts, key, '.');) {
    good = good && IsBareKey(key);
    keys.push_back(key);
  }
  if (!good) {
    throw Error(ErrorKind::kUsage, place +
                                       ": an override is written KEY=VALUE, for example "
                                       "planner.exclude_free=true");
  }
  if (keys.size() > static_cast<std::size_t>(kDeepestNesting)) {
    throw Error(ErrorKind::kConfig, TooDeep(place));
  }
  Node node = OverrideValue(trim(text.substr(equals + 1)), place);
  SetPlace(node, place);
  node.raw = trim(text.substr(equals + 1));
  node.from_override = true;
  for (std::size_t i = keys.size(); i-- > 1;) {
    Node table;
    Node::Table one;
    one.push_back({keys[i], std::move(node)});
    table.value = std::move(one);
    table.place = table.key_place = place;
    node = std::move(table);
  }
  Node::Table layer;
  layer.push_back({keys.front(), std::move(node)});
  return layer;
}

std::string Quoted(const std::string& text) {
  std::string shown =
      Json(text.substr(0, kShown)).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > kShown) shown += "...";
  return shown;
}

/// What a person would say is there, for messages.
std::string Describe(const Node& node) {
  struct Visitor {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return std::to_string(v); }
    std::string operator()(double v) const { return "the real number " + Number(v); }
    std::string operator()(const std::string& v) const { return "the text " + Quoted(v); }
    std::string operator()(const std::vector<Node>& v) const {
      return "a list of " + std::to_string(v.size());
    }
    std::string operator()(const Node::Table&) const { return "a table"; }
    std::string operator()(const Node::Unsupported& v) const { return v.what; }
  };
  return std::visit(Visitor{}, node.value);
}

bool IsBareKey(const std::string& key) {
  return !key.empty() && key.find_first_not_of(
                             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                             "0123456789_-") == std::string::npos;
}

}  // namespace tubetwin::config_internal

// Lists of tables, tables as sources of their own, and the grids that lists of values span.

#include <algorithm>
#include <sstream>
#include <utility>

#include "models/base/config/config.h"
#include "models/base/config/config_entries.h"
#include "models/base/config/config_layers.h"
#include "models/base/config/nesting.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using config_internal::Below;
using config_internal::Describe;
using config_internal::DescribeFields;
using config_internal::Entry;
using config_internal::Find;
using config_internal::IsBareKey;
using config_internal::kDeepestNesting;
using config_internal::Merge;
using config_internal::Node;

constexpr std::size_t kMostExpanded = 1000;  // Variants of a grid.

[[noreturn]] void Fail(const Node& node, const std::string& path, const std::string& problem) {
  throw Error(ErrorKind::kConfig, node.key_place + ": " + path + ": " + problem);
}

std::vector<std::string> SplitAtDots(const std::string& path) {
  std::vector<std::string> keys;
  std::istringstream parts(path);
  for (std::string key; std::getline(parts, key, '.');) keys.push_back(key);
  return keys;
}

/// `node` below tables named by `keys`.
Node::Table Wrapped(const std::vector<std::string>& keys, Node node) {
  for (std::size_t i = keys.size(); i-- > 1;) {
    Node table;
    table.place = node.place;
    table.key_place = node.key_place;
    Node::Table one;
    one.push_back({keys[i], std::move(node)});
    table.value = std::move(one);
    node = std::move(table);
  }
  Node::Table out;
  out.push_back({keys.front(), std::move(node)});
  return out;
}

/// Takes a member out of a table.
Node Take(Node::Table& table, const std::string& key) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Node::Member& member) { return member.key == key; });
  TT_CHECK(found != table.end());
  Node node = std::move(found->node);
  table.erase(found);
  return node;
}

/// As a person would write it: texts bare, lists in brackets.
std::string Plain(const Node& node) {
  if (const auto* text = std::get_if<std::string>(&node.value)) return *text;
  if (const auto* real = std::get_if<double>(&node.value)) return Number(*real);
  if (const auto* list = std::get_if<std::vector<Node>>(&node.value)) {
    std::vector<std::string> items;
    for (const Node& item : *list) items.push_back(Plain(item));
    return "[" + Join(items) + "]";
  }
  return Describe(node);
}

void AddTexts(const Node::Table& table, const std::string& path,
              std::vector<std::pair<std::string, std::string>>& texts) {
  for (const auto& [key, node] : table) {
    if (const auto* below = std::get_if<Node::Table>(&node.value)) {
      AddTexts(*below, Below(path, key), texts);
    } else {
      texts.emplace_back(Below(path, key), Plain(node));
    }
  }
}

/// One axis of a grid: the values that a key takes.
struct Axis {
  std::vector<std::string> keys;
  const Node* list = nullptr;
};

void FindAxes(const Node::Table& table, const Entry& section, const std::string& path,
              std::vector<Axis>& axes) {
  for (const Node::Member& member : table) {
    const auto known = std::find_if(section.children.begin(), section.children.end(),
                                    [&](const Entry& entry) { return entry.key == member.key; });
    if (known == section.children.end()) continue;  // The reader will name it.
    const std::string below = Below(path, member.key);
    if (known->type == Entry::Type::kSection) {
      if (const auto* inner = std::get_if<Node::Table>(&member.node.value)) {
        FindAxes(*inner, *known, below, axes);
      }
      continue;
    }
    const auto* list = std::get_if<std::vector<Node>>(&member.node.value);
    if (list == nullptr) continue;
    const bool takes_list =
        known->type == Entry::Type::kNumbers || known->type == Entry::Type::kTexts;
    const bool spans = !takes_list || (!list->empty() &&
                                       std::all_of(list->begin(), list->end(), [](const Node& n) {
                                         return std::holds_alternative<std::vector<Node>>(n.value);
                                       }));
    if (!spans) continue;
    if (list->empty()) Fail(member.node, below, "is an empty list, at least one value is needed");
    axes.push_back({SplitAtDots(below), &member.node});
  }
}

}  // namespace

std::vector<ConfigSource> ConfigSource::TakeTables(const std::string& key) {
  std::vector<ConfigSource> out;
  impl_->taken.push_back(key);
  if (Find(impl_->layers, key) == nullptr) return out;
  Node node = Take(impl_->layers, key);
  auto* list = std::get_if<std::vector<Node>>(&node.value);
  if (list == nullptr) {
    Fail(node, key, "a list of tables [[" + key + "]] is needed, found " + Describe(node));
  }
  for (Node& item : *list) {
    auto* table = std::get_if<Node::Table>(&item.value);
    if (table == nullptr) Fail(item, key, "a table is needed, found " + Describe(item));
    ConfigSource& taken = out.emplace_back();
    taken.impl_->layers = std::move(*table);
    taken.impl_->place = item.place;
  }
  return out;
}

ConfigSource ConfigSource::TakeTable(const std::string& key) {
  ConfigSource out;
  impl_->taken.push_back(key);
  if (Find(impl_->layers, key) == nullptr) return out;
  Node node = Take(impl_->layers, key);
  out.impl_->place = node.place;
  auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr) Fail(node, key, "a table {a.b = value} is needed, found " + Describe(node));
  for (auto& [name, below] : *table) {
    const std::vector<std::string> keys = SplitAtDots(name);
    if (keys.empty() || keys.size() > kDeepestNesting ||
        !std::all_of(keys.begin(), keys.end(), IsBareKey)) {
      Fail(below, key,
           "'" + Printable(name) + "' is no key; keys are written like planner.exclude_free");
    }
    Merge(out.impl_->layers, Wrapped(keys, std::move(below)));
  }
  return out;
}

void ConfigSource::MoveKey(const std::string& key, ConfigSource& to, const std::string& path) {
  if (Find(impl_->layers, key) == nullptr) return;
  Node node = Take(impl_->layers, key);
  const Node::Table* table = &to.impl_->layers;
  const std::vector<std::string> keys = SplitAtDots(path);
  for (std::size_t i = 0; i < keys.size() && table != nullptr; ++i) {
    const Node* there = Find(*table, keys[i]);
    if (there != nullptr && i + 1 == keys.size()) {
      Fail(node, key, "is given twice, also as " + path + " at " + there->key_place);
    }
    table = there == nullptr ? nullptr : std::get_if<Node::Table>(&there->value);
  }
  Merge(to.impl_->layers, Wrapped(keys, std::move(node)));
}

std::vector<ConfigSource> ConfigSource::ExpandLists(
    const std::function<void(ConfigVisitor&)>& visit) const {
  std::vector<Axis> axes;
  FindAxes(impl_->layers, DescribeFields(visit), "", axes);
  std::size_t size = 1;
  for (const Axis& axis : axes) {
    const auto& values = std::get<std::vector<Node>>(axis.list->value);
    size *= std::min(values.size(), kMostExpanded + 1);  // No product of these two overflows.
    if (size <= kMostExpanded) continue;
    Fail(*axis.list, Join(axis.keys, "."),
         "its " + std::to_string(values.size()) + " values make a grid of more than " +
             std::to_string(kMostExpanded) + " variants with the lists before it; allowed: up to " +
             "that");
  }
  std::vector<ConfigSource> out(1);
  out.front().impl_->layers = impl_->layers;
  for (const Axis& axis : axes) {
    std::vector<ConfigSource> longer;
    for (const ConfigSource& before : out) {
      for (const Node& value : std::get<std::vector<Node>>(axis.list->value)) {
        ConfigSource& next = longer.emplace_back();
        next.impl_->layers = before.impl_->layers;
        Node chosen = value;
        chosen.key_place = axis.list->key_place;
        Merge(next.impl_->layers, Wrapped(axis.keys, std::move(chosen)));
      }
    }
    out = std::move(longer);
  }
  return out;
}

std::string ConfigSource::PlaceOf(const std::string& key) const {
  const Node* node = Find(impl_->layers, key);
  return node == nullptr ? "" : node->key_place;
}

const std::string& ConfigSource::place() const { return impl_->place; }

std::vector<std::pair<std::string, std::string>> ConfigSource::Texts() const {
  std::vector<std::pair<std::string, std::string>> out;
  AddTexts(impl_->layers, "", out);
  return out;
}

}  // namespace tubetwin

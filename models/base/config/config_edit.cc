// Changes one value of a TOML text that a person wrote and keeps everything else as it stands.

#include "models/base/config/config_edit.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "models/base/config/config_layers.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using config_internal::Find;
using config_internal::Node;
using config_internal::ParseLayer;

constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

bool SameValue(const Node& a, const Node& b);

bool SameTable(const Node::Table& a, const Node::Table& b) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const Node::Member& member) {
           const Node* other = Find(b, member.key);
           return other != nullptr && SameValue(member.node, *other);
         });
}

bool SameValue(const Node& a, const Node& b) {
  if (a.value.index() != b.value.index()) return false;
  if (const auto* table = std::get_if<Node::Table>(&a.value)) {
    return SameTable(*table, std::get<Node::Table>(b.value));
  }
  if (const auto* items = std::get_if<std::vector<Node>>(&a.value)) {
    const auto& others = std::get<std::vector<Node>>(b.value);
    return std::equal(items->begin(), items->end(), others.begin(), others.end(), SameValue);
  }
  if (const auto* flag = std::get_if<bool>(&a.value)) return *flag == std::get<bool>(b.value);
  if (const auto* whole = std::get_if<std::int64_t>(&a.value)) {
    return *whole == std::get<std::int64_t>(b.value);
  }
  if (const auto* real = std::get_if<double>(&a.value)) {
    const double other = std::get<double>(b.value);
    return *real == other || (*real != *real && other != other);
  }
  if (const auto* text = std::get_if<std::string>(&a.value)) {
    return *text == std::get<std::string>(b.value);
  }
  return true;  // Dates and times, of which only the kind is known.
}

/// Byte of the text at which a node stands. The parser counts lines and characters from 1.
std::size_t ByteOf(const std::string& toml, const std::string& place) {
  const std::size_t before_column = place.rfind(':');
  const std::size_t before_line = place.rfind(':', before_column - 1);
  const long line = std::strtol(place.c_str() + before_line + 1, nullptr, 10);
  const long column = std::strtol(place.c_str() + before_column + 1, nullptr, 10);
  std::size_t at = toml.starts_with(kByteOrderMark) && line == 1 ? 3 : 0;
  for (long i = 1; i < line; ++i) at = toml.find('\n', at) + 1;
  for (long i = 1; i < column && at < toml.size(); ++i) {
    do {
      ++at;
    } while (at < toml.size() && (static_cast<unsigned char>(toml[at]) & 0xC0) == 0x80);
  }
  return at;
}

std::string ListText(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(Number(value));
  return "[" + Join(texts) + "]";
}

/// One byte behind the list that begins at `at`, which holds numbers, blanks and comments.
std::size_t EndOfList(const std::string& toml, std::size_t at) {
  while (at < toml.size() && toml[at] != ']') {
    at = toml[at] == '#' ? std::min(toml.find('\n', at), toml.size()) : at + 1;
  }
  return std::min(at + 1, toml.size());
}

/// The list that is there with other numbers: each where the old one stood, when there are as many.
std::string Replaced(std::string toml, const Node& old, const std::vector<double>& values) {
  const auto& items = std::get<std::vector<Node>>(old.value);
  if (items.size() != values.size()) {
    const std::size_t at = ByteOf(toml, old.place);
    return toml.replace(at, EndOfList(toml, at) - at, ListText(values));
  }
  for (std::size_t i = items.size(); i-- > 0;) {
    const std::size_t at = ByteOf(toml, items[i].place);
    const std::size_t end = std::min(toml.find_first_of(" \t\r\n,]#", at), toml.size());
    toml.replace(at, end - at, Number(values[i]));
  }
  return toml;
}

/// A line without blanks and without a comment behind it.
std::string Bare(std::string line) {
  line = line.substr(0, line.find('#'));
  std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
  return line;
}

/// Texts in which a key that is not there yet may have found its place. Which of them says what it
/// should depends on how the table is written.
std::vector<std::string> Insertions(const std::string& toml, const Node* table,
                                    const TomlNumbers& numbers) {
  const std::string end = toml.find("\r\n") != std::string::npos ? "\r\n" : "\n";
  const std::string line = numbers.key + " = " + ListText(numbers.values);
  std::vector<std::string> out;
  // Behind the table's header.
  for (std::size_t at = 0; at < toml.size();) {
    const std::size_t next = std::min(toml.find('\n', at), toml.size() - 1) + 1;
    if (Bare(toml.substr(at, next - at)) == "[" + numbers.table + "]") {
      const std::string gap = toml[next - 1] == '\n' ? "" : end;
      out.push_back(std::string(toml).insert(next, gap + line + end));
    }
    at = next;
  }
  if (table == nullptr || out.empty()) {
    const std::string gap = toml.empty() || toml.back() == '\n' ? "" : end;
    out.push_back(toml + gap + (toml.empty() ? "" : end) + "[" + numbers.table + "]" + end + line +
                  end);
  }
  if (table == nullptr) return out;
  // Into a table on one line: table = {...}.
  const std::size_t at = ByteOf(toml, table->place);
  if (at < toml.size() && toml[at] == '{') {
    out.push_back(std::string(toml).insert(at + 1, " " + line + ","));
    out.push_back(std::string(toml).insert(at + 1, " " + line + " "));
  }
  // As "table.key", before any header.
  out.push_back(std::string(toml).insert(toml.starts_with(kByteOrderMark) ? 3 : 0,
                                         numbers.table + "." + line + end));
  return out;
}

/// The layer with the list in it, whatever was there.
Node::Table Wanted(Node::Table layer, const TomlNumbers& numbers) {
  Node list;
  std::vector<Node> items;
  for (const double value : numbers.values) {
    items.emplace_back();
    items.back().value = value;
  }
  list.value = std::move(items);
  const auto member = [](Node::Table& in, const std::string& key, Node otherwise) -> Node& {
    for (auto& [name, node] : in) {
      if (name == key) return node;
    }
    in.push_back({key, std::move(otherwise)});
    return in.back().node;
  };
  Node empty;
  empty.value = Node::Table();
  Node& table = member(layer, numbers.table, std::move(empty));
  member(std::get<Node::Table>(table.value), numbers.key, list) = list;
  return layer;
}

/// Whether the text says `wanted`. A whole number is the same number with ".0".
bool Says(const std::string& toml, const std::string& name, const TomlNumbers& numbers,
          const Node::Table& wanted) {
  try {
    Node::Table said = ParseLayer(toml, name);
    const Node* table = Find(said, numbers.table);
    if (table == nullptr || !std::holds_alternative<Node::Table>(table->value)) return false;
    auto* list = const_cast<Node*>(Find(std::get<Node::Table>(table->value), numbers.key));
    if (list == nullptr || !std::holds_alternative<std::vector<Node>>(list->value)) return false;
    for (Node& item : std::get<std::vector<Node>>(list->value)) {
      if (const auto* whole = std::get_if<std::int64_t>(&item.value)) {
        item.value = static_cast<double>(*whole);
      }
    }
    return SameTable(said, wanted);
  } catch (const Error&) {
    return false;  // One of the ways to write it that does not suit this file.
  }
}

[[noreturn]] void RefusePlace(const Node& node, const std::string& path,
                              const std::string& needed) {
  throw Error(ErrorKind::kConfig, node.place + ": " + path + ": is " +
                                      config_internal::Describe(node) + ", " + needed +
                                      " is needed; nothing was written");
}

}  // namespace

std::string WithTomlNumbers(const std::string& toml, const std::string& name,
                            const TomlNumbers& numbers) {
  const Node::Table layer = ParseLayer(toml, name);
  const Node* table = Find(layer, numbers.table);
  if (table != nullptr && !std::holds_alternative<Node::Table>(table->value)) {
    RefusePlace(*table, numbers.table, "a table");
  }
  const Node* old =
      table == nullptr ? nullptr : Find(std::get<Node::Table>(table->value), numbers.key);
  if (old != nullptr && !std::holds_alternative<std::vector<Node>>(old->value)) {
    RefusePlace(*old, numbers.table + "." + numbers.key, "a list of numbers");
  }
  const Node::Table wanted = Wanted(layer, numbers);
  const std::vector<std::string> ways =
      old != nullptr ? std::vector<std::string>{Replaced(toml, *old, numbers.values)}
                     : Insertions(toml, table, numbers);
  for (const std::string& way : ways) {
    if (Says(way, name, numbers, wanted)) return way;
  }
  throw Error(ErrorKind::kConfig,
              name + ": " + numbers.table + "." + numbers.key +
                  ": has no place that this program finds; write it by hand:\n[" + numbers.table +
                  "]\n" + numbers.key + " = " + ListText(numbers.values));
}

}  // namespace tubetwin

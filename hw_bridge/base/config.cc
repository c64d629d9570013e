#include "hw_bridge/base/config.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>
#include <variant>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/files.h"
#include "hw_bridge/base/json.h"
#include "hw_bridge/base/text.h"

// Long file: one translation unit because only it may see toml++, whose header is slow to compile,
// and because reading, writing and the schema share one description of the visited fields.

namespace tubetwin {
namespace {

// ---- The merged layers ------------------------------------------------------------------------

/// One value of a layer with the place it came from. Own type because toml++ forgets the place of
/// a node when it is copied into another table.
struct Node {
  struct Unsupported {
    std::string what;
  };
  using Table = std::vector<std::pair<std::string, Node>>;
  std::variant<bool, std::int64_t, double, std::string, std::vector<Node>, Table, Unsupported>
      value;
  std::string place;      ///< "file:line:column", or "--set a.b=value".
  std::string key_place;  ///< Of the key, where that differs.
  std::string raw;        ///< What a person typed after `--set a.b=`; empty for files.
  bool from_override = false;
};

const Node* Find(const Node::Table& table, const std::string& key) {
  for (const auto& [name, node] : table) {
    if (name == key) return &node;
  }
  return nullptr;
}

Node* Find(Node::Table& table, const std::string& key) {
  return const_cast<Node*>(Find(std::as_const(table), key));
}

/// `top` wins; tables are merged key by key, anything else is replaced whole.
void Merge(Node::Table& below, Node::Table top) {
  for (auto& [key, node] : top) {
    Node* old = Find(below, key);
    if (old == nullptr) {
      below.emplace_back(key, std::move(node));
    } else if (auto* table = std::get_if<Node::Table>(&node.value);
               table != nullptr && std::holds_alternative<Node::Table>(old->value)) {
      Merge(std::get<Node::Table>(old->value), std::move(*table));
    } else {
      *old = std::move(node);
    }
  }
}

std::string Place(const std::string& file, const toml::source_region& region) {
  return file + ":" + std::to_string(region.begin.line) + ":" + std::to_string(region.begin.column);
}

Node FromToml(const toml::node& in, const std::string& file);

Node::Table TableFromToml(const toml::table& in, const std::string& file) {
  Node::Table out;
  for (const auto& [key, value] : in) {
    Node node = FromToml(value, file);
    node.key_place = Place(file, key.source());
    out.emplace_back(std::string(key.str()), std::move(node));
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

toml::table ParseToml(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    throw Error(ErrorKind::kConfig,
                Place(name, e.source()) + ": not valid TOML: " + std::string(e.description()));
  }
}

std::string Quoted(const std::string& text) {
  constexpr std::size_t kShown = 40;  // Errors stay one line even for a pasted file.
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

[[noreturn]] void Fail(const std::string& place, const std::string& path,
                       const std::string& problem) {
  throw Error(ErrorKind::kConfig, place + ": " + path + ": " + problem);
}

// ---- What the visited structs contain ---------------------------------------------------------

/// One key of the visit list with its current value.
struct Entry {
  enum class Type { kBool, kInteger, kNumber, kText, kChoice, kNumbers, kTexts, kSection };
  std::string key;
  std::string doc;
  Type type = Type::kSection;
  Json value;
  Range allowed;
  int count = 0;
  std::vector<std::string> choices;
  std::vector<Entry> children;
};

class Describer : public ConfigVisitor {
 public:
  explicit Describer(Entry& into) : into_(into) {}
  void Field(const char* key, const char* doc, bool& value) override {
    Add(key, doc, Entry::Type::kBool).value = value;
  }
  void Field(const char* key, const char* doc, std::int64_t& value, Range allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kInteger);
    entry.value = value;
    entry.allowed = allowed;
  }
  void Field(const char* key, const char* doc, double& value, Range allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kNumber);
    entry.value = value;
    entry.allowed = allowed;
  }
  void Field(const char* key, const char* doc, std::string& value) override {
    Add(key, doc, Entry::Type::kText).value = value;
  }
  void Choice(const char* key, const char* doc, std::string& value,
              const std::vector<std::string>& allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kChoice);
    entry.value = value;
    entry.choices = allowed;
  }
  void Field(const char* key, const char* doc, std::vector<double>& value, int count,
             Range allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kNumbers);
    entry.value = value;
    entry.count = count;
    entry.allowed = allowed;
  }
  void Field(const char* key, const char* doc, std::vector<std::string>& value) override {
    Add(key, doc, Entry::Type::kTexts).value = value;
  }
  void Section(const char* key, const char* doc,
               const std::function<void(ConfigVisitor&)>& visit) override {
    Entry* section = nullptr;
    for (Entry& child : into_.children) {
      if (child.key == key && child.type == Entry::Type::kSection) section = &child;
    }
    if (section == nullptr) section = &Add(key, doc, Entry::Type::kSection);
    Describer inner(*section);
    visit(inner);
  }

 private:
  Entry& Add(const char* key, const char* doc, Entry::Type type) {
    for (const Entry& child : into_.children) TT_CHECK(child.key != key);  // One key, one meaning.
    Entry& entry = into_.children.emplace_back();
    entry.key = key;
    entry.doc = doc;
    entry.type = type;
    return entry;
  }
  Entry& into_;
};

Entry DescribeFields(const std::function<void(ConfigVisitor&)>& visit) {
  Entry root;
  Describer describer(root);
  visit(describer);
  return root;
}

std::string Below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// Full paths of every entry whose last part is `key`.
void FindKey(const Entry& entry, const std::string& key, const std::string& path,
             std::vector<std::string>& found) {
  for (const Entry& child : entry.children) {
    if (child.key == key) found.push_back(Below(path, child.key));
    FindKey(child, key, Below(path, child.key), found);
  }
}

void CheckKeysKnown(const Node::Table& table, const Entry& entry, const Entry& root,
                    const std::string& path) {
  for (const auto& [key, node] : table) {
    const auto known = std::find_if(entry.children.begin(), entry.children.end(),
                                    [&](const Entry& child) { return child.key == key; });
    if (known == entry.children.end()) {
      std::vector<std::string> elsewhere;
      FindKey(root, key, "", elsewhere);
      std::string hint;
      if (!elsewhere.empty()) {
        hint = "; there is '" + Join(elsewhere, "', '") + "'";
      } else if (!entry.children.empty()) {
        std::vector<std::string> names;
        for (const Entry& child : entry.children) names.push_back(child.key);
        hint = "; the nearest known is '" + Below(path, NearestName(key, names)) + "'";
      }
      Fail(node.key_place, Below(path, key), "unknown key" + hint);
    }
    if (const auto* below = std::get_if<Node::Table>(&node.value);
        below != nullptr && known->type == Entry::Type::kSection) {
      CheckKeysKnown(*below, *known, root, Below(path, key));
    }
  }
}

// ---- Reading ----------------------------------------------------------------------------------

std::string AllowedText(Range allowed) {
  if (std::isinf(allowed.low)) return "at most " + Number(allowed.high);
  if (std::isinf(allowed.high)) return "at least " + Number(allowed.low);
  return Number(allowed.low) + " to " + Number(allowed.high);
}

void CheckRange(const Node& node, const std::string& path, double value, Range allowed,
                const std::string& shown) {
  if (value < allowed.low || value > allowed.high) {
    Fail(node.place, path, "is " + shown + ", allowed is " + AllowedText(allowed));
  }
}

double ReadNumber(const Node& node, const std::string& path, Range allowed) {
  double value = 0.0;
  if (const auto* real = std::get_if<double>(&node.value)) {
    value = *real;
  } else if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
    value = static_cast<double>(*integer);
  } else {
    Fail(node.place, path, "a number is needed, found " + Describe(node));
  }
  if (!std::isfinite(value)) {
    Fail(node.place, path, "a finite number is needed, found " + Number(value));
  }
  CheckRange(node, path, value, allowed, Number(value));
  return value;
}

std::string ReadText(const Node& node, const std::string& path) {
  if (const auto* text = std::get_if<std::string>(&node.value)) return *text;
  if (node.from_override) return node.raw;  // --set part=123: the field decides that it is a text.
  Fail(node.place, path, "a text is needed, found " + Describe(node));
}

const std::vector<Node>& ReadList(const Node& node, const std::string& path,
                                  const std::string& of_what) {
  const auto* list = std::get_if<std::vector<Node>>(&node.value);
  if (list == nullptr) {
    Fail(node.place, path, "a list of " + of_what + " is needed, found " + Describe(node));
  }
  return *list;
}

std::string ItemPath(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

class Reader : public ConfigVisitor {
 public:
  Reader(const Node::Table* table, std::string path) : table_(table), path_(std::move(path)) {}

  void Field(const char* key, const char*, bool& value) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    const auto* flag = std::get_if<bool>(&node->value);
    if (flag == nullptr) {
      Fail(node->place, Path(key), "true or false is needed, found " + Describe(*node));
    }
    value = *flag;
  }
  void Field(const char* key, const char*, std::int64_t& value, Range allowed) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    const auto* integer = std::get_if<std::int64_t>(&node->value);
    if (integer == nullptr) {
      Fail(node->place, Path(key), "a whole number is needed, found " + Describe(*node));
    }
    CheckRange(*node, Path(key), static_cast<double>(*integer), allowed, std::to_string(*integer));
    value = *integer;
  }
  void Field(const char* key, const char*, double& value, Range allowed) override {
    if (const Node* node = Get(key)) value = ReadNumber(*node, Path(key), allowed);
  }
  void Field(const char* key, const char*, std::string& value) override {
    if (const Node* node = Get(key)) value = ReadText(*node, Path(key));
  }
  void Choice(const char* key, const char*, std::string& value,
              const std::vector<std::string>& allowed) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    const std::string text = ReadText(*node, Path(key));
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      Fail(node->place, Path(key),
           "is " + Quoted(text) + ", allowed are " + Join(allowed) + "; the nearest is '" +
               NearestName(text, allowed) + "'");
    }
    value = text;
  }
  void Field(const char* key, const char*, std::vector<double>& value, int count,
             Range allowed) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    const std::vector<Node>& items = ReadList(*node, Path(key), "numbers");
    if (count > 0 && items.size() != static_cast<std::size_t>(count)) {
      Fail(node->place, Path(key),
           std::to_string(count) + " numbers are needed, found " + std::to_string(items.size()));
    }
    std::vector<double> read;
    for (std::size_t i = 0; i < items.size(); ++i) {
      read.push_back(ReadNumber(items[i], ItemPath(Path(key), i), allowed));
    }
    value = std::move(read);
  }
  void Field(const char* key, const char*, std::vector<std::string>& value) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    const std::vector<Node>& items = ReadList(*node, Path(key), "texts");
    std::vector<std::string> read;
    for (std::size_t i = 0; i < items.size(); ++i) {
      read.push_back(ReadText(items[i], ItemPath(Path(key), i)));
    }
    value = std::move(read);
  }
  void Section(const char* key, const char*,
               const std::function<void(ConfigVisitor&)>& visit) override {
    const Node* node = Get(key);
    const Node::Table* below = node == nullptr ? nullptr : std::get_if<Node::Table>(&node->value);
    if (node != nullptr && below == nullptr) {
      Fail(node->place, Path(key), "a table is needed, found " + Describe(*node));
    }
    Reader inner(below, Path(key));
    visit(inner);
  }

 private:
  const Node* Get(const char* key) const { return table_ ? Find(*table_, key) : nullptr; }
  std::string Path(const char* key) const { return Below(path_, key); }
  const Node::Table* table_;  ///< Null: the section is in no layer, defaults stay.
  std::string path_;
};

// ---- Writing ----------------------------------------------------------------------------------

bool IsBareKey(const std::string& key) {
  return !key.empty() && key.find_first_not_of(
                             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                             "0123456789_-") == std::string::npos;
}

std::string TomlText(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", byte);
      out += escape;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string TomlKey(const std::string& key) { return IsBareKey(key) ? key : TomlText(key); }

std::string TomlNumber(double value) {
  TT_CHECK(std::isfinite(value));  // The reader refuses anything else.
  std::string out = Number(value);
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

std::string TomlValue(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  if (value.is_number()) return TomlNumber(value.get<double>());
  if (value.is_string()) return TomlText(value.get<std::string>());
  std::vector<std::string> items;
  for (const Json& item : value) items.push_back(TomlValue(item));
  return "[" + Join(items) + "]";
}

void WriteComment(const Entry& entry, std::ostringstream& out) {
  std::string doc = entry.doc;
  if (entry.type == Entry::Type::kChoice) doc += " One of: " + Join(entry.choices) + ".";
  if (std::isfinite(entry.allowed.low) || std::isfinite(entry.allowed.high)) {
    doc += " Allowed: " + AllowedText(entry.allowed) + ".";
  }
  std::istringstream lines(doc);
  for (std::string line; std::getline(lines, line);) out << "# " << line << "\n";
}

/// Fields first, sections after: in TOML a field behind a table header belongs to that table.
void WriteEntries(const Entry& section, const std::string& path, bool with_docs,
                  std::ostringstream& out) {
  for (const Entry& entry : section.children) {
    if (entry.type == Entry::Type::kSection) continue;
    if (with_docs) WriteComment(entry, out);
    out << TomlKey(entry.key) << " = " << TomlValue(entry.value) << "\n";
  }
  for (const Entry& entry : section.children) {
    if (entry.type != Entry::Type::kSection) continue;
    const std::string below = Below(path, TomlKey(entry.key));
    if (out.tellp() > 0) out << "\n";
    if (with_docs) WriteComment(entry, out);
    out << "[" << below << "]\n";
    WriteEntries(entry, below, with_docs, out);
  }
}

void AddLimits(Range allowed, bool whole, Json& schema) {
  const auto limit = [whole](double value) {
    return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  if (std::isfinite(allowed.low)) schema["minimum"] = limit(allowed.low);
  if (std::isfinite(allowed.high)) schema["maximum"] = limit(allowed.high);
}

Json Schema(const Entry& entry) {
  Json out;
  if (!entry.doc.empty()) out["description"] = entry.doc;
  switch (entry.type) {
    case Entry::Type::kBool:
      out["type"] = "boolean";
      break;
    case Entry::Type::kInteger:
      out["type"] = "integer";
      AddLimits(entry.allowed, true, out);
      break;
    case Entry::Type::kNumber:
      out["type"] = "number";
      AddLimits(entry.allowed, false, out);
      break;
    case Entry::Type::kText:
      out["type"] = "string";
      break;
    case Entry::Type::kChoice:
      out["enum"] = entry.choices;
      break;
    case Entry::Type::kNumbers:
    case Entry::Type::kTexts:
      out["type"] = "array";
      out["items"]["type"] = entry.type == Entry::Type::kTexts ? "string" : "number";
      AddLimits(entry.allowed, false, out["items"]);
      if (entry.count > 0) out["minItems"] = out["maxItems"] = entry.count;
      break;
    case Entry::Type::kSection:
      out["type"] = "object";
      out["additionalProperties"] = false;
      out["properties"] = Json::object();
      for (const Entry& child : entry.children) out["properties"][child.key] = Schema(child);
      return out;
  }
  out["default"] = entry.value;
  return out;
}

}  // namespace

// ---- ConfigSource -----------------------------------------------------------------------------

struct ConfigSource::Impl {
  Node::Table layers;  ///< Merged so far.
};

ConfigSource::ConfigSource() : impl_(std::make_unique<Impl>()) {}
ConfigSource::~ConfigSource() = default;
ConfigSource::ConfigSource(ConfigSource&&) noexcept = default;
ConfigSource& ConfigSource::operator=(ConfigSource&&) noexcept = default;

void ConfigSource::AddFile(const std::string& path) { AddText(ReadFile(path), path); }

void ConfigSource::AddText(const std::string& toml, const std::string& name) {
  Merge(impl_->layers, TableFromToml(ParseToml(toml, name), name));
}

namespace {

/// The value of an override: TOML if it is one value, else the text as typed.
Node OverrideValue(const std::string& raw) {
  try {
    const toml::table parsed = toml::parse("v = " + raw);
    if (parsed.size() == 1) {
      Node node = FromToml(*parsed.get("v"), "");
      if (!std::holds_alternative<Node::Unsupported>(node.value)) return node;
    }
  } catch (const toml::parse_error&) {
    // No TOML: a bare text such as a path or a name, the usual case on a command line.
  }
  Node node;
  node.value = raw;
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

}  // namespace

void ConfigSource::AddOverride(const std::string& text) {
  const std::string place = "--set " + text;
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
  Node node = OverrideValue(trim(text.substr(equals + 1)));
  SetPlace(node, place);
  node.raw = trim(text.substr(equals + 1));
  node.from_override = true;
  for (std::size_t i = keys.size(); i-- > 1;) {
    Node table;
    table.value = Node::Table{{keys[i], std::move(node)}};
    table.place = table.key_place = place;
    node = std::move(table);
  }
  Node::Table layer;
  layer.emplace_back(keys.front(), std::move(node));
  Merge(impl_->layers, std::move(layer));
}

void ConfigSource::Read(const std::function<void(ConfigVisitor&)>& visit) const {
  const Entry known = DescribeFields(visit);
  CheckKeysKnown(impl_->layers, known, known, "");
  Reader reader(&impl_->layers, "");
  visit(reader);
}

std::string WriteToml(const std::function<void(ConfigVisitor&)>& visit, bool with_docs) {
  std::ostringstream out;
  WriteEntries(DescribeFields(visit), "", with_docs, out);
  return std::move(out).str();
}

std::string WriteConfigSchema(const std::function<void(ConfigVisitor&)>& visit) {
  Json out;
  out["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  out.update(Schema(DescribeFields(visit)));
  return out.dump(2) + "\n";
}

}  // namespace tubetwin

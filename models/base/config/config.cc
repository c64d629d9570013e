#include "models/base/config/config.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <Eigen/Core>

#include "models/base/config/config_entries.h"
#include "models/base/config/config_layers.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using config_internal::AllowedText;
using config_internal::Below;
using config_internal::Describe;
using config_internal::DescribeFields;
using config_internal::Entry;
using config_internal::Node;
using config_internal::Quoted;

constexpr std::uint64_t kMaxTomlBytes = std::uint64_t{4} << 20;

[[noreturn]] void Fail(const std::string& place, const std::string& path,
                       const std::string& problem) {
  constexpr std::size_t kShown = 100;
  throw Error(ErrorKind::kConfig, place + ": " + Printable(path.substr(0, kShown)) +
                                      (path.size() > kShown ? "..." : "") + ": " + problem);
}

/// Full paths of every entry whose last part is `key`.
void FindKey(const Entry& entry, const std::string& key, const std::string& path,
             std::vector<std::string>& found) {
  for (const Entry& child : entry.children) {
    if (child.key == key) found.push_back(Below(path, child.key));
    FindKey(child, key, Below(path, child.key), found);
  }
}

/// `taken`: keys of the top level that are read elsewhere.
void CheckKeysKnown(const Node::Table& table, const Entry& entry, const Entry& root,
                    const std::string& path, const std::vector<std::string>& taken = {}) {
  for (const Node::Member& member : table) {
    const std::string& key = member.key;
    const Node& node = member.node;
    const auto known = std::find_if(entry.children.begin(), entry.children.end(),
                                    [&](const Entry& child) { return child.key == key; });
    if (known == entry.children.end()) {
      std::vector<std::string> elsewhere;
      FindKey(root, key, "", elsewhere);
      std::string hint;
      if (!elsewhere.empty()) {
        hint = "; there is '" + Join(elsewhere, "', '") + "'";
      } else if (!entry.children.empty() || !taken.empty()) {
        std::vector<std::string> names = taken;
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

/// The name of a file or of what stands in one: none needs a line break or another control
/// character, and reports, tables and messages show it.
std::string ReadName(const Node& node, const std::string& path) {
  std::string name = ReadText(node, path);
  const bool control = std::any_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
  if (control) {
    Fail(node.place, path, "is " + Quoted(name) + "; allowed: texts without control characters");
  }
  return name;
}

const std::vector<Node>& ReadList(const Node& node, const std::string& path,
                                  const std::string& of_what) {
  const auto* list = std::get_if<std::vector<Node>>(&node.value);
  if (list == nullptr) {
    Fail(node.place, path, "a list of " + of_what + " is needed, found " + Describe(node));
  }
  return *list;
}

/// A file that a layer names, from the working directory.
std::string FileOf(const Node& node, const std::string& file) {
  if (file.empty() || node.folder.empty()) return file;
  return (std::filesystem::path(node.folder) / file).lexically_normal().string();
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
  void NumbersOrNone(const char* key, const char* doc, std::vector<double>& value, int count,
                     Range allowed) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    const bool none = ReadList(*node, Path(key), "numbers").empty();
    Field(key, doc, value, none ? 0 : count, allowed);
  }
  void File(const char* key, const char*, std::string& value) override {
    if (const Node* node = Get(key)) value = FileOf(*node, ReadName(*node, Path(key)));
  }
  void NameOrFile(const char* key, const char*, std::string& value) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    value = ReadName(*node, Path(key));
    if (value.ends_with(".toml")) value = FileOf(*node, value);
  }
  void Files(const char* key, const char* doc, std::vector<std::string>& value) override {
    const Node* node = Get(key);
    if (node == nullptr) return;
    Field(key, doc, value);
    for (std::string& file : value) file = FileOf(*node, file);
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

 protected:
  void CheckPose(const char* key, const std::vector<double>& xyz_wxyz) override {
    const Node* node = Get(key);
    if (node == nullptr || xyz_wxyz.empty()) return;
    constexpr double kUnit = 1e-3;  // as many digits as people write
    const double norm = Eigen::Map<const Eigen::Vector4d>(&xyz_wxyz[3]).norm();
    if (std::abs(norm - 1.0) < kUnit) return;
    Fail(node->place, Path(key),
         "its quaternion has length " + Number(norm) +
             "; a quaternion w x y z of length 1 is needed, as in [1, 0, 0, 0]");
  }

 private:
  const Node* Get(const char* key) const { return table_ ? Find(*table_, key) : nullptr; }
  std::string Path(const char* key) const { return Below(path_, key); }
  const Node::Table* table_;  ///< Null: the section is in no layer, defaults stay.
  std::string path_;
};

}  // namespace

ConfigSource::ConfigSource() : impl_(std::make_unique<Impl>()) {}
ConfigSource::~ConfigSource() = default;
ConfigSource::ConfigSource(ConfigSource&&) noexcept = default;
ConfigSource& ConfigSource::operator=(ConfigSource&&) noexcept = default;

void ConfigSource::AddFile(const std::string& path) {
  Merge(impl_->layers,
        config_internal::ParseLayer(ReadFile(path, kMaxTomlBytes), path,
                                    std::filesystem::path(path).parent_path().string()));
}

void ConfigSource::AddText(const std::string& toml, const std::string& name) {
  Merge(impl_->layers, config_internal::ParseLayer(toml, name));
  if (impl_->place.empty()) impl_->place = name;
}

void ConfigSource::AddOverride(const std::string& text) {
  Merge(impl_->layers, config_internal::ParseOverride(text));
}

void ConfigSource::Read(const std::function<void(ConfigVisitor&)>& visit) const {
  const Entry known = DescribeFields(visit);
  CheckKeysKnown(impl_->layers, known, known, "", impl_->taken);
  Reader reader(&impl_->layers, "");
  visit(reader);
}

}  // namespace tubetwin

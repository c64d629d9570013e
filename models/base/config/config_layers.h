#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "models/base/config/config.h"

namespace tubetwin::config_internal {

/// One value of a layer with the place it came from. Own type because toml++ forgets the place of
/// a node when it is copied into another table, and because its header stays in one .cc file.
struct Node {
  struct Unsupported {
    std::string what;
  };
  struct Member;
  using Table = std::vector<Member>;  ///< In the order in which the keys appeared.
  std::variant<bool, std::int64_t, double, std::string, std::vector<Node>, Table, Unsupported>
      value;
  std::string place;      ///< "file:line:column", or "--set a.b=value".
  std::string key_place;  ///< Of the key, where that differs.
  std::string raw;        ///< What a person typed after `--set a.b=`; empty for files.
  bool from_override = false;
  std::string folder;  ///< Of the file that it stands in; empty: none, or the working directory.
};

struct Node::Member {
  std::string key;
  Node node;
};

const Node* Find(const Node::Table& table, const std::string& key);

/// `top` wins; tables are merged key by key, anything else is replaced whole.
void Merge(Node::Table& below, Node::Table top);

/// Throws Error(kConfig) with place for bad syntax. `folder`: of the file, for files that it names.
Node::Table ParseLayer(const std::string& toml, const std::string& name,
                       const std::string& folder = "");

/// "a.b=value" as a layer. Throws Error(kUsage) for what is no KEY=VALUE.
Node::Table ParseOverride(const std::string& text);

/// What a person would say is there, for messages: "the text \"abc\"".
std::string Describe(const Node& node);

/// In quotes, escaped, cut after 40 bytes.
std::string Quoted(const std::string& text);

/// "a.b" below "cell" is "cell.a.b".
inline std::string Below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// Letters, digits, underscore and hyphen: needs no quotes in TOML.
bool IsBareKey(const std::string& key);

}  // namespace tubetwin::config_internal

namespace tubetwin {

struct ConfigSource::Impl {
  config_internal::Node::Table layers;  ///< Merged so far.
  std::string place;                    ///< Of the first layer, or of the table it was taken from.
  std::vector<std::string> taken;       ///< Keys that TakeTable and TakeTables were asked for.
};

}  // namespace tubetwin

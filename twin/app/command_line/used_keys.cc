#include "twin/app/command_line/used_keys.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/text.h"
#include "twin/round/scenario.h"

namespace tubetwin {
namespace {

bool Covers(const std::string& used, const std::string& key) {
  return used.empty() || key == used || key.starts_with(used + ".");
}

std::string KeyOfOverride(const std::string& override_text) {
  std::string key = override_text.substr(0, override_text.find('='));
  key.erase(std::remove_if(key.begin(), key.end(), [](char c) { return c == ' ' || c == '\t'; }),
            key.end());
  return key;
}

}  // namespace

const UsedKeys& AllKeys() {
  static const UsedKeys all = {""};
  return all;
}

UsedKeys PileKeysAnd(const UsedKeys& more) {
  UsedKeys keys = {"bin.size_m", "bin.mesh", "bin.mesh_units", "pile.part", "part.name"};
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

UsedKeys BinKeysAnd(const UsedKeys& more) {
  UsedKeys keys = {"bin.size_m", "bin.mesh", "bin.mesh_units", "bin.X_BN"};
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

void RefuseUnusedKeys(const std::vector<std::string>& overrides, const UsedKeys& used,
                      const std::string& who) {
  const bool mesh = std::any_of(overrides.begin(), overrides.end(), [](const std::string& text) {
    return KeyOfOverride(text) == "bin.mesh";
  });
  for (const std::string& text : overrides) {
    const std::string key = KeyOfOverride(text);
    // Only verbs that read no scenario file name the single key: no file can give the mesh.
    const bool names_unit = std::count(used.begin(), used.end(), "bin.mesh_units") > 0;
    if (key == "bin.mesh_units" && names_unit && !mesh) {
      throw Error(ErrorKind::kUsage,
                  "--set bin.mesh_units: is the unit of bin.mesh, which is not given; give both");
    }
    if (std::any_of(used.begin(), used.end(),
                    [&](const std::string& one) { return Covers(one, key); })) {
      continue;  // Its reader checks it.
    }
    ConfigSource alone;
    alone.AddOverride(text);
    Scenario any;
    alone.ReadInto(any);
    throw Error(ErrorKind::kUsage, "--set " + key + ": `" + who + "` does not use this key; " +
                                       (used.empty() ? "it uses none" : "it uses " + Join(used)));
  }
}

void RefuseSaidTwice(const CLI::App& verb, const std::vector<std::string>& overrides) {
  struct Same {
    const char *option, *key;
  };
  constexpr Same kSame[] = {{"--seed", "seed"},       {"--part", "pile.part"},
                            {"--part", "part.name"},  {"--bin", "bin.size_m"},
                            {"--profile", "profile"}, {"--pile", "pile.file"}};
  for (const auto& [name, same] : kSame) {
    const CLI::Option* option = verb.get_option_no_throw(name);
    if (option == nullptr || option->count() == 0) continue;
    for (const std::string& text : overrides) {
      if (KeyOfOverride(text) != same) continue;
      throw Error(ErrorKind::kUsage,
                  std::string(name) + " and --set " + same + " say the same thing: give one");
    }
  }
}

}  // namespace tubetwin

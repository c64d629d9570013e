#include "twin/app/command_line/suggest.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "models/base/text.h"

namespace tubetwin {
namespace {

std::vector<std::string> VerbNames(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    out.push_back(verb->get_name());
  }
  return out;
}

/// "--out", "-v" and so on.
std::vector<std::string> OptionNames(const CLI::App& verb) {
  std::vector<std::string> out;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    for (const std::string& name : option->get_snames()) out.push_back("-" + name);
  }
  return out;
}

/// Whether the option takes a value, which is then the next word.
bool TakesValue(const CLI::App& verb, const std::string& name) {
  const CLI::Option* option = verb.get_option_no_throw(name);
  return option != nullptr && option->get_items_expected_max() > 0;
}

bool Knows(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string FullName(const CLI::App& verb) {
  const CLI::App* parent = verb.get_parent();
  return parent == nullptr ? verb.get_name() : FullName(*parent) + " " + verb.get_name();
}

NamedVerb VerbOf(const CLI::App& program, const std::vector<std::string>& words) {
  NamedVerb out{&program, 0};
  for (const std::string& word : words) {
    if (!Knows(VerbNames(*out.verb), word)) break;
    out.verb = out.verb->get_subcommand(word);
    ++out.words;
  }
  return out;
}

std::string MisspeltVerb(const CLI::App& program, const std::vector<std::string>& words) {
  const auto [verb, used] = VerbOf(program, words);
  const std::vector<std::string> verbs = VerbNames(*verb);
  const auto at = static_cast<std::size_t>(used);
  if (verbs.empty() || at >= words.size() || words[at].empty() || words[at][0] == '-') return "";
  return "no verb" + (used == 0 ? "" : " of `" + FullName(*verb) + "`") + " is called '" +
         words[at] + "'; nearest: '" + NearestName(words[at], verbs) + "'; there are " +
         Join(verbs);
}

std::string MisspeltOption(const CLI::App& program, const std::vector<std::string>& words) {
  const auto [verb, used] = VerbOf(program, words);
  const std::vector<std::string> rest(words.begin() + used, words.end());
  const std::vector<std::string> options = OptionNames(*verb);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const std::string& word = rest[i];
    if (word == "--") return "";
    if (word.size() < 2 || word[0] != '-') continue;
    const std::string name = word.substr(0, word.find('='));
    if (Knows(options, name)) {
      if (name == word && TakesValue(*verb, name)) ++i;
      continue;
    }
    const bool short_name = name[1] != '-';
    const bool number = short_name && (name[1] == '.' || (name[1] >= '0' && name[1] <= '9'));
    const bool joined = short_name && Knows(options, name.substr(0, 2));  // "-qv".
    if (number || joined) continue;
    return name + " is no option of `" + FullName(*verb) +
           "`; nearest: " + NearestName(name, options);
  }
  return "";
}

std::vector<std::string> HelpWords(std::vector<std::string> words) {
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

}  // namespace tubetwin

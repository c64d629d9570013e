#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tubetwin {

/// The verb that words of a command line name, as far as they do ("campaign", "run"), and how many
/// of them named it.
struct NamedVerb {
  const CLI::App* verb = nullptr;
  int words = 0;
};
NamedVerb VerbOf(const CLI::App& program, const std::vector<std::string>& words);

/// "tubetwin campaign run".
std::string FullName(const CLI::App& verb);

/// What is wrong where a verb should stand, with the nearest: "no verb is called 'rnu'; nearest:
/// 'run'; there are ...". Empty when a verb stands there, or none is needed.
std::string MisspeltVerb(const CLI::App& program, const std::vector<std::string>& words);

/// What is wrong with the first option that the verb does not have, with the nearest: "--vido is no
/// option of `tubetwin run`; nearest: --video". Empty when every option is known.
std::string MisspeltOption(const CLI::App& program, const std::vector<std::string>& words);

/// `tubetwin help [VERB...]` as the words that ask for the same: [VERB...] --help. Others as they
/// are.
std::vector<std::string> HelpWords(std::vector<std::string> words);

}  // namespace tubetwin

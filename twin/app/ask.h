#pragma once

#include <string>

namespace tubetwin {

/// What is about to move, for a person's word.
struct Asked {
  std::string verb;  ///< "jog"
  std::string what;  ///< "the arm may move": what a person allows.
  std::string told;  ///< Shown before the question: what will move, and how.
  std::string word;  ///< That the person types: "move".
};

/// A person at a terminal types the word, or whoever wrote --yes (`yes`) has said so. Throws
/// Error(kUsage) when nobody is there, Error(kInterrupted) for another word.
void RequireWord(const Asked& asked, bool yes);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

namespace tubetwin::architecture {

/// One source file of the tree with what the rules ask about it.
struct SourceFile {
  std::string path;                   ///< From the top of the tree: "models/arm/arm.h".
  std::vector<std::string> lines;     ///< Without line ends.
  std::vector<std::string> quoted;    ///< #include "..."
  std::vector<std::string> brackets;  ///< #include <...>
};

/// All .h and .cc files of the rooms and of tests, sorted by path.
std::vector<SourceFile> ReadSources(const std::string& top);

/// Parses one file's text; for the rules' own tests.
SourceFile ParseSource(const std::string& path, const std::string& text);

/// Names of the files and folders directly in the tree's top that git keeps: all but what
/// .gitignore names and .git itself. Sorted.
std::vector<std::string> TopLevel(const std::string& top);

}  // namespace tubetwin::architecture

#pragma once

#include <string>
#include <vector>

#include "tests/architecture/tree.h"

namespace tubetwin::architecture {

/// Each of these returns one sentence per break of its rule.

/// At most 400 lines, or a line "Long file: REASON" among the first 60.
std::vector<std::string> CheckFileSizes(const std::vector<SourceFile>& files);

/// At most 60 lines from a function's first line to its closing brace, or a comment "Long function:
/// REASON" right above or inside it. It reads the layout that clang-format gives, not C++.
std::vector<std::string> CheckFunctionSizes(const std::vector<SourceFile>& files);

/// At most 25 sources directly in one folder; tests aside.
std::vector<std::string> CheckFolderSizes(const std::vector<SourceFile>& files);

/// `top`/`folder`/README.md has at most `max_lines` lines. A folder inside a room may be on that
/// room's page instead, by its name.
std::vector<std::string> CheckReadme(const std::string& top, const std::string& folder,
                                     int max_lines);

}  // namespace tubetwin::architecture

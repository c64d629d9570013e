#include "tests/architecture/tree.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "models/base/files.h"

namespace tubetwin::architecture {
namespace {

namespace fs = std::filesystem;

/// The name inside the include, when `line` is one that opens with `open`.
bool IncludeName(const std::string& line, char open, char close, std::string& name) {
  std::istringstream words(line);
  std::string directive;
  std::string rest;
  words >> directive;
  if (directive == "#") {
    std::string second;
    words >> second;
    directive += second;
  }
  std::getline(words, rest);
  const std::size_t first = rest.find_first_not_of(" \t");
  if (directive != "#include" || first == std::string::npos || rest[first] != open) return false;
  const std::size_t last = rest.find(close, first + 1);
  if (last == std::string::npos) return false;
  name = rest.substr(first + 1, last - first - 1);
  return true;
}

}  // namespace

SourceFile ParseSource(const std::string& path, const std::string& text) {
  SourceFile file;
  file.path = path;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::string name;
    if (IncludeName(line, '"', '"', name)) file.quoted.push_back(name);
    if (IncludeName(line, '<', '>', name)) file.brackets.push_back(name);
    file.lines.push_back(std::move(line));
  }
  return file;
}

std::vector<SourceFile> ReadSources(const std::string& top) {
  std::vector<SourceFile> files;
  for (const char* folder :
       {"hw_bridge", "models", "scenes", "perception", "planner", "twin", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(top) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || (extension != ".h" && extension != ".cc")) continue;
      files.push_back(
          ParseSource(fs::relative(entry.path(), top).string(), ReadFile(entry.path().string())));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::vector<std::string> TopLevel(const std::string& top) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(top)) {
    const std::string name = entry.path().filename().string();
    const bool ignored = name == ".git" || name == "build" || name.rfind("build-", 0) == 0 ||
                         name == "out" || name.ends_with(".swp");
    if (!ignored) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace tubetwin::architecture

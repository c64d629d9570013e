#include "tests/architecture/size_rules.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "models/base/files.h"

namespace tubetwin::architecture {
namespace {

constexpr std::size_t kMaxFileLines = 400;
constexpr std::size_t kMaxFunctionLines = 60;
constexpr int kMaxFolderSources = 25;

bool StartsWithWord(const std::string& text, std::size_t at, const char* word) {
  return text.compare(at, std::string(word).size(), word) == 0;
}

/// Whether a line holds `mark` and a reason, not just the mark.
bool Argues(const std::string& line, const std::string& mark) {
  const std::size_t at = line.find(mark);
  return at != std::string::npos && line.size() > at + mark.size() + 15;
}

/// The functions of one file whose declarations begin at one indent: 0 for a file, 2 for a class.
class FunctionScan {
 public:
  FunctionScan(const SourceFile& file, std::vector<std::string>& breaks)
      : file_(file), breaks_(breaks) {}

  void Scan(std::size_t indent, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end;) {
      const std::size_t text = file_.lines[i].find_first_not_of(' ');
      if (text != indent || std::string("}#/").find(file_.lines[i][text]) != std::string::npos) {
        ++i;
        continue;
      }
      i = Declaration(indent, i, end);
    }
  }

 private:
  /// Looks at the declaration that begins in line `i`; returns the line after it.
  std::size_t Declaration(std::size_t indent, std::size_t i, std::size_t end) {
    std::size_t open = i;
    const auto last = [&](std::size_t line) {
      return file_.lines[line].empty() ? ' ' : file_.lines[line].back();
    };
    while (open < end && std::string("{;}").find(last(open)) == std::string::npos) ++open;
    if (open == end || last(open) != '{') return open + 1;
    const std::string& first = file_.lines[i];
    if (StartsWithWord(first, indent, "namespace")) return open + 1;
    std::size_t close = open + 1;
    while (close < end && file_.lines[close].find_first_not_of(' ') != indent) ++close;
    while (close < end &&
           (file_.lines[close].size() <= indent || file_.lines[close][indent] != '}')) {
      ++close;
    }
    std::string head;
    for (std::size_t line = i; line <= open; ++line) head += file_.lines[line];
    const bool is_class =
        head.find('(') == std::string::npos &&
        (head.find("struct ") != std::string::npos || head.find("class ") != std::string::npos);
    if (is_class) {
      Scan(indent + 2, open + 1, close);
    } else if (head.find('(') != std::string::npos) {
      Judge(i, close);
    }
    return close + 1;
  }

  void Judge(std::size_t first, std::size_t last) {
    const std::size_t lines = last - first + 1;
    if (lines <= kMaxFunctionLines) return;
    const std::size_t above = first > 3 ? first - 3 : 0;
    for (std::size_t line = above; line < first + 10; ++line) {
      if (Argues(file_.lines[line], "Long function: ")) return;
    }
    breaks_.push_back(
        file_.path + ":" + std::to_string(first + 1) + " begins a function of " +
        std::to_string(lines) +
        " lines; split it by named steps, or argue in a comment \"Long function: REASON\"");
  }

  const SourceFile& file_;
  std::vector<std::string>& breaks_;
};

}  // namespace

std::vector<std::string> CheckFileSizes(const std::vector<SourceFile>& files) {
  constexpr std::size_t kHead = 60;
  std::vector<std::string> breaks;
  for (const SourceFile& file : files) {
    if (file.lines.size() <= kMaxFileLines) continue;
    const bool argued =
        std::any_of(file.lines.begin(), file.lines.begin() + kHead,
                    [](const std::string& line) { return Argues(line, "// Long file: "); });
    if (!argued) {
      breaks.push_back(file.path + " has " + std::to_string(file.lines.size()) +
                       " lines; split it, or argue in a line \"Long file: REASON\" at its head");
    }
  }
  return breaks;
}

std::vector<std::string> CheckFunctionSizes(const std::vector<SourceFile>& files) {
  std::vector<std::string> breaks;
  for (const SourceFile& file : files) FunctionScan(file, breaks).Scan(0, 0, file.lines.size());
  return breaks;
}

std::vector<std::string> CheckFolderSizes(const std::vector<SourceFile>& files) {
  std::map<std::string, int> sources;
  for (const SourceFile& file : files) {
    if (file.path.rfind("tests/", 0) == 0) continue;
    ++sources[std::filesystem::path(file.path).parent_path().string()];
  }
  std::vector<std::string> breaks;
  for (const auto& [folder, count] : sources) {
    if (count <= kMaxFolderSources) continue;
    breaks.push_back(folder + " holds " + std::to_string(count) +
                     " sources; make rooms of it, at most " + std::to_string(kMaxFolderSources) +
                     " each");
  }
  return breaks;
}

std::vector<std::string> CheckReadme(const std::string& top, const std::string& folder,
                                     int max_lines) {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(top) / folder / "README.md";
  if (!fs::exists(path)) {
    const fs::path above = fs::path(top) / fs::path(folder).parent_path() / "README.md";
    const std::string name = fs::path(folder).filename().string();
    const bool told = fs::path(folder).has_parent_path() && fs::exists(above) &&
                      ReadFile(above.string()).find(name) != std::string::npos;
    if (told) return {};
    return {folder + " has no README.md, and " + above.string() + " does not tell of it"};
  }
  const std::string text = ReadFile(path.string());
  const auto lines = std::count(text.begin(), text.end(), '\n');
  if (lines <= max_lines) return {};
  return {(folder.empty() ? "" : folder + "/") + "README.md has " + std::to_string(lines) +
          " lines, at most " + std::to_string(max_lines)};
}

}  // namespace tubetwin::architecture

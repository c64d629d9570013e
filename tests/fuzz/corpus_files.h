#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "models/base/files.h"

namespace tubetwin {

/// Contents of all files of tests/fuzz/corpus/NAME, in the order of their names.
inline std::vector<std::string> CorpusFiles(const std::string& name) {
  std::vector<std::string> paths, out;
  const std::filesystem::path folder = std::filesystem::path(TUBETWIN_FUZZ_CORPUS) / name;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  for (const std::string& path : paths) out.push_back(ReadFile(path));
  return out;
}

}  // namespace tubetwin

#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "models/base/disk/file_lock.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// The folder that one call of a verb fills (`run`, `emulate`), its own as long as this lives. What
/// it may replace or remove there is what its manifest.json names: nothing else is the program's.
class ResultFolder {
 public:
  struct Claim {
    std::string verb;                ///< Whose manifest it is.
    std::vector<std::string> names;  ///< Of all files that may be written.
    bool force = false;              ///< Files of `names` that are somebody else's are replaced.
  };

  /// Makes the folder and takes it. Throws Error(kCannotCreate) when another process fills it, it
  /// holds a campaign, or, unless forced, one of `names` that no manifest of this verb names;
  /// nothing is changed before.
  ResultFolder(const std::string& path, Claim claim);
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Removes what the manifest of an earlier call names, but for `replaced`, which are written anew
  /// and may be read until then. Says in the manifest what this call may write.
  void Begin(const std::vector<std::string>& replaced);
  /// Says in the manifest that these will be written, too. Before they are.
  void Add(const std::vector<std::string>& names);
  /// Writes `manifest` with the checks of all files said so far (FileChecks()): `named_only` may
  /// change later and are only named, as are pictures and films.
  void End(Json manifest, const std::vector<std::string>& named_only);

 private:
  void WriteNames() const;

  std::string path_, verb_;
  std::set<std::string> names_, earlier_;
  std::unique_ptr<FileLock> lock_;
};

}  // namespace tubetwin

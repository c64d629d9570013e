#pragma once

#include <string>
#include <vector>

#include "models/base/json_fwd.h"

namespace tubetwin {

/// What a manifest says of files of its folder, each by its name there: {"picks.jsonl": {"bytes",
/// "rows", "check"}, "report.html": null}. `bytes` and `check` are size and fingerprint of the
/// content, `rows` the lines of a *.jsonl; null where a file is named only, because it may change
/// or is not there yet. Throws Error(kIo | kMissing) for a file of `checked` that cannot be read.
Json FileChecks(const std::string& folder, const std::vector<std::string>& checked,
                const std::vector<std::string>& named_only);

/// Reads FOLDER/manifest.json and compares what it says of files with what is there. Files of
/// `required` must be there, others may have been removed. `always`: the manifest must say what
/// these hold; else nothing is compared where there is no manifest, or one of before 0.4, which
/// says nothing of files. Throws Error(kBadData) naming the file, what was found and what was
/// written.
void RequireWholeFiles(const std::string& folder, const std::vector<std::string>& required,
                       bool always);

}  // namespace tubetwin

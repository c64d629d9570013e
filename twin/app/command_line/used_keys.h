#pragma once

#include <string>
#include <vector>

namespace tubetwin {

/// Which configuration keys a verb uses: whole keys ("bin.size_m") or families ("scan" is all of
/// scan.*).
using UsedKeys = std::vector<std::string>;

/// Of verbs that run or judge a whole scenario.
const UsedKeys& AllKeys();
/// That say which tubes lie in which bin, for verbs that read a pile.
UsedKeys PileKeysAnd(const UsedKeys& more);

/// Throws Error(kUsage) naming the first `--set` key that is not used, with the keys that are, and
/// Error(kConfig) for one that no verb knows. `who`: "tubetwin scan".
void RefuseUnusedKeys(const std::vector<std::string>& overrides, const UsedKeys& used,
                      const std::string& who);

}  // namespace tubetwin

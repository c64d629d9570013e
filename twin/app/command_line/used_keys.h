#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tubetwin {

/// Which configuration keys a verb uses: whole keys ("bin.size_m") or families ("scan" is all of
/// scan.*).
using UsedKeys = std::vector<std::string>;

/// Of verbs that run or judge a whole scenario.
const UsedKeys& AllKeys();
/// That say which tubes lie in which bin, for verbs that read a pile.
UsedKeys PileKeysAnd(const UsedKeys& more);

/// The whole [bin], for verbs that place it in the cell too.
UsedKeys BinKeysAnd(const UsedKeys& more);

/// Throws Error(kUsage) naming the first `--set` key that is not used, with the keys that are, and
/// Error(kConfig) for one that no verb knows. `who`: "tubetwin scan". A unit of a mesh without the
/// mesh is not used either.
void RefuseUnusedKeys(const std::vector<std::string>& overrides, const UsedKeys& used,
                      const std::string& who);

/// Throws Error(kUsage) where an option that `verb` was given and a `--set` key say the same thing:
/// one would be lost.
void RefuseSaidTwice(const CLI::App& verb, const std::vector<std::string>& overrides);

}  // namespace tubetwin

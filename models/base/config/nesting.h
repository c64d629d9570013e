#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tubetwin::config_internal {

/// How deep lists, tables and dotted keys may nest. Readers and trees of values call themselves
/// once a level; no configuration needs more than a handful.
constexpr int kDeepestNesting = 32;

/// The line, counted from 1, where a TOML text nests deeper than that: brackets within brackets, or
/// the parts of one key. Looks at the text alone, before any parser does. Nothing: it does not.
std::optional<int> LineOfDeepNesting(std::string_view toml);

}  // namespace tubetwin::config_internal

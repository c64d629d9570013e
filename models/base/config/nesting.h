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

/// Where, as a byte of the text, the first character beyond ASCII stands outside quotes and
/// comments. TOML allows none there, and toml++ 3.3 has no defined answer to U+00A1 to U+0499
/// (is_non_ascii_horizontal_whitespace). Nothing: there is none.
std::optional<std::size_t> FindBareNonAscii(std::string_view toml);

}  // namespace tubetwin::config_internal

#pragma once

#include <string>
#include <vector>

namespace tubetwin {

/// A list of numbers of a TOML file: `key` of the table `table` of the top level.
struct TomlNumbers {
  std::string table, key;
  std::vector<double> values;
};

/// The TOML text with `numbers` in it, in place of the list that was there or, where there was
/// none, as a line of its own in its table. All else stays byte by byte: comments, order, line
/// ends. `name` is the file, for messages. Throws Error(kConfig) for a text that is not TOML, and
/// where the list has no place (the table is no table, or holds no numbers under that key).
std::string WithTomlNumbers(const std::string& toml, const std::string& name,
                            const TomlNumbers& numbers);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/json.h"
#include "models/base/text.h"

namespace tubetwin {

/// The whole numbers of a list. Throws Error(kBadData).
inline std::vector<int> IntegersFromJson(const JsonView& view) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < view.Size(); ++i) {
    numbers.push_back(static_cast<int>(view.Item(i).AsInteger()));
  }
  return numbers;
}

/// The value of an enumeration, counted up from 0 to `last`, that ToString() calls as the text
/// does. Throws Error(kBadData) naming what is known.
template <class Enum>
Enum EnumFromJson(const JsonView& view, Enum last) {
  const std::string name = view.AsString();
  std::vector<std::string> known;
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    known.push_back(ToString(static_cast<Enum>(i)));
    if (known.back() == name) return static_cast<Enum>(i);
  }
  view.Fail("'" + name + "' is none of " + Join(known));
}

}  // namespace tubetwin

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "models/base/json_text.h"
#include "models/base/text.h"

namespace tubetwin {

/// The version in "schema": "tubetwin/NAME/VERSION". Throws Error(kBadData) for another name and
/// for versions that this program does not know, which are those beyond `newest`.
inline int SchemaVersion(const JsonView& document, const std::string& name, int newest) {
  const std::string found = document.Field("schema").AsString();
  for (int version = 1; version <= newest; ++version) {
    if (found == "tubetwin/" + name + "/" + std::to_string(version)) return version;
  }
  document.Fail("schema is '" + found + "', 'tubetwin/" + name + "/" + std::to_string(newest) +
                "' is needed here");
}

/// A field that rows always have, null where there is nothing to tell. Throws Error(kBadData) where
/// it is missing.
inline std::optional<JsonView> FieldOrNull(const JsonView& row, const std::string& name) {
  return row.Field(name).json().is_null() ? std::nullopt : row.Optional(name);
}

/// The number of a row's or record's variant, which earlier versions called its arm. Throws
/// Error(kBadData).
inline int VariantOf(const JsonView& row) {
  const auto variant = row.Optional("variant");
  const auto number = variant ? variant : row.Optional("arm");
  return CountFromJson(number ? *number : row.Field("variant"));
}

/// The whole numbers of a list. Throws Error(kBadData).
inline std::vector<int> IntegersFromJson(const JsonView& view) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < view.Size(); ++i) {
    numbers.push_back(CountFromJson(view.Item(i)));
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

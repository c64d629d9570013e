#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/base/json.h"

namespace tubetwin::config_internal {

/// One key of a visit list with its current value.
struct Entry {
  enum class Type { kBool, kInteger, kNumber, kText, kChoice, kNumbers, kTexts, kSection };
  std::string key;
  std::string doc;
  Type type = Type::kSection;
  Json value;
  Range allowed;
  int count = 0;  ///< Of a list; 0 means any.
  std::vector<std::string> choices;
  std::vector<Entry> children;  ///< Of a section.
};

/// The visit list as a tree; the root is a section without key. A section visited twice is one; a
/// field visited twice is a bug.
Entry DescribeFields(const std::function<void(ConfigVisitor&)>& visit);

/// "0 to 1", "at least 0".
std::string AllowedText(Range allowed);

}  // namespace tubetwin::config_internal

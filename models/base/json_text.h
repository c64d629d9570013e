#pragma once

#include <string>
#include <string_view>

#include "models/base/frames.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// How deep lists and objects may nest: trees of values are copied and written by functions that
/// call themselves once a level. No file of this program needs more than a dozen.
constexpr int kDeepestJson = 64;

/// Parses JSON, whoever wrote it. Throws Error(kBadData) that begins with `source`: for what is no
/// JSON, with the byte; for numbers that no double holds; for deeper nesting than kDeepestJson.
Json ParseJson(std::string_view text, const std::string& source);

/// A whole number from `low` to `high`. Throws Error(kBadData) naming file, place and value.
int IntegerIn(const JsonView& view, int low, int high);

/// The same, 0 and more: an id or a count.
int CountFromJson(const JsonView& view);

/// A pose of sixteen numbers, by columns, whose parts are a rotation and a point within 100 m.
/// Throws Error(kBadData).
RigidTransform TransformOfColumns(const JsonView& view);

}  // namespace tubetwin

#pragma once

#include <string>

#include "models/base/json_fwd.h"

namespace tubetwin {

/// What stands in a report where there is no value.
inline constexpr const char* kDash = "\xe2\x80\x93";

/// Text for HTML, between tags and in quoted attributes.
std::string Escaped(const std::string& text);

/// JSON for a script element: no text in it can end the element or begin a comment, and it stays
/// the same JSON. Bytes that are no UTF-8 become U+FFFD.
std::string ScriptJson(const Json& json);

/// Base 64 (RFC 4648).
std::string Base64(const std::string& bytes);

/// The value under nested keys; null when any is absent.
const Json& At(const Json& json, const std::string& pointer);

/// With that many digits after the point; a dash for what is no number.
std::string Fixed(const Json& value, int digits);
std::string Fixed(double value, int digits);

/// A value as a person reads it, escaped; a dash for null and for an empty text.
std::string Shown(const Json& value);

/// A number of summary.json as the page shows it, `pointer` (RFC 6901) beside it: whoever doubts a
/// number finds where it comes from. A dash where there is none.
std::string CountHtml(const Json& summary, const std::string& pointer);
std::string FixedHtml(const Json& summary, const std::string& pointer, int digits);

/// A rate {k, n, wilson95, cluster95?} of summary.json: "93.3 %" and
/// "42 of 45, 95 % interval 82.1 to 97.7 %". A dash for n = 0.
std::string SharePercentHtml(const Json& summary, const std::string& pointer);
std::string ShareDetailHtml(const Json& summary, const std::string& pointer);

/// "<td class=n>..</td>".
std::string NumberCell(const std::string& html);

}  // namespace tubetwin

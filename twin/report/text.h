#pragma once

#include <optional>
#include <string>
#include <utility>

#include "models/base/json_fwd.h"
#include "twin/statistics/rate.h"

namespace tubetwin {

/// What stands in a report where there is no value.
inline constexpr const char* kDash = "\xe2\x80\x93";

/// Text for HTML, between tags and in quoted attributes.
std::string Escaped(const std::string& text);

/// A link to a file, from the folder of the page: percent-encoded (RFC 3986), and never read as a
/// scheme such as "javascript:", for HTML.
std::string LinkTo(const std::string& path);

/// JSON for a script element: no text in it can end the element or begin a comment, and it stays
/// the same JSON. Bytes that are no UTF-8 become U+FFFD.
std::string ScriptJson(const Json& json);

/// Base 64 (RFC 4648).
std::string Base64(const std::string& bytes);

/// With that many digits after the point.
std::string Fixed(double value, int digits);

/// A text of a record as a person reads it, escaped; a dash for an empty one.
std::string Shown(const std::string& text);

/// Where a number stands in summary.json (RFC 6901), so that the page can say it beside the number:
/// whoever doubts one finds where it comes from. Of a page whose numbers stand in no file, nowhere.
class Pointer {
 public:
  static Pointer Nowhere() { return Pointer(std::nullopt); }
  Pointer() : path_("") {}  ///< The whole document.
  Pointer operator/(const std::string& key) const;
  Pointer operator/(std::size_t index) const { return *this / std::to_string(index); }
  const std::optional<std::string>& path() const { return path_; }

 private:
  explicit Pointer(std::optional<std::string> path) : path_(std::move(path)) {}
  std::optional<std::string> path_;
};

/// A number with its pointer.
std::string CountHtml(int value, const Pointer& at);
std::string FixedHtml(double value, const Pointer& at, int digits);
/// A dash where there is no value.
std::string FixedHtml(const std::optional<double>& value, const Pointer& at, int digits);

/// A rate: "93.3 %", and "42 of 45, 95 % interval by rounds 82.1 to 97.7 %", Wilson's where there
/// is none by rounds. A dash for n = 0.
std::string PercentHtml(const Rate& rate, const Pointer& at);
std::string RateDetailHtml(const Rate& rate, const Pointer& at);
/// Both behind each other, the second in small.
std::string RateHtml(const Rate& rate, const Pointer& at);

/// "<td class=n>..</td>".
std::string NumberCell(const std::string& html);

}  // namespace tubetwin

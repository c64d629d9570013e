#include "scenes/text_lines.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string Shown(std::string_view field) { return "'" + Printable(field.substr(0, 40)) + "'"; }

}  // namespace

TextLines::TextLines(std::string_view text, const std::string& source)
    : rest_(text), source_(source) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool TextLines::Next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line_ = rest_.substr(0, end);
    rest_ =
        rest_.substr(std::min(end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1), rest_.size()));
    ++number_;
    const std::size_t last = line_.find_last_not_of(" \t\v\f");
    line_ = line_.substr(0, last == std::string_view::npos ? 0 : last + 1);
    if (!line_.empty()) return true;
  }
  return false;
}

void TextLines::Need(const std::string& what) {
  if (!Next()) Fail("the file ends where " + what + " is needed");
}

void TextLines::Fail(const std::string& problem, int number) const {
  throw Error(ErrorKind::kBadData, source_ + ": line " +
                                       std::to_string(number > 0 ? number : number_) + ": " +
                                       Printable(problem));
}

double TextLines::AsNumber(std::string_view field, const std::string& name) const {
  const auto value = ParseNumber(field);
  if (!value || !std::isfinite(*value)) {
    Fail(name + " is " + Shown(field) + "; allowed: a finite number");
  }
  return *value;
}

int TextLines::AsInteger(std::string_view field, const std::string& name, int low, int high) const {
  const auto value = ParseNumber(field);
  if (!value || !(*value >= low && *value <= high) || *value != std::floor(*value)) {
    Fail(name + " is " + Shown(field) + "; allowed: a whole number from " + std::to_string(low) +
         " to " + std::to_string(high));
  }
  return static_cast<int>(*value);
}

}  // namespace tubetwin

#include "models/base/foreign/length_unit.h"

#include <algorithm>
#include <map>

#include "models/base/text.h"

namespace tubetwin {

const std::vector<std::string>& LengthUnits() {
  static const std::vector<std::string> units = {"m", "mm", "cm", "in"};
  return units;
}

std::optional<double> MetresPer(std::string_view unit) {
  static const std::map<std::string, double> known = {{"m", 1.0},
                                                      {"metre", 1.0},
                                                      {"meter", 1.0},
                                                      {"metres", 1.0},
                                                      {"meters", 1.0},
                                                      {"mm", 0.001},
                                                      {"millimetre", 0.001},
                                                      {"millimeter", 0.001},
                                                      {"millimetres", 0.001},
                                                      {"millimeters", 0.001},
                                                      {"cm", 0.01},
                                                      {"centimetre", 0.01},
                                                      {"centimeter", 0.01},
                                                      {"centimetres", 0.01},
                                                      {"centimeters", 0.01},
                                                      {"in", 0.0254},
                                                      {"inch", 0.0254},
                                                      {"inches", 0.0254}};
  const auto found = known.find(LowerCase(unit));
  return found == known.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> UnitOfComment(const std::vector<std::string_view>& words) {
  // One text without its separators, as it may be written with or without blanks.
  std::string text;
  for (const std::string_view word : words) text += std::string(word) + " ";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ':' || c == '='; }, ' ');
  const std::size_t begin = text.find_first_not_of(' ');
  const std::size_t end = text.find(' ', begin);
  if (begin == std::string::npos || end == std::string::npos) return std::nullopt;
  const std::string key = LowerCase(text.substr(begin, end - begin));
  if (key != "unit" && key != "units") return std::nullopt;
  const std::size_t first = text.find_first_not_of(' ', end);
  const std::size_t last = text.find_last_not_of(' ');
  if (first == std::string::npos) return std::nullopt;
  return MetresPer(std::string_view(text).substr(first, last + 1 - first));
}

}  // namespace tubetwin

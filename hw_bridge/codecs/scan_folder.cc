#include "hw_bridge/codecs/scan_folder.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

namespace tubetwin {
namespace {

constexpr std::size_t kDigits = 6, kMaxDigits = 18;  // 18 digits fit 64 bits.
constexpr std::string_view kTrigger = "trigger-", kScan = "scan-";

std::string Padded(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return std::string(kDigits - std::min(kDigits, digits.size()), '0') + digits;
}

std::optional<std::uint64_t> ParseNumber(std::string_view digits) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (digits.size() < kDigits || digits.size() > kMaxDigits ||
      !std::all_of(digits.begin(), digits.end(), is_digit)) {
    return std::nullopt;
  }
  std::uint64_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

}  // namespace

ScanFileName ParseScanFileName(std::string_view name) {
  using Kind = ScanFileName::Kind;
  if (name.empty() || name.front() == '.') return {};
  if (name.starts_with(kTrigger)) {
    if (const auto number = ParseNumber(name.substr(kTrigger.size()))) {
      return {Kind::kTrigger, *number};
    }
  }
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  std::string ending(name.substr(dot));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool cloud = ending == ".pcd" || ending == ".ply";
  if (!cloud && ending != ".error") return {};
  if (name.starts_with(kScan)) {
    if (const auto number = ParseNumber(name.substr(kScan.size(), dot - kScan.size()))) {
      return {cloud ? Kind::kScan : Kind::kRefusal, *number};
    }
  }
  return {cloud ? Kind::kSaved : Kind::kOther, 0};
}

std::string TriggerFileName(std::uint64_t number) { return std::string(kTrigger) + Padded(number); }

std::string ScanFileNameOf(std::uint64_t number, std::string_view ending) {
  return std::string(kScan) + Padded(number) + std::string(ending);
}

}  // namespace tubetwin

#include "twin/report/text.h"

#include <cstdint>
#include <cstdio>
#include <string_view>

#include "models/base/json.h"

namespace tubetwin {
namespace {

std::string DataHtml(const Json& value, const Pointer& at, const std::string& text) {
  if (!at.path()) return text;
  return "<data value=\"" + Escaped(value.dump()) + "\" data-at=\"" + Escaped(*at.path()) + "\">" +
         text + "</data>";
}

std::string IntervalHtml(const ShareInterval& interval, const Pointer& at) {
  return DataHtml(interval.low, at / 0, Fixed(100.0 * interval.low, 1)) + " to " +
         DataHtml(interval.high, at / 1, Fixed(100.0 * interval.high, 1)) + "&nbsp;%";
}

}  // namespace

std::string LinkTo(const std::string& path) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  const bool leads_away = path.starts_with('/') || path.starts_with("../");
  std::string out = leads_away ? "" : "./";
  for (const char c : path) {
    if (c == '/' && out == "/") continue;  // Two would begin the name of a host.
    if (kPlain.find(c) != std::string_view::npos) {
      out += c;
      continue;
    }
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(c));
    out += code;
  }
  return out;
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string ScriptJson(const Json& json) {
  // With only ASCII left, U+2028 and U+2029 are escaped already.
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else if (c == '>') {
      out += "\\u003e";
    } else if (c == '&') {
      out += "\\u0026";
    } else {
      out += c;
    }
  }
  return out;
}

std::string Base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> std::uint32_t {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
    };
    const std::uint32_t group = byte(0) << 16 | byte(1) << 8 | byte(2);
    const std::size_t left = bytes.size() - i;
    out += kDigits[group >> 18];
    out += kDigits[group >> 12 & 63];
    out += left > 1 ? kDigits[group >> 6 & 63] : '=';
    out += left > 2 ? kDigits[group & 63] : '=';
  }
  return out;
}

std::string Fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string Shown(const std::string& text) { return text.empty() ? kDash : Escaped(text); }

Pointer Pointer::operator/(const std::string& key) const {
  if (!path_) return Nowhere();
  return Pointer(*path_ + "/" + key);
}

std::string CountHtml(int value, const Pointer& at) {
  return DataHtml(value, at, std::to_string(value));
}

std::string FixedHtml(double value, const Pointer& at, int digits) {
  return DataHtml(value, at, Fixed(value, digits));
}

std::string FixedHtml(const std::optional<double>& value, const Pointer& at, int digits) {
  return value ? FixedHtml(*value, at, digits) : kDash;
}

std::string PercentHtml(const Rate& rate, const Pointer& at) {
  const auto [k, n] = rate.counts;
  if (n == 0) return kDash;
  const std::string share = Fixed(100.0 * k / n, 1);
  if (!at.path()) return share + "&nbsp;%";
  return "<span data-share=\"" + Escaped(*at.path()) + "\">" + share + "</span>&nbsp;%";
}

std::string RateDetailHtml(const Rate& rate, const Pointer& at) {
  const auto [k, n] = rate.counts;
  if (n == 0) return kDash;
  const bool by_rounds = rate.by_cluster.has_value();
  return CountHtml(k, at / "k") + " of " + CountHtml(n, at / "n") + ", 95&nbsp;% interval " +
         (by_rounds ? "by rounds " : "") +
         IntervalHtml(Interval95(rate), at / (by_rounds ? "cluster95" : "wilson95"));
}

std::string RateHtml(const Rate& rate, const Pointer& at) {
  return PercentHtml(rate, at) + " <span class=\"quiet\">" + RateDetailHtml(rate, at) + "</span>";
}

std::string NumberCell(const std::string& html) { return "<td class=\"n\">" + html + "</td>"; }

}  // namespace tubetwin

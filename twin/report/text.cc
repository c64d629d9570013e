#include "twin/report/text.h"

#include <cstdint>
#include <cstdio>

#include "models/base/json.h"

namespace tubetwin {
namespace {

std::string DataHtml(const Json& value, const std::string& pointer, const std::string& text) {
  return "<data value=\"" + Escaped(value.dump()) + "\" data-at=\"" + Escaped(pointer) + "\">" +
         text + "</data>";
}

std::string PercentHtml(const Json& summary, const std::string& pointer) {
  const Json& share = At(summary, pointer);
  if (!share.is_number()) return kDash;
  return DataHtml(share, pointer, Fixed(100.0 * share.get<double>(), 1));
}

}  // namespace

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

const Json& At(const Json& json, const std::string& pointer) {
  static const Json null;
  const Json::json_pointer at(pointer);
  return json.contains(at) ? json[at] : null;
}

std::string Fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string Fixed(const Json& value, int digits) {
  return value.is_number() ? Fixed(value.get<double>(), digits) : kDash;
}

std::string Shown(const Json& value) {
  if (value.is_null() || value == "") return kDash;
  if (value.is_string()) return Escaped(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return Escaped(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string CountHtml(const Json& summary, const std::string& pointer) {
  const Json& value = At(summary, pointer);
  if (!value.is_number_integer()) return kDash;
  return DataHtml(value, pointer, std::to_string(value.get<std::int64_t>()));
}

std::string FixedHtml(const Json& summary, const std::string& pointer, int digits) {
  const Json& value = At(summary, pointer);
  if (!value.is_number()) return kDash;
  return DataHtml(value, pointer, Fixed(value, digits));
}

std::string SharePercentHtml(const Json& summary, const std::string& pointer) {
  const Json& k = At(summary, pointer + "/k");
  const Json& n = At(summary, pointer + "/n");
  if (!k.is_number_integer() || !n.is_number_integer() || n == 0) return kDash;
  return "<span data-share=\"" + Escaped(pointer) + "\">" +
         Fixed(100.0 * k.get<double>() / n.get<double>(), 1) + "</span>&nbsp;%";
}

std::string ShareDetailHtml(const Json& summary, const std::string& pointer) {
  const Json& n = At(summary, pointer + "/n");
  if (!n.is_number_integer()) return kDash;
  std::string out =
      CountHtml(summary, pointer + "/k") + " of " + CountHtml(summary, pointer + "/n");
  if (n == 0 || !At(summary, pointer + "/wilson95").is_array()) return out;
  out += ", 95&nbsp;% interval " + PercentHtml(summary, pointer + "/wilson95/0") + " to " +
         PercentHtml(summary, pointer + "/wilson95/1") + "&nbsp;%";
  // A bootstrap over rounds that all agree is a point and says nothing (see ClusterBootstrap95).
  const Json& cluster = At(summary, pointer + "/cluster95");
  if (cluster.is_array() && cluster[0] != cluster[1]) {
    out += " <span class=\"nowrap\">(by rounds " + PercentHtml(summary, pointer + "/cluster95/0") +
           " to " + PercentHtml(summary, pointer + "/cluster95/1") + "&nbsp;%)</span>";
  }
  return out;
}

std::string NumberCell(const std::string& html) { return "<td class=\"n\">" + html + "</td>"; }

}  // namespace tubetwin

#include "hw_bridge/codecs/netft_config.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace tubetwin {
namespace {

constexpr std::size_t kMaxPage = 65536;

constexpr double kNewtonPerPound = 4.4482216152605;  // Exact, as are kgf and the inch.
constexpr double kNewtonPerKilogram = 9.80665;
constexpr double kMetrePerInch = 0.0254;

constexpr std::pair<const char*, double> kForceUnits[] = {
    {"N", 1.0},
    {"kN", 1000.0},
    {"lbf", kNewtonPerPound},
    {"lb", kNewtonPerPound},
    {"klbf", 1000.0 * kNewtonPerPound},
    {"klb", 1000.0 * kNewtonPerPound},
    {"kgf", kNewtonPerKilogram},
    {"kg", kNewtonPerKilogram},
    {"gf", 0.001 * kNewtonPerKilogram},
    {"g", 0.001 * kNewtonPerKilogram},
};
constexpr std::pair<const char*, double> kTorqueUnits[] = {
    {"N-m", 1.0},
    {"Nm", 1.0},
    {"N-mm", 0.001},
    {"Nmm", 0.001},
    {"kN-m", 1000.0},
    {"kNm", 1000.0},
    {"lbf-in", kNewtonPerPound* kMetrePerInch},
    {"lb-in", kNewtonPerPound* kMetrePerInch},
    {"lbf-ft", 12.0 * kNewtonPerPound* kMetrePerInch},
    {"lb-ft", 12.0 * kNewtonPerPound* kMetrePerInch},
    {"kgf-cm", 0.01 * kNewtonPerKilogram},
    {"kg-cm", 0.01 * kNewtonPerKilogram},
};

constexpr std::pair<const char*, char> kEntities[] = {
    {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''},
};

std::string Unescaped(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    bool found = false;
    for (const auto& [entity, letter] : kEntities) {
      if (!text.starts_with(entity)) continue;
      plain += letter;
      text.remove_prefix(std::string_view(entity).size());
      found = true;
      break;
    }
    if (found) continue;
    plain += text.front();
    text.remove_prefix(1);
  }
  return plain;
}

std::string Escaped(std::string_view text) {
  std::string xml;
  for (const char letter : text) {
    const char* entity = nullptr;
    for (const auto& [name, meant] : kEntities) {
      if (letter == meant) entity = name;
    }
    const auto code = static_cast<unsigned char>(letter);
    if (entity != nullptr) {
      xml += entity;
    } else {
      xml += code < 0x20 || code == 0x7f ? '?' : letter;
    }
  }
  return xml;
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

/// What stands between the first <tag> and the next </tag>.
std::optional<std::string> TextOf(std::string_view xml, const std::string& tag) {
  const std::string open = "<" + tag + ">", close = "</" + tag + ">";
  const std::size_t begin = xml.find(open);
  if (begin == std::string_view::npos) return std::nullopt;
  const std::size_t from = begin + open.size();
  const std::size_t end = xml.find(close, from);
  if (end == std::string_view::npos) return std::nullopt;
  return Unescaped(Trimmed(xml.substr(from, end - from)));
}

std::optional<double> NumberOf(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Runstat is written in base 16, with or without "0x".
std::optional<std::uint32_t> HexOf(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, 16);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// A positive number under `tag`, or what is wrong.
std::optional<DecodeError> ReadPositive(std::string_view xml, const std::string& tag,
                                        double& value) {
  const std::optional<std::string> text = TextOf(xml, tag);
  if (!text) return DecodeError{"there is no <" + tag + ">"};
  const std::optional<double> number = NumberOf(*text);
  if (!number || *number <= 0.0) {
    return DecodeError{"<" + tag + "> is \"" + text->substr(0, 40) +
                       "\"; allowed: a positive number"};
  }
  value = *number;
  return std::nullopt;
}

template <std::size_t N>
std::variant<double, DecodeError> UnitOf(const std::pair<const char*, double> (&units)[N],
                                         const std::string& unit, const char* of) {
  std::string allowed;
  for (const auto& [name, si] : units) {
    if (unit == name) return si;
    allowed += allowed.empty() ? name : std::string(", ") + name;
  }
  return DecodeError{std::string(of) + " unit \"" + unit.substr(0, 40) + "\"; allowed: " + allowed};
}

/// Shortest text without an exponent that reads back as the same number.
std::string NumberText(double value) {
  char text[400];  // The longest double has 309 digits before its point.
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed);
  return std::string(text, error == std::errc() ? end : text);
}

/// A page of one element of elements.
class PageWriter {
 public:
  explicit PageWriter(const std::string& root)
      : xml_("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<" + root + ">\n"), root_(root) {}
  void Put(const char* tag, const std::string& text) {
    xml_ += std::string("  <") + tag + ">" + Escaped(text) + "</" + tag + ">\n";
  }
  std::string Page() const { return xml_ + "</" + root_ + ">\n"; }

 private:
  std::string xml_, root_;
};

}  // namespace

std::variant<NetftPage, DecodeError> DecodeNetftPage(std::string_view xml) {
  if (xml.size() > kMaxPage) {
    return DecodeError{"a page of " + std::to_string(xml.size()) + " bytes; allowed: 65536"};
  }
  NetftPage page;
  page.product = TextOf(xml, "prodname").value_or("");
  page.configuration = TextOf(xml, "cfgnam").value_or("");
  page.serial = TextOf(xml, "cfgcalsn").value_or("");
  page.ratings = TextOf(xml, "cfgmr").value_or("");
  if (auto error = ReadPositive(xml, "cfgcpf", page.counts_per_force)) return *error;
  if (auto error = ReadPositive(xml, "cfgcpt", page.counts_per_torque)) return *error;
  const std::optional<std::string> force = TextOf(xml, "scfgfu"), torque = TextOf(xml, "scfgtu");
  if (!force) return DecodeError{"there is no <scfgfu>"};
  if (!torque) return DecodeError{"there is no <scfgtu>"};
  page.force_unit = *force;
  page.torque_unit = *torque;
  if (TextOf(xml, "comrdtrate")) {
    if (auto error = ReadPositive(xml, "comrdtrate", page.rate_Hz)) return *error;
  }
  if (const std::optional<std::string> text = TextOf(xml, "runstat")) {
    const std::optional<std::uint32_t> status = HexOf(*text);
    if (!status) {
      return DecodeError{"<runstat> is \"" + text->substr(0, 40) +
                         "\"; allowed: 32 bits in base 16"};
    }
    page.status = *status;
  }
  return page;
}

std::string EncodeNetftPage(const NetftPage& page) {
  PageWriter xml("netft");
  xml.Put("prodname", page.product);
  char status[16];
  std::snprintf(status, sizeof status, "0x%08x", page.status);
  xml.Put("runstat", status);
  xml.Put("setcfgsel", "0");
  xml.Put("setserial", page.serial);
  xml.Put("cfgnam", page.configuration);
  xml.Put("cfgcalsel", "0");
  xml.Put("cfgcalsn", page.serial);
  xml.Put("scfgfu", page.force_unit);
  xml.Put("scfgtu", page.torque_unit);
  xml.Put("cfgcpf", NumberText(page.counts_per_force));
  xml.Put("cfgcpt", NumberText(page.counts_per_torque));
  xml.Put("cfgmr", page.ratings);
  xml.Put("comrdte", "Enabled");
  if (page.rate_Hz > 0.0) xml.Put("comrdtrate", NumberText(page.rate_Hz));
  return xml.Page();
}

std::string EncodeNetftCalibrationPage(const NetftPage& page) {
  PageWriter xml("netftCalibration");
  xml.Put("calsn", page.serial);
  xml.Put("calpn", page.configuration);
  xml.Put("scalfu", page.force_unit);
  xml.Put("scaltu", page.torque_unit);
  xml.Put("calcpf", NumberText(page.counts_per_force));
  xml.Put("calcpt", NumberText(page.counts_per_torque));
  xml.Put("calmr", page.ratings);
  return xml.Page();
}

std::variant<RdtScale, DecodeError> ScaleOf(const NetftPage& page) {
  const auto force = UnitOf(kForceUnits, page.force_unit, "force");
  if (const auto* error = std::get_if<DecodeError>(&force)) return *error;
  const auto torque = UnitOf(kTorqueUnits, page.torque_unit, "torque");
  if (const auto* error = std::get_if<DecodeError>(&torque)) return *error;
  return RdtScale{page.counts_per_force / std::get<double>(force),
                  page.counts_per_torque / std::get<double>(torque)};
}

}  // namespace tubetwin

#include <cmath>
#include <cstdio>
#include <sstream>

#include "models/base/config/config.h"
#include "models/base/config/config_entries.h"
#include "models/base/config/config_layers.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using config_internal::AllowedText;
using config_internal::Below;
using config_internal::DescribeFields;
using config_internal::Entry;
using config_internal::IsBareKey;

std::string TomlText(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", byte);
      out += escape;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string TomlKey(const std::string& key) { return IsBareKey(key) ? key : TomlText(key); }

std::string TomlNumber(double value) {
  TT_CHECK(std::isfinite(value));  // The reader refuses anything else.
  std::string out = Number(value);
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

std::string TomlValue(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  if (value.is_number()) return TomlNumber(value.get<double>());
  if (value.is_string()) return TomlText(value.get<std::string>());
  std::vector<std::string> items;
  for (const Json& item : value) items.push_back(TomlValue(item));
  return "[" + Join(items) + "]";
}

void WriteComment(const Entry& entry, std::ostringstream& out) {
  std::string doc = entry.doc;
  if (entry.type == Entry::Type::kChoice) doc += " One of: " + Join(entry.choices) + ".";
  if (std::isfinite(entry.allowed.low) || std::isfinite(entry.allowed.high)) {
    doc += " Allowed: " + AllowedText(entry.allowed) + ".";
  }
  std::istringstream lines(doc);
  for (std::string line; std::getline(lines, line);) out << "# " << line << "\n";
}

/// Fields first, sections after: in TOML a field behind a table header belongs to that table.
void WriteEntries(const Entry& section, const std::string& path, bool with_docs,
                  std::ostringstream& out) {
  for (const Entry& entry : section.children) {
    if (entry.type == Entry::Type::kSection) continue;
    if (with_docs) WriteComment(entry, out);
    out << TomlKey(entry.key) << " = " << TomlValue(entry.value) << "\n";
  }
  for (const Entry& entry : section.children) {
    if (entry.type != Entry::Type::kSection) continue;
    const std::string below = Below(path, TomlKey(entry.key));
    if (out.tellp() > 0) out << "\n";
    if (with_docs) WriteComment(entry, out);
    out << "[" << below << "]\n";
    WriteEntries(entry, below, with_docs, out);
  }
}

void AddLimits(Range allowed, bool whole, Json& schema) {
  const auto limit = [whole](double value) {
    return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  if (std::isfinite(allowed.low)) schema["minimum"] = limit(allowed.low);
  if (std::isfinite(allowed.high)) schema["maximum"] = limit(allowed.high);
}

Json Schema(const Entry& entry) {
  Json out;
  if (!entry.doc.empty()) out["description"] = entry.doc;
  switch (entry.type) {
    case Entry::Type::kBool:
      out["type"] = "boolean";
      break;
    case Entry::Type::kInteger:
      out["type"] = "integer";
      AddLimits(entry.allowed, true, out);
      break;
    case Entry::Type::kNumber:
      out["type"] = "number";
      AddLimits(entry.allowed, false, out);
      break;
    case Entry::Type::kText:
      out["type"] = "string";
      break;
    case Entry::Type::kChoice:
      out["enum"] = entry.choices;
      break;
    case Entry::Type::kNumbers:
    case Entry::Type::kTexts:
      out["type"] = "array";
      out["items"]["type"] = entry.type == Entry::Type::kTexts ? "string" : "number";
      AddLimits(entry.allowed, false, out["items"]);
      if (entry.count > 0) out["minItems"] = out["maxItems"] = entry.count;
      break;
    case Entry::Type::kSection:
      out["type"] = "object";
      out["additionalProperties"] = false;
      out["properties"] = Json::object();
      for (const Entry& child : entry.children) out["properties"][child.key] = Schema(child);
      return out;
  }
  out["default"] = entry.value;
  return out;
}

Json Values(const Entry& section) {
  Json out = Json::object();
  for (const Entry& entry : section.children) {
    out[entry.key] = entry.type == Entry::Type::kSection ? Values(entry) : entry.value;
  }
  return out;
}

}  // namespace

std::string WriteToml(const std::function<void(ConfigVisitor&)>& visit, bool with_docs) {
  std::ostringstream out;
  WriteEntries(DescribeFields(visit), "", with_docs, out);
  return std::move(out).str();
}

std::string WriteConfigJson(const std::function<void(ConfigVisitor&)>& visit) {
  return Values(DescribeFields(visit)).dump();
}

std::string WriteConfigSchema(const std::function<void(ConfigVisitor&)>& visit) {
  Json out;
  out["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  out.update(Schema(DescribeFields(visit)));
  return out.dump(2) + "\n";
}

}  // namespace tubetwin

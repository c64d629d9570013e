#include "models/files/file_schema.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/files/model_schema.h"
#include "models/part.h"

namespace tubetwin {
namespace {

bool IsAllowed(const Json& value, const Json& schema) {
  if (schema.contains("enum")) {
    const Json& allowed = schema["enum"];
    return std::find(allowed.begin(), allowed.end(), value) != allowed.end();
  }
  if (value.is_null() || value == "") return false;  // JSON writes kNotGiven as null.
  if (value.is_array()) {
    return std::all_of(value.begin(), value.end(),
                       [&](const Json& item) { return IsAllowed(item, schema["items"]); });
  }
  return !schema.contains("minimum") || value >= schema["minimum"];
}

/// Whether the key must be given: a default that is none is taken out.
bool RequireWhatHasNoDefault(Json& schema) {
  if (!schema.contains("properties")) {
    if (IsAllowed(schema["default"], schema)) return false;
    schema.erase("default");
    return true;
  }
  Json required = Json::array();
  for (auto& [key, entry] : schema["properties"].items()) {
    if (RequireWhatHasNoDefault(entry)) required.push_back(key);
  }
  if (required.empty()) return false;
  schema["required"] = std::move(required);
  return true;
}

struct Kind {
  const char* name;
  Json (*schema)();
};

Json PartFileSchema() {
  Part part;
  part.name.clear();
  return TableSchema([&part](ConfigVisitor& v) { part.Visit(v); });
}

constexpr Kind kKinds[] = {{"cell", CellFileSchema},       {"arm", ArmFileSchema},
                           {"gripper", GripperFileSchema}, {"wrist", WristFileSchema},
                           {"scanner", ScannerFileSchema}, {"part", PartFileSchema}};

}  // namespace

Json TableSchema(const std::function<void(ConfigVisitor&)>& visit) {
  Json schema = Json::parse(WriteConfigSchema(visit));
  schema.erase("$schema");
  RequireWhatHasNoDefault(schema);
  return schema;
}

void AddTables(const std::string& key, const std::string& doc, Json table, int min_count,
               int max_count, Json& schema) {
  Json& list = schema["properties"][key];
  list = Json{{"description", doc}, {"type", "array"}, {"items", std::move(table)}};
  if (max_count > 0) list["maxItems"] = max_count;
  if (min_count > 0) list["minItems"] = min_count;
  Json& required = schema["required"];
  const auto known = std::find(required.begin(), required.end(), key);
  if (min_count > 0 && known == required.end()) required.push_back(key);
}

std::vector<std::string> ModelFileKinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::string ModelFileSchema(const std::string& kind) {
  for (const Kind& known : kKinds) {
    if (known.name != kind) continue;
    Json out;
    out["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    out.update(known.schema());
    return out.dump(2) + "\n";
  }
  throw Error(ErrorKind::kUsage,
              "no kind of model file is named '" + kind + "'; allowed: " + Join(ModelFileKinds()));
}

}  // namespace tubetwin

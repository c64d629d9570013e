#include "models/files/model_schema.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/cell_model.h"
#include "models/model_file.h"
#include "models/part.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

/// What the reader of a kind of file says about a text; empty when it takes it.
std::string Refusal(const std::string& kind, const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder / "own.toml";
  WriteFileAtomically(path, text);
  try {
    if (kind == "cell") LoadCellModel(path);
    if (kind == "arm") LoadArm(path);
    if (kind == "gripper") ReadGripper(OpenModelFile("grippers", path, kind));
    if (kind == "wrist") ReadWrist(OpenModelFile("wrists", path, kind));
    if (kind == "scanner") ReadScanner(OpenModelFile("scanners", path, kind));
    if (kind == "part") LoadPart(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The text without `key = value` in its table ("" is the top), the first where there are several;
/// the text itself where the key is not there.
std::string Without(const std::string& text, const std::string& table, const std::string& key) {
  const std::string head = table.empty() ? "" : "[" + table + "]";
  const std::size_t begin = text.find(head) + head.size();
  const std::size_t line = text.find("\n" + key + " = ", begin);
  const std::size_t end_of_table = text.find("\n[", begin);
  if (line == std::string::npos || line > end_of_table) return text;
  std::size_t end = text.find('\n', line + 1);  // Of the value: lists may take several lines.
  const auto open = [&] {
    const std::string value = text.substr(line, end - line);
    return std::count(value.begin(), value.end(), '[') >
           std::count(value.begin(), value.end(), ']');
  };
  while (open()) end = text.find('\n', end + 1);
  return text.substr(0, line) + text.substr(end);
}

/// Every key that a table's schema requires is one that the reader misses.
void CheckRequired(const std::string& kind, const Json& schema, const std::string& table,
                   const std::string& text) {
  if (!schema.contains("required")) return;
  for (const Json& required : schema["required"]) {
    const auto key = required.get<std::string>();
    const Json& entry = schema["properties"][key];
    INFO(kind << " [" << table << "] " << key);
    if (entry.contains("properties") || entry.contains("minItems")) continue;  // tables
    const std::string less = Without(text, table, key);
    REQUIRE(less != text);
    CHECK_THAT(Refusal(kind, less), Contains(key));
  }
}

/// Every key of a schema says what it is, and has a type.
void CheckExplained(const Json& schema) {
  for (const auto& [key, entry] : schema["properties"].items()) {
    INFO(key);
    CHECK(entry.contains("description"));
    CHECK((entry.contains("type") || entry.contains("enum")));
    if (entry.contains("properties")) CheckExplained(entry);
    if (entry.contains("items") && entry["items"].contains("properties")) {
      CheckExplained(entry["items"]);
    }
  }
}

TEST_CASE("The schema of a model file requires what its reader requires", "[unit]") {
  const std::string kind =
      GENERATE(as<std::string>{}, "cell", "arm", "gripper", "wrist", "scanner");
  const Json schema = Json::parse(ModelFileSchema(kind));
  const std::string folder = kind + "s";
  for (const std::string& name : ModelFileNames(folder)) {
    INFO(name);
    const std::string text = OpenModelFile(folder, name, kind).text;
    REQUIRE(Refusal(kind, text).empty());
    CheckRequired(kind, schema, "", text);
    for (const auto& [key, entry] : schema["properties"].items()) {
      if (entry.contains("properties")) CheckRequired(kind, entry, key, text);
      const bool tables = entry.contains("items") && entry["items"].contains("properties");
      if (tables && text.find("[[" + key + "]]") != std::string::npos) {
        CheckRequired(kind, entry["items"], key, text);
      }
    }
  }
}

TEST_CASE("Every key of every model file is explained in its schema", "[unit]") {
  CHECK(ModelFileKinds().size() == 6);
  for (const std::string& kind : ModelFileKinds()) {
    INFO(kind);
    CheckExplained(Json::parse(ModelFileSchema(kind)));
  }
  const Json part = Json::parse(ModelFileSchema("part"));
  CHECK(part["properties"]["radius_m"]["minimum"] == 0.003);
  CHECK(part["properties"]["search"]["properties"].contains("extra_per_m"));
  const Json cell = Json::parse(ModelFileSchema("cell"));
  CHECK(cell["properties"]["tool"]["properties"]["X_FK"]["minItems"] == 7);
  CHECK_FALSE(cell["properties"]["tool"]["properties"]["X_FK"].contains("default"));
  CHECK(cell["properties"]["keep_out"]["items"]["properties"]["yaw_deg"]["default"] == 0.0);
  CHECK_THROWS_WITH(ModelFileSchema("bin"), Contains("'bin'") && Contains("gripper"));
}

}  // namespace
}  // namespace tubetwin

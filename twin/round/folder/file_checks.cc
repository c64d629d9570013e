#include "twin/round/folder/file_checks.h"

#include <algorithm>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

Json CheckOf(const std::string& name, const std::string& content) {
  Json out{{"bytes", content.size()}};
  if (name.ends_with(".jsonl")) out["rows"] = std::count(content.begin(), content.end(), '\n');
  out["check"] = Fingerprint(content);
  return out;
}

[[noreturn]] void FailDamaged(const std::string& file, const std::string& found) {
  throw Error(ErrorKind::kBadData,
              file + ": is not what was written: " + found +
                  "\nby the manifest.json beside it; merge the shards or run the round again");
}

/// "11 rows against 12", or of what else differs first.
std::string DifferenceOfChecks(const Json& found, const Json& written) {
  for (const char* key : {"rows", "bytes", "check"}) {
    if (!written.contains(key) || !found.contains(key) || found[key] == written[key]) continue;
    const std::string name = key;
    return name == "check" ? "check sum " + found[key].dump() + " against " + written[key].dump()
                           : found[key].dump() + " " + name + " against " + written[key].dump();
  }
  return "";
}

}  // namespace

Json FileChecks(const std::string& folder, const std::vector<std::string>& checked,
                const std::vector<std::string>& named_only) {
  Json out = Json::object();
  for (const std::string& name : named_only) out[name] = nullptr;
  for (const std::string& name : checked) {
    out[name] = CheckOf(name, ReadFile((fs::path(folder) / name).string()));
  }
  return out;
}

void RequireWholeFiles(const std::string& folder, const std::vector<std::string>& required,
                       bool always) {
  const std::string manifest = (fs::path(folder) / "manifest.json").string();
  const Json document = fs::exists(manifest) ? ReadJsonFile(manifest) : Json::object();
  const auto told = JsonView(document, manifest).Optional("files");
  const Json files = told ? document["files"] : Json::object();
  if (!files.is_object()) {
    throw Error(ErrorKind::kBadData, manifest + ": files: an object is needed");
  }
  for (const std::string& name : required) {
    if (!always || (files.contains(name) && !files[name].is_null())) continue;
    throw Error(ErrorKind::kBadData, manifest + ": is missing or does not say what " + name +
                                         " holds; merge the shards again");
  }
  for (const auto& [name, written] : files.items()) {
    if (written.is_null()) continue;
    if (!written.is_object()) {
      throw Error(ErrorKind::kBadData, manifest + ": files." + name + ": an object is needed");
    }
    const std::string file = (fs::path(folder) / name).string();
    if (!fs::exists(file)) {
      if (std::find(required.begin(), required.end(), name) == required.end()) continue;
      FailDamaged(file, "it is missing");
    }
    const std::string difference = DifferenceOfChecks(CheckOf(name, ReadFile(file)), written);
    if (!difference.empty()) FailDamaged(file, difference);
  }
}

}  // namespace tubetwin

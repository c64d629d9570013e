#include "twin/round/folder/result_folder.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/round/folder/file_checks.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr char kManifestFile[] = "manifest.json";
constexpr char kLockFile[] = ".lock";

bool IsThere(const fs::path& file) {
  std::error_code
      ignored;  // What cannot be looked at cannot be written either, which is told then.
  return fs::exists(fs::symlink_status(file, ignored));
}

/// Names that lead nowhere else than into the folder.
bool IsInside(const fs::path& name) {
  return !name.empty() && name.is_relative() &&
         std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

/// Whether a folder on the way to the name is a link: what lies behind it was not written by this
/// program, whatever its name.
bool LeadsAway(const fs::path& folder, const fs::path& name) {
  std::error_code ignored;  // Not there: it leads nowhere.
  fs::path at = folder;
  for (const fs::path& part : name.parent_path()) {
    at /= part;
    if (fs::is_symlink(fs::symlink_status(at, ignored))) return true;
  }
  return false;
}

/// What the manifest of an earlier call of `verb` names, itself included; nothing when there is no
/// such manifest.
std::set<std::string> NamedBefore(const fs::path& folder, const std::string& verb) {
  std::set<std::string> out;
  const fs::path file = folder / kManifestFile;
  if (!fs::is_regular_file(fs::symlink_status(file))) return out;
  const Json manifest = Json::parse(ReadFile(file.string()), nullptr, /*allow_exceptions=*/false);
  if (!manifest.is_object() || manifest.value("verb", Json()) != verb) return out;
  const Json files = manifest.value("files", Json());
  if (!files.is_object()) return out;
  for (const auto& [name, check] : files.items()) {
    if (IsInside(name)) out.insert(name);
  }
  out.insert(kManifestFile);
  return out;
}

}  // namespace

ResultFolder::ResultFolder(const std::string& path, Claim claim)
    : path_(path), verb_(std::move(claim.verb)), names_(claim.names.begin(), claim.names.end()) {
  MakeFolder(path);
  const fs::path folder(path);
  lock_ = FileLock::TryTake((folder / kLockFile).string(), 0.0);
  if (!lock_) {
    throw Error(ErrorKind::kCannotCreate, path + ": is being filled by " +
                                              ReadFile((folder / kLockFile).string()) +
                                              "; wait for it to end, or give another --out");
  }
  lock_->RemoveAtEnd();
  lock_->Sign();
  names_.insert(kManifestFile);
  if (IsThere(folder / "campaign.json")) {
    throw Error(ErrorKind::kCannotCreate, path + ": holds a campaign; give another --out");
  }
  earlier_ = NamedBefore(folder, verb_);
  for (const std::string& name : names_) {
    if (claim.force || earlier_.count(name) > 0 || !IsThere(folder / name)) continue;
    throw Error(ErrorKind::kCannotCreate,
                path + ": holds " + name + ", which no `tubetwin " + verb_ +
                    "` wrote there as far as its manifest.json tells; give another --out" +
                    (verb_ == "run" ? ", or --force to replace it" : ""));
  }
}

void ResultFolder::Begin(const std::vector<std::string>& replaced) {
  const fs::path folder(path_);
  std::set<std::string> folders;
  std::error_code ignored;  // Gone already, or in the way: then writing says so.
  for (const std::string& name : earlier_) {
    // Until the new manifest is there the old one says whose the rest is.
    if (name == kManifestFile || LeadsAway(folder, name)) continue;
    if (std::find(replaced.begin(), replaced.end(), name) != replaced.end()) continue;
    if (fs::is_directory(fs::symlink_status(folder / name, ignored))) {
      folders.insert(name);
    } else {
      fs::remove(folder / name, ignored);
    }
    for (fs::path above = fs::path(name).parent_path(); !above.empty();
         above = above.parent_path()) {
      folders.insert(above.string());
    }
  }
  // From below: what still holds something is somebody's and stays.
  for (auto at = folders.rbegin(); at != folders.rend(); ++at) fs::remove(folder / *at, ignored);
  WriteNames();
}

void ResultFolder::Add(const std::vector<std::string>& names) {
  names_.insert(names.begin(), names.end());
  WriteNames();
}

void ResultFolder::End(Json manifest, const std::vector<std::string>& named_only) {
  std::vector<std::string> checked, named = named_only;
  for (const std::string& name : names_) {
    if (name == kManifestFile) continue;
    const std::string ending = fs::path(name).extension().string();
    const bool drawn = ending == ".jpg" || ending == ".mp4" ||
                       std::find(named.begin(), named.end(), name) != named.end();
    const bool is_file = fs::is_regular_file(fs::path(path_) / name);
    (is_file && !drawn ? checked : named).push_back(name);
  }
  manifest["verb"] = verb_;
  manifest["ended"] = true;
  manifest["files"] = FileChecks(path_, checked, named);
  WriteJsonFile(manifest, (fs::path(path_) / kManifestFile).string());
}

void ResultFolder::WriteNames() const {
  Json files = Json::object();
  for (const std::string& name : names_) {
    if (name != kManifestFile) files[name] = nullptr;
  }
  WriteJsonFile(
      Json{{"schema", "tubetwin/manifest/1"}, {"verb", verb_}, {"ended", false}, {"files", files}},
      (fs::path(path_) / kManifestFile).string());
}

}  // namespace tubetwin

#include "models/model_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/text.h"
#include "models/files/embedded.h"

namespace tubetwin {
namespace {

constexpr char kSuffix[] = ".toml";

bool IsFileName(const std::string& name) { return name.ends_with(kSuffix); }

/// Finds the first field that was not given.
class GivenVisitor : public ConfigVisitor {
 public:
  explicit GivenVisitor(std::string path) : path_(std::move(path)) {}

  void Field(const char*, const char*, bool&) override {}
  void Field(const char*, const char*, std::int64_t&, Range) override {}
  void Field(const char* key, const char* doc, double& value, Range) override {
    if (std::isnan(value)) Fail(key, doc);
  }
  void Field(const char* key, const char* doc, std::string& value) override {
    if (value.empty()) Fail(key, doc);
  }
  void Choice(const char* key, const char* doc, std::string& value,
              const std::vector<std::string>&) override {
    if (value.empty()) Fail(key, doc);
  }
  void Field(const char* key, const char* doc, std::vector<double>& value, int, Range) override {
    if (std::any_of(value.begin(), value.end(), [](double x) { return std::isnan(x); })) {
      Fail(key, doc);
    }
  }
  void Field(const char*, const char*, std::vector<std::string>&) override {}
  void Section(const char* key, const char*,
               const std::function<void(ConfigVisitor&)>& visit) override {
    const std::string above = section_;
    section_ += std::string(key) + ".";
    visit(*this);
    section_ = above;
  }
  using ConfigVisitor::Field;
  using ConfigVisitor::Section;

 private:
  [[noreturn]] void Fail(const char* key, const char* doc) const {
    throw Error(ErrorKind::kConfig,
                path_ + ": " + section_ + key + " is missing; it has no default: " + doc);
  }
  std::string path_, section_;
};

}  // namespace

const double kNotGiven = std::numeric_limits<double>::quiet_NaN();

ConfigSource ModelFile::Source() const {
  ConfigSource source;
  source.AddText(text, path);
  return source;
}

ModelFile OpenModelFile(const std::string& folder, const std::string& name_or_path,
                        const std::string& what) {
  if (IsFileName(name_or_path)) return {name_or_path, ReadFile(name_or_path), false};
  const std::string path = folder + "/" + name_or_path + kSuffix;
  for (const EmbeddedText& file : EmbeddedTexts()) {
    if (file.path == path) return {"models/" + path, std::string(file.text), true};
  }
  const std::vector<std::string> names = ModelFileNames(folder);
  throw Error(ErrorKind::kMissing, "no " + what + " is named '" + name_or_path + "'; nearest is '" +
                                       NearestName(name_or_path, names) +
                                       "'; known: " + Join(names) + ", or the path of a " + what +
                                       " file (.toml)");
}

std::vector<std::string> ModelFileNames(const std::string& folder) {
  std::vector<std::string> names;
  for (const EmbeddedText& file : EmbeddedTexts()) {
    const std::string path(file.path);
    if (!path.starts_with(folder + "/") || !IsFileName(path)) continue;
    const std::size_t begin = folder.size() + 1;
    names.push_back(path.substr(begin, path.size() - begin - (sizeof(kSuffix) - 1)));
  }
  std::sort(names.begin(), names.end());
  return names;
}

void RequireGiven(const std::function<void(ConfigVisitor&)>& visit, const std::string& path) {
  GivenVisitor given(path);
  visit(given);
}

void RefuseFile(const std::string& path, const std::string& problem) {
  throw Error(ErrorKind::kConfig, path + ": " + problem);
}

void RefuseKey(const ConfigSource& source, const std::string& key, const std::string& problem) {
  const std::string at = source.PlaceOf(key);
  RefuseFile(at.empty() ? source.place() : at, problem);
}

}  // namespace tubetwin

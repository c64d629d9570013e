#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tubetwin {

/// Closed interval of allowed values.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// Visits the fields of a configuration struct. Each struct has defaults at its members and one
/// template-free `void Visit(ConfigVisitor&)` that lists them once; reading, writing, the schema
/// and validation all go through that list.
class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;
  virtual void Field(const char* key, const char* doc, bool& value) = 0;
  virtual void Field(const char* key, const char* doc, std::int64_t& value, Range allowed = {}) = 0;
  virtual void Field(const char* key, const char* doc, double& value, Range allowed = {}) = 0;
  virtual void Field(const char* key, const char* doc, std::string& value) = 0;
  /// One of `allowed`.
  virtual void Choice(const char* key, const char* doc, std::string& value,
                      const std::vector<std::string>& allowed) = 0;
  /// A list of numbers; `count` 0 means any length.
  virtual void Field(const char* key, const char* doc, std::vector<double>& value, int count = 0,
                     Range allowed = {}) = 0;
  virtual void Field(const char* key, const char* doc, std::vector<std::string>& value) = 0;
  /// `count` numbers, or none: an empty list.
  virtual void NumbersOrNone(const char* key, const char* doc, std::vector<double>& value,
                             int /*count*/, Range allowed = {}) {
    Field(key, doc, value, 0, allowed);
  }
  /// Seven numbers, x y z and a quaternion w x y z of length 1 (within 0.001), or none.
  void PoseOrNone(const char* key, const char* doc, std::vector<double>& value,
                  Range allowed = {}) {
    NumbersOrNone(key, doc, value, 7, allowed);
    CheckPose(key, value);
  }
  /// The same seven, where none is no pose.
  void Pose(const char* key, const char* doc, std::array<double, 7>& value, Range allowed = {}) {
    Field(key, doc, value, allowed);
    CheckPose(key, {value.begin(), value.end()});
  }
  /// The name of a file. One that is relative in a file is relative to that file's folder, one of
  /// an override to the working directory; what is read is relative to the working directory.
  virtual void File(const char* key, const char* doc, std::string& value) {
    Field(key, doc, value);
  }
  /// A name, or a file as above when it ends in ".toml".
  virtual void NameOrFile(const char* key, const char* doc, std::string& value) {
    Field(key, doc, value);
  }
  /// Files as above; empty texts stay empty.
  virtual void Files(const char* key, const char* doc, std::vector<std::string>& value) {
    Field(key, doc, value);
  }
  /// A table below this one.
  virtual void Section(const char* key, const char* doc,
                       const std::function<void(ConfigVisitor&)>& visit) = 0;

  void Field(const char* key, const char* doc, int& value, Range allowed = {}) {
    std::int64_t wide = value;
    if (allowed.low < -2147483648.0) allowed.low = -2147483648.0;
    if (allowed.high > 2147483647.0) allowed.high = 2147483647.0;
    Field(key, doc, wide, allowed);
    value = static_cast<int>(wide);
  }
  template <std::size_t N>
  void Field(const char* key, const char* doc, std::array<double, N>& value, Range allowed = {}) {
    std::vector<double> list(value.begin(), value.end());
    Field(key, doc, list, static_cast<int>(N), allowed);
    for (std::size_t i = 0; i < N; ++i) value[i] = list[i];
  }
  template <class Config>
  void Section(const char* key, const char* doc, Config& config) {
    Section(key, doc,
            std::function<void(ConfigVisitor&)>([&config](ConfigVisitor& v) { config.Visit(v); }));
  }

 protected:
  /// For readers, which know where the numbers stand.
  virtual void CheckPose(const char* /*key*/, const std::vector<double>& /*xyz_wxyz*/) {}
};

/// TOML layers: files, then `a.b=value` texts, each overriding the ones before.
class ConfigSource {
 public:
  ConfigSource();
  ~ConfigSource();
  ConfigSource(ConfigSource&&) noexcept;
  ConfigSource& operator=(ConfigSource&&) noexcept;

  /// Throws Error(kMissing) or, for bad syntax, Error(kConfig) with file:line:column.
  void AddFile(const std::string& path);
  /// "planner.exclude_free=true"; a value that is no TOML is taken as a text.
  void AddOverride(const std::string& text);
  /// TOML text under a name used in errors.
  void AddText(const std::string& toml, const std::string& name);

  /// Sets the fields of a config from the layers. Throws Error(kConfig) for an unknown key (naming
  /// the nearest), a wrong type or a value outside its range, with file:line:column.
  template <class Config>
  void ReadInto(Config& config) const {
    Read([&config](ConfigVisitor& v) { config.Visit(v); });
  }
  void Read(const std::function<void(ConfigVisitor&)>& visit) const;

  /// The tables of `[[key]]`, taken out of the layers, each a source of its own; none when the key
  /// is absent. Throws Error(kConfig) when it is no list of tables.
  std::vector<ConfigSource> TakeTables(const std::string& key);
  /// The table `key = {a.b = 1}`, taken out; a quoted "a.b" means the same. Empty when absent.
  /// Throws Error(kConfig) when it is no table.
  ConfigSource TakeTable(const std::string& key);
  /// Moves a top-level key to `path` ("pile.part") of another source with the place that messages
  /// name; nothing when absent. Throws Error(kConfig) when `to` has that path already.
  void MoveKey(const std::string& key, ConfigSource& to, const std::string& path);

  /// The grid that lists span: one source per combination, the last key fastest. A list of values
  /// where the field takes one, or a list of lists where it takes a list, spans; all else is kept.
  std::vector<ConfigSource> ExpandLists(const std::function<void(ConfigVisitor&)>& visit) const;

  /// "file:line:column" of a key of the top level; empty when no layer has it.
  std::string PlaceOf(const std::string& key) const;
  /// Where the whole begins: the first layer's name, or the place of the table that it was taken
  /// from.
  const std::string& place() const;

  /// Every key ("a.b") with its value as a person writes it, tables in order.
  std::vector<std::pair<std::string, std::string>> Texts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The config as TOML text, every key with its value; with `with_docs` each key under its comment.
std::string WriteToml(const std::function<void(ConfigVisitor&)>& visit, bool with_docs);

/// The config as JSON text, nested as its tables are.
std::string WriteConfigJson(const std::function<void(ConfigVisitor&)>& visit);

/// JSON Schema (draft 2020-12) of the config: type, allowed values, default and doc of every key.
std::string WriteConfigSchema(const std::function<void(ConfigVisitor&)>& visit);

}  // namespace tubetwin

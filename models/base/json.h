#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "models/base/frames.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// Parses a file. Throws Error(kMissing) or Error(kBadData) naming file and byte.
Json ReadJsonFile(const std::string& path);

/// Writes atomically, indented by two, newline at the end, doubles in shortest round-trip form.
void WriteJsonFile(const Json& json, const std::string& path);

/// Read access to a JSON document that names file and path ("tubes[3].radius_m") in every error.
/// All As... and Field throw Error(kBadData). A view: document and source must outlive it.
class JsonView {
 public:
  JsonView(const Json& json, std::string source) : json_(&json), source_(std::move(source)) {}

  JsonView Field(const std::string& name) const;  ///< Throws when absent, naming the nearest key.
  std::optional<JsonView> Optional(const std::string& name) const;  ///< Absent or null: nothing.
  JsonView Item(std::size_t index) const;
  std::size_t Size() const;  ///< Of an array; throws for anything else.

  bool AsBool() const;
  std::int64_t AsInteger() const;
  double AsNumber() const;  ///< Finite.
  double AsNumber(double low, double high) const;
  std::string AsString() const;
  Vector3 AsVector3() const;
  std::vector<double> AsNumbers() const;
  std::vector<Vector3> AsPolyline() const;

  bool IsString() const { return json_->is_string(); }
  bool IsObject() const { return json_->is_object(); }
  const Json& json() const { return *json_; }
  const std::string& source() const { return source_; }

  /// Throws Error(kBadData): "SOURCE: PATH: problem".
  [[noreturn]] void Fail(const std::string& problem) const;

 private:
  JsonView(const Json& json, std::string source, std::string path)
      : json_(&json), source_(std::move(source)), path_(std::move(path)) {}
  const Json* json_;
  std::string source_;
  std::string path_;
};

/// Checks "schema": "tubetwin/NAME/1". Throws Error(kBadData) naming both.
void RequireSchema(const JsonView& document, const std::string& name);

Json ToJson(const Vector3& p);                  ///< [x, y, z]
Json ToJson(const std::vector<Vector3>& line);  ///< [[x, y, z], ...]
Json ToJson(const RigidTransform& X_AB);        ///< {p_m: [x, y, z], q_wxyz: [w, x, y, z]}
RigidTransform TransformFromJson(const JsonView& view);

}  // namespace tubetwin

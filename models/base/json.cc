#include "models/base/json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json_text.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

// A parsed file takes some ten times its size.
constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{64} << 20;
constexpr double kFarthest_m = 100.0;  // A point, from any frame's origin.

/// Byte from 1 where the text nests deeper than kDeepestJson; 0: nowhere.
std::size_t ByteOfDeepNesting(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == '{')) {
      if (++depth > kDeepestJson) return i + 1;
    } else if (!quoted && (c == ']' || c == '}')) {
      --depth;
    }
  }
  return 0;
}

}  // namespace

Json ParseJson(std::string_view text, const std::string& source) {
  if (const std::size_t byte = ByteOfDeepNesting(text); byte > 0) {
    throw Error(ErrorKind::kBadData,
                source + ": byte " + std::to_string(byte) + ": lists and objects nest more than " +
                    std::to_string(kDeepestJson) + " deep; allowed: up to that");
  }
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& e) {
    throw Error(ErrorKind::kBadData, source + ": not valid JSON at byte " + std::to_string(e.byte) +
                                         " of " + std::to_string(text.size()));
  } catch (const nlohmann::json::out_of_range&) {
    throw Error(ErrorKind::kBadData, source + ": holds a number too large for any field");
  }
}

Json ReadJsonFile(const std::string& path) {
  return ParseJson(ReadFile(path, kMaxJsonBytes), path);
}

void WriteJsonFile(const Json& json, const std::string& path) {
  // Names of files, which may be any bytes, stand in some of them.
  WriteFileAtomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void JsonView::Fail(const std::string& problem) const {
  // It may quote the file, of any characters.
  throw Error(ErrorKind::kBadData,
              source_ + ": " + Printable((path_.empty() ? "" : path_ + ": ") + problem));
}

JsonView JsonView::Field(const std::string& name) const {
  if (!json_->is_object()) Fail("an object is needed, found " + std::string(json_->type_name()));
  const auto found = json_->find(name);
  if (found == json_->end()) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : json_->items()) keys.push_back(key);
    const std::string nearest = NearestName(name, keys);
    Fail("field '" + name + "' is missing" +
         (nearest.empty() ? std::string() : " (nearest present: '" + nearest.substr(0, 60) + "')"));
  }
  return JsonView(*found, source_, path_.empty() ? name : path_ + "." + name);
}

std::optional<JsonView> JsonView::Optional(const std::string& name) const {
  if (!json_->is_object()) Fail("an object is needed, found " + std::string(json_->type_name()));
  const auto found = json_->find(name);
  if (found == json_->end() || found->is_null()) return std::nullopt;
  return JsonView(*found, source_, path_.empty() ? name : path_ + "." + name);
}

JsonView JsonView::Item(std::size_t index) const {
  if (index >= Size()) Fail("has no item " + std::to_string(index));
  return JsonView((*json_)[index], source_, path_ + "[" + std::to_string(index) + "]");
}

std::size_t JsonView::Size() const {
  if (!json_->is_array()) Fail("a list is needed, found " + std::string(json_->type_name()));
  return json_->size();
}

bool JsonView::AsBool() const {
  if (!json_->is_boolean()) Fail("true or false is needed, found " + json_->dump().substr(0, 40));
  return json_->get<bool>();
}

std::int64_t JsonView::AsInteger() const {
  if (!json_->is_number_integer()) {
    Fail("a whole number is needed, found " + json_->dump().substr(0, 40));
  }
  if (json_->is_number_unsigned() &&
      json_->get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) {
    Fail("a whole number below 2^63 is needed, found " + json_->dump());
  }
  return json_->get<std::int64_t>();
}

double JsonView::AsNumber() const {
  if (!json_->is_number()) Fail("a number is needed, found " + json_->dump().substr(0, 40));
  const double value = json_->get<double>();
  if (!std::isfinite(value)) Fail("a finite number is needed");
  return value;
}

double JsonView::AsNumber(double low, double high) const {
  const double value = AsNumber();
  if (value < low || value > high) {
    Fail("is " + Number(value) + ", allowed are " + Number(low) + " to " + Number(high));
  }
  return value;
}

std::string JsonView::AsString() const {
  if (!json_->is_string()) Fail("a text is needed, found " + json_->dump().substr(0, 40));
  return json_->get<std::string>();
}

Vector3 JsonView::AsVector3() const {
  if (Size() != 3) Fail("three numbers are needed, found " + std::to_string(Size()));
  return {Item(0).AsNumber(), Item(1).AsNumber(), Item(2).AsNumber()};
}

std::vector<double> JsonView::AsNumbers() const {
  std::vector<double> out;
  for (std::size_t i = 0; i < Size(); ++i) out.push_back(Item(i).AsNumber());
  return out;
}

std::vector<Vector3> JsonView::AsPolyline() const {
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < Size(); ++i) {
    const Vector3 p = Item(i).AsVector3();
    for (std::size_t k = 0; k < 3; ++k) {
      // Whatever walks along the line in steps of its own would never end.
      if (std::abs(p[static_cast<Eigen::Index>(k)]) > kFarthest_m) {
        Item(i).Item(k).AsNumber(-kFarthest_m, kFarthest_m);
      }
    }
    out.push_back(p);
  }
  return out;
}

int IntegerIn(const JsonView& view, int low, int high) {
  const std::int64_t value = view.AsInteger();
  if (value < low || value > high) {
    view.Fail("is " + std::to_string(value) + ", allowed are " + std::to_string(low) + " to " +
              std::to_string(high));
  }
  return static_cast<int>(value);
}

int CountFromJson(const JsonView& view) {
  return IntegerIn(view, 0, std::numeric_limits<int>::max());
}

RigidTransform TransformOfColumns(const JsonView& view) {
  constexpr double kRounding = 1e-6;
  const std::vector<double> numbers = view.AsNumbers();
  if (numbers.size() != 16) view.Fail("sixteen numbers of a pose, by columns, are needed");
  RigidTransform X_AB;
  std::copy(numbers.begin(), numbers.end(), X_AB.matrix().data());
  const Matrix3 R = X_AB.linear();
  const bool last_row = X_AB.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  if (!last_row || !(R.transpose() * R).isIdentity(kRounding) || R.determinant() < 0.0 ||
      X_AB.translation().cwiseAbs().maxCoeff() > kFarthest_m) {
    view.Fail("is no pose; a rotation and a point within 100 m are needed");
  }
  return X_AB;
}

void RequireSchema(const JsonView& document, const std::string& name) {
  const std::string wanted = "tubetwin/" + name + "/1";
  const std::string found = document.Field("schema").AsString();
  if (found != wanted) {
    document.Fail("schema is '" + found + "', '" + wanted + "' is needed here");
  }
}

Json ToJson(const Vector3& p) { return Json::array({p.x(), p.y(), p.z()}); }

Json ToJson(const std::vector<Vector3>& line) {
  Json out = Json::array();
  for (const Vector3& p : line) out.push_back(ToJson(p));
  return out;
}

Json ToJson(const RigidTransform& X_AB) {
  const auto q = QuaternionWxyz(X_AB.linear());
  return Json{{"p_m", ToJson(Vector3(X_AB.translation()))}, {"q_wxyz", {q[0], q[1], q[2], q[3]}}};
}

RigidTransform TransformFromJson(const JsonView& view) {
  const JsonView q_view = view.Field("q_wxyz");
  const std::vector<double> q = q_view.AsNumbers();
  if (q.size() != 4) q_view.Fail("four numbers w x y z are needed");
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (std::abs(norm - 1.0) > 1e-3)
    q_view.Fail("is no unit quaternion, its norm is " + Number(norm));
  const JsonView p_view = view.Field("p_m");
  const Vector3 p = p_view.AsVector3();
  for (std::size_t k = 0; k < 3; ++k) p_view.Item(k).AsNumber(-kFarthest_m, kFarthest_m);
  return MakeTransform(RotationFromWxyz(q[0], q[1], q[2], q[3]), p);
}

}  // namespace tubetwin

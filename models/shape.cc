#include "models/shape.h"

#include <cmath>
#include <utility>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/files/file_schema.h"
#include "models/model_file.h"

namespace tubetwin {
namespace {

struct ShapeEntry {
  std::string name, kind;
  std::array<double, 3> origin_m = {0, 0, 0}, rpy_deg = {0, 0, 0};
  std::array<double, 3> size_m = {kNotGiven, kNotGiven, kNotGiven};
  double radius_m = kNotGiven, length_m = kNotGiven;
  void Visit(ConfigVisitor& v) {
    v.Field("name", "Of the shape, for messages.", name);
    v.Choice("kind", "What it is.", kind, {"box", "capsule", "cylinder", "sphere"});
    v.Field("origin_m", "Its centre.", origin_m, Range{-10.0, 10.0});
    v.Field("rpy_deg", "How it is turned: about x, then y, then z of what it is part of.", rpy_deg,
            Range{-360.0, 360.0});
    v.Field("size_m", "box: whole lengths along x, y, z.", size_m, Range{0.001, 10.0});
    v.Field("radius_m", "capsule, cylinder, sphere.", radius_m, Range{0.001, 5.0});
    v.Field("length_m",
            "capsule, cylinder: along z; a capsule's between the centres of its round ends.",
            length_m, Range{0.001, 10.0});
  }
};

/// Which of the keys of sizes a kind of shape takes.
void CheckSizeKeys(const ConfigSource& source, const std::string& what, const std::string& kind) {
  const bool box = kind == "box", sphere = kind == "sphere";
  const std::string who = what + ": a " + kind;
  for (const auto& [key, takes] : {std::pair{"size_m", box}, std::pair{"radius_m", !box},
                                   std::pair{"length_m", !box && !sphere}}) {
    const bool given = !source.PlaceOf(key).empty();
    if (takes && !given) {
      RefuseKey(source, "", std::string(who).append(" needs the key ").append(key));
    }
    if (!takes && given) RefuseKey(source, key, std::string(who).append(" has no ").append(key));
  }
}

}  // namespace

Vector3 HalfExtent(const Shape& shape) {
  const Vector3& s = shape.size_m;
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return s;
    case Shape::Kind::kCapsule:
      return {s.x(), s.x(), s.x() + s.y()};
    case Shape::Kind::kCylinder:
      return {s.x(), s.x(), s.y()};
    case Shape::Kind::kSphere:
      break;
  }
  return {s.x(), s.x(), s.x()};
}

Matrix3 RotationFromRpy(const std::array<double, 3>& rpy_deg) {
  return RotZ(Radians(rpy_deg[2])) * RotY(Radians(rpy_deg[1])) * RotX(Radians(rpy_deg[0]));
}

Json ShapeSchema(const std::function<void(ConfigVisitor&)>& more) {
  ShapeEntry entry;
  Json schema = TableSchema([&](ConfigVisitor& v) {
    entry.Visit(v);
    if (more) more(v);
  });
  Json required = Json::array();  // Which sizes are needed the kind says.
  for (const Json& key : schema["required"]) {
    if (key != "size_m" && key != "radius_m" && key != "length_m") required.push_back(key);
  }
  schema["required"] = std::move(required);
  return schema;
}

Shape ReadShape(const ConfigSource& source, const std::function<void(ConfigVisitor&)>& more) {
  ShapeEntry entry;
  source.Read([&](ConfigVisitor& v) {
    entry.Visit(v);
    if (more) more(v);
  });
  const std::string what = "shape '" + entry.name + "'";
  for (const char* key : {"name", "kind"}) {
    if (source.PlaceOf(key).empty()) {
      RefuseKey(source, "", what + " lacks the key " + key + "; it has no default");
    }
  }
  CheckSizeKeys(source, what, entry.kind);
  const auto vector = [](const std::array<double, 3>& v) { return Vector3(v[0], v[1], v[2]); };
  Shape shape;
  shape.name = entry.name;
  shape.X_LinkShape = MakeTransform(RotationFromRpy(entry.rpy_deg), vector(entry.origin_m));
  if (entry.kind == "box") {
    shape.kind = Shape::Kind::kBox;
    shape.size_m = 0.5 * vector(entry.size_m);
  } else if (entry.kind == "sphere") {
    shape.kind = Shape::Kind::kSphere;
    shape.size_m = Vector3(entry.radius_m, 0, 0);
  } else {
    shape.kind = entry.kind == "capsule" ? Shape::Kind::kCapsule : Shape::Kind::kCylinder;
    shape.size_m = Vector3(entry.radius_m, 0.5 * entry.length_m, 0);
  }
  return shape;
}

}  // namespace tubetwin

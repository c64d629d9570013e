#include "models/shape.h"

#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/model_file.h"

namespace tubetwin {
namespace {

struct ShapeEntry {
  std::string name, kind;
  std::vector<double> size_m;
  std::array<double, 3> centre_m = {kNotGiven, kNotGiven, kNotGiven};
  std::array<double, 4> wxyz = {1, 0, 0, 0};

  void Visit(ConfigVisitor& v) {
    v.Field("name", "for messages, one of its kind", name);
    v.Choice("kind", "what it is", kind, {"box", "capsule", "cylinder", "sphere"});
    v.Field("size_m",
            "box: length along x, y, z; capsule (without its round ends) and cylinder: radius, "
            "length along z; sphere: radius",
            size_m, 0, {1e-4, 10.0});
    v.Field("centre_m", "of it", centre_m, {-10.0, 10.0});
    v.Field("wxyz", "how it is turned: quaternion w x y z", wxyz, {-1.0, 1.0});
  }
};

Shape FromEntry(const ShapeEntry& entry, const std::string& path) {
  const std::size_t needed = entry.kind == "box" ? 3 : entry.kind == "sphere" ? 1 : 2;
  if (entry.size_m.size() != needed) {
    throw Error(ErrorKind::kConfig, path + ": shape '" + entry.name + "': size_m has " +
                                        std::to_string(entry.size_m.size()) + " numbers; a " +
                                        entry.kind + " needs " + std::to_string(needed));
  }
  Shape shape;
  shape.name = entry.name;
  shape.X_LinkShape =
      MakeTransform(UnitRotation(entry.wxyz, path + ": shape '" + entry.name + "': wxyz"),
                    Vector3(entry.centre_m[0], entry.centre_m[1], entry.centre_m[2]));
  const std::vector<double>& s = entry.size_m;
  if (entry.kind == "box") {
    shape.kind = Shape::Kind::kBox;
    shape.size_m = 0.5 * Vector3(s[0], s[1], s[2]);
  } else if (entry.kind == "sphere") {
    shape.kind = Shape::Kind::kSphere;
    shape.size_m = Vector3(s[0], 0, 0);
  } else {
    shape.kind = entry.kind == "capsule" ? Shape::Kind::kCapsule : Shape::Kind::kCylinder;
    shape.size_m = Vector3(s[0], 0.5 * s[1], 0);
  }
  return shape;
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

Matrix3 UnitRotation(const std::array<double, 4>& wxyz, const std::string& what) {
  constexpr double kUnit = 1e-3;  // as many digits as people write
  const double norm = Eigen::Map<const Eigen::Vector4d>(wxyz.data()).norm();
  if (!(std::abs(norm - 1.0) < kUnit)) {
    throw Error(ErrorKind::kConfig, what + " has length " + Number(norm) +
                                        "; a quaternion w x y z of length 1 is needed, as in "
                                        "[1, 0, 0, 0]");
  }
  return RotationFromWxyz(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
}

Shape ReadShape(const ConfigSource& source, const std::string& path,
                const std::function<void(ConfigVisitor&)>& more) {
  ShapeEntry entry;
  const auto visit = [&](ConfigVisitor& v) {
    entry.Visit(v);
    if (more) more(v);
  };
  source.Read(visit);
  RequireGiven(visit, path + ": shape '" + entry.name + "'");
  return FromEntry(entry, path);
}

}  // namespace tubetwin

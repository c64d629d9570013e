// Reads the arm's definition, the only place that knows its format.

#include <toml++/toml.h>

#include "hw_bridge/base/error.h"
#include "models/arm.h"
#include "models/embedded.h"

namespace tubetwin {
namespace {

[[noreturn]] void Fail(const std::string& what) {
  throw Error(ErrorKind::kConfig, "models/arm/hc10.toml: " + what);
}

double Number(const toml::table& table, const char* key) {
  const auto value = table[key].value<double>();
  if (!value) Fail(std::string("number '") + key + "' is missing");
  return *value;
}

std::string Text(const toml::table& table, const char* key) {
  const auto value = table[key].value<std::string>();
  if (!value) Fail(std::string("text '") + key + "' is missing");
  return *value;
}

template <int N>
Eigen::Matrix<double, N, 1> Numbers(const toml::table& table, const char* key) {
  const toml::array* array = table[key].as_array();
  if (array == nullptr || array->size() != N) {
    Fail(std::string("'") + key + "' must be a list of " + std::to_string(N) + " numbers");
  }
  Eigen::Matrix<double, N, 1> out;
  for (int i = 0; i < N; ++i) {
    const auto value = array->get(static_cast<std::size_t>(i))->value<double>();
    if (!value) Fail(std::string("'") + key + "' must hold numbers only");
    out[i] = *value;
  }
  return out;
}

const toml::table& Entry(const toml::table& root, const char* key, int index, int count) {
  const toml::array* array = root[key].as_array();
  if (array == nullptr || static_cast<int>(array->size()) != count) {
    Fail("needs " + std::to_string(count) + " entries [[" + key + "]]");
  }
  const toml::table* entry = array->get(static_cast<std::size_t>(index))->as_table();
  if (entry == nullptr) Fail(std::string("[[") + key + "]] must be tables");
  return *entry;
}

ArmModel::Joint ReadJoint(const toml::table& table, double acceleration_time_s,
                          double jerk_time_s) {
  ArmModel::Joint joint;
  joint.name = Text(table, "name");
  joint.origin_in_parent_m = Numbers<3>(table, "origin_m");
  joint.axis = Numbers<3>(table, "axis");
  const Eigen::Vector2d range_deg = Numbers<2>(table, "range_deg");
  joint.lower_rad = Radians(range_deg[0]);
  joint.upper_rad = Radians(range_deg[1]);
  joint.max_speed_rad_s = Radians(Number(table, "speed_deg_s"));
  joint.max_effort_Nm = Number(table, "effort_Nm");
  joint.max_acceleration_rad_s2 = joint.max_speed_rad_s / acceleration_time_s;
  joint.max_jerk_rad_s3 = joint.max_acceleration_rad_s2 / jerk_time_s;
  joint.armature_kgm2 = Number(table, "armature_kgm2");
  joint.damping_Nms = Number(table, "damping_Nms");
  joint.friction_Nm = Number(table, "friction_Nm");
  return joint;
}

ArmModel::Link ReadLink(const toml::table& table) {
  ArmModel::Link link;
  link.name = Text(table, "name");
  link.mass_kg = Number(table, "mass_kg");
  link.centre_of_mass_m = Numbers<3>(table, "centre_m");
  const auto I = Numbers<6>(table, "inertia_kgm2");  // xx yy zz xy xz yz
  link.inertia_kgm2 << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return link;
}

ArmModel ReadArm(std::string_view text) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    Fail(std::string(error.description()));
  }
  ArmModel arm;
  const double acceleration_time_s = Number(root, "acceleration_time_s");
  const double jerk_time_s = Number(root, "jerk_time_s");
  for (int i = 0; i < kNumJoints; ++i) {
    arm.joints[i] =
        ReadJoint(Entry(root, "joint", i, kNumJoints), acceleration_time_s, jerk_time_s);
  }
  for (int i = 0; i <= kNumJoints; ++i) {
    arm.links[i] = ReadLink(Entry(root, "link", i, kNumJoints + 1));
  }
  arm.X_6F = MakeTransform(RotX(Radians(Number(root, "flange_roll_deg"))),
                           Numbers<3>(root, "flange_origin_m"));
  return arm;
}

ArmModel ReadEmbeddedArm() {
  for (const EmbeddedText& file : EmbeddedTexts()) {
    if (file.path == "arm/hc10.toml") return ReadArm(file.text);
  }
  Fail("is not in the program");
}

}  // namespace

const ArmModel& Hc10() {
  static const ArmModel arm = ReadEmbeddedArm();
  return arm;
}

}  // namespace tubetwin

// Reads the arm's definition, the only place that knows its format.

#include <cmath>
#include <limits>

#include "models/arm/arm.h"
#include "models/base/config/config.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> kUnset3 = {kUnset, kUnset, kUnset};

constexpr std::array<const char*, kNumJoints> kJointNames = {"joint_1_s", "joint_2_l", "joint_3_u",
                                                             "joint_4_r", "joint_5_b", "joint_6_t"};
constexpr std::array<const char*, kNumJoints + 1> kLinkNames = {
    "base_link", "link_1_s", "link_2_l", "link_3_u", "link_4_r", "link_5_b", "link_6_t"};

struct JointEntry {
  std::array<double, 3> origin_m = kUnset3;
  std::array<double, 3> axis = kUnset3;
  std::array<double, 2> range_deg = {kUnset, kUnset};
  double speed_deg_s = kUnset;
  double effort_Nm = kUnset;
  double armature_kgm2 = kUnset;
  double damping_Nms = kUnset;
  double friction_Nm = kUnset;
  void Visit(ConfigVisitor& v) {
    v.Field("origin_m", "In the frame of the link before.", origin_m);
    v.Field("axis", "Unit vector.", axis, Range{-1.0, 1.0});
    v.Field("range_deg", "Lower and upper limit.", range_deg, Range{-360.0, 360.0});
    v.Field("speed_deg_s", "Limit.", speed_deg_s, Range{1.0, 1000.0});
    v.Field("effort_Nm", "Limit.", effort_Nm, Range{1.0, 10000.0});
    v.Field("armature_kgm2", "Rotor inertia behind the gear.", armature_kgm2, Range{0.0, 100.0});
    v.Field("damping_Nms", "Viscous friction.", damping_Nms, Range{0.0, 1000.0});
    v.Field("friction_Nm", "Dry friction.", friction_Nm, Range{0.0, 1000.0});
  }
};

struct LinkEntry {
  double mass_kg = kUnset;
  std::array<double, 3> centre_m = kUnset3;
  std::array<double, 6> inertia_kgm2 = {kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};
  void Visit(ConfigVisitor& v) {
    v.Field("mass_kg", "Mass.", mass_kg, Range{0.0, 1000.0});
    v.Field("centre_m", "Centre of mass.", centre_m);
    v.Field("inertia_kgm2", "About the centre, link axes: xx yy zz xy xz yz.", inertia_kgm2);
  }
};

struct ArmEntry {
  std::string name;
  double acceleration_time_s = kUnset;
  double jerk_time_s = kUnset;
  std::array<double, 3> flange_origin_m = kUnset3;
  double flange_roll_deg = kUnset;
  std::array<JointEntry, kNumJoints> joints;
  std::array<LinkEntry, kNumJoints + 1> links;
  void Visit(ConfigVisitor& v) {
    v.Field("name", "Of the arm.", name);
    v.Field("acceleration_time_s", "From rest to full speed.", acceleration_time_s,
            Range{0.01, 10.0});
    v.Field("jerk_time_s", "From none to full acceleration.", jerk_time_s, Range{0.001, 10.0});
    v.Field("flange_origin_m", "In the last link.", flange_origin_m);
    v.Field("flange_roll_deg", "About x.", flange_roll_deg, Range{-180.0, 180.0});
    for (int i = 0; i < kNumJoints; ++i) v.Section(kJointNames[i], "A joint.", joints[i]);
    for (int i = 0; i <= kNumJoints; ++i) v.Section(kLinkNames[i], "A link.", links[i]);
  }
};

Vector3 ToVector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

ArmModel::Joint ReadJoint(const char* name, const JointEntry& entry, const ArmEntry& arm) {
  ArmModel::Joint joint;
  joint.name = name;
  joint.origin_in_parent_m = ToVector(entry.origin_m);
  joint.axis = ToVector(entry.axis);
  joint.lower_rad = Radians(entry.range_deg[0]);
  joint.upper_rad = Radians(entry.range_deg[1]);
  joint.max_speed_rad_s = Radians(entry.speed_deg_s);
  joint.max_effort_Nm = entry.effort_Nm;
  joint.max_acceleration_rad_s2 = joint.max_speed_rad_s / arm.acceleration_time_s;
  joint.max_jerk_rad_s3 = joint.max_acceleration_rad_s2 / arm.jerk_time_s;
  joint.armature_kgm2 = entry.armature_kgm2;
  joint.damping_Nms = entry.damping_Nms;
  joint.friction_Nm = entry.friction_Nm;
  return joint;
}

ArmModel::Link ReadLink(const char* name, const LinkEntry& entry) {
  ArmModel::Link link;
  link.name = name;
  link.mass_kg = entry.mass_kg;
  link.centre_of_mass_m = ToVector(entry.centre_m);
  const auto& I = entry.inertia_kgm2;  // xx yy zz xy xz yz
  link.inertia_kgm2 << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return link;
}

}  // namespace

ArmModel ReadArm(const ModelFile& file) {
  const ConfigSource source = file.Source();
  ArmEntry entry;
  source.ReadInto(entry);
  // The file has no defaults to fall back on: writing it out checks that every number is set.
  WriteToml([&entry](ConfigVisitor& v) { entry.Visit(v); }, false);

  ArmModel arm;
  for (int i = 0; i < kNumJoints; ++i) {
    arm.joints[i] = ReadJoint(kJointNames[i], entry.joints[i], entry);
  }
  for (int i = 0; i <= kNumJoints; ++i) arm.links[i] = ReadLink(kLinkNames[i], entry.links[i]);
  arm.X_6F = MakeTransform(RotX(Radians(entry.flange_roll_deg)), ToVector(entry.flange_origin_m));
  return arm;
}

}  // namespace tubetwin

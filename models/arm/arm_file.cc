// Reads arm files, the only place that knows their format (README.md).

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/arm/arm.h"
#include "models/arm/inverse/inverse_method.h"
#include "models/base/config/config.h"
#include "models/base/error.h"
#include "models/base/text.h"
#include "models/files/file_schema.h"

namespace tubetwin {
namespace {

constexpr int kToolBody = kNumJoints + 1;
constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> kUnset3 = {kUnset, kUnset, kUnset};

struct JointEntry {
  std::string name;
  std::array<double, 3> origin_m = kUnset3;
  std::array<double, 3> axis = kUnset3;
  std::array<double, 2> range_deg = {kUnset, kUnset};
  double speed_deg_s = kUnset;
  double effort_Nm = kUnset;
  double armature_kgm2 = kUnset;
  double damping_Nms = kUnset;
  double friction_Nm = kUnset;
  void Visit(ConfigVisitor& v) {
    v.Field("name", "Of the joint, as its controller names it.", name);
    v.Field("origin_m", "In the frame of the link before, all joints at zero.", origin_m,
            Range{-10.0, 10.0});
    v.Field("axis", "Unit vector; all frames are parallel to the base at zero.", axis,
            Range{-1.0, 1.0});
    v.Field("range_deg", "Lower and upper limit.", range_deg, Range{-720.0, 720.0});
    v.Field("speed_deg_s", "Limit.", speed_deg_s, Range{1.0, 1000.0});
    v.Field("effort_Nm", "Limit.", effort_Nm, Range{1.0, 10000.0});
    v.Field("armature_kgm2", "Rotor inertia behind the gear.", armature_kgm2, Range{0.0, 100.0});
    v.Field("damping_Nms", "Viscous friction.", damping_Nms, Range{0.0, 1000.0});
    v.Field("friction_Nm", "Dry friction.", friction_Nm, Range{0.0, 1000.0});
  }
  static constexpr std::array<const char*, 9> kKeys = {
      "name",      "origin_m",      "axis",        "range_deg",  "speed_deg_s",
      "effort_Nm", "armature_kgm2", "damping_Nms", "friction_Nm"};
};

struct LinkEntry {
  std::string name;
  double mass_kg = kUnset;
  std::array<double, 3> centre_m = kUnset3;
  std::array<double, 6> inertia_kgm2 = {kUnset, kUnset, kUnset, kUnset, kUnset, kUnset};
  void Visit(ConfigVisitor& v) {
    v.Field("name", "Of the link.", name);
    v.Field("mass_kg", "Mass.", mass_kg, Range{0.001, 2000.0});
    v.Field("centre_m", "Centre of mass.", centre_m, Range{-10.0, 10.0});
    v.Field("inertia_kgm2", "About the centre, link axes: xx yy zz xy xz yz.", inertia_kgm2);
  }
  static constexpr std::array<const char*, 4> kKeys = {"name", "mass_kg", "centre_m",
                                                       "inertia_kgm2"};
};

struct ShapeLink {
  std::string link;
  void Visit(ConfigVisitor& v) { v.Field("link", "Name of the link that it is part of.", link); }
};

struct ArmEntry {
  std::string name, controller = "none", inverse;
  double acceleration_time_s = kUnset;
  double jerk_time_s = kUnset;
  std::array<double, 3> flange_origin_m = kUnset3;
  std::array<double, 3> flange_rpy_deg = kUnset3;
  std::array<double, kNumJoints> working_deg = {}, working_within_deg, working_weight;
  std::vector<double> never_meet, may_meet;
  JointEntry joint;
  LinkEntry link;
  ArmEntry() : working_weight({1, 1, 1, 1, 1, 0}) { working_within_deg.fill(180.0); }
  void Visit(ConfigVisitor& v) {
    v.Field("name", "Of the arm.", name);
    v.Choice("controller", "What drivers may speak to: a Yaskawa controller with MotoROS, or none.",
             controller, {"none", "motoros"});
    v.Choice("inverse", "How its inverse kinematics is computed; numeric solves any geometry.",
             inverse, InverseNames());
    v.Field("acceleration_time_s", "From rest to full speed.", acceleration_time_s,
            Range{0.01, 10.0});
    v.Field("jerk_time_s", "From none to full acceleration.", jerk_time_s, Range{0.001, 10.0});
    v.Field("flange_origin_m", "In the last link.", flange_origin_m, Range{-10.0, 10.0});
    v.Field("flange_rpy_deg",
            "In the last link: about x, then y, then z of the link; z then points out.",
            flange_rpy_deg, Range{-360.0, 360.0});
    v.Field("working_deg", "A posture as the arm is to work in, the tool pointing down.",
            working_deg, Range{-720.0, 720.0});
    v.Field("working_within_deg",
            "How far each joint may be from it; joint 1: the forearm's direction seen from link 1.",
            working_within_deg, Range{0.0, 180.0});
    v.Field("working_weight", "Of solutions within, the least weighted sum of differences wins.",
            working_weight, Range{0.0, 1000.0});
    v.Field("never_meet",
            "Pairs of bodies (0 base, 1 to 6 links, 7 tool), one after the other, that cannot meet "
            "though they are three or more apart.",
            never_meet, 0, Range{0, kToolBody});
    v.Field("may_meet", "Pairs that can meet though they are but two apart.", may_meet, 0,
            Range{0, kToolBody});
    v.Section("joint", "[[joint]]: one of six, from the base on.", joint);
    v.Section("link", "[[link]]: one of seven, the base first.", link);
  }
  static constexpr std::array<const char*, 7> kKeys = {
      "name",           "inverse",    "acceleration_time_s", "jerk_time_s", "flange_origin_m",
      "flange_rpy_deg", "working_deg"};
};

/// Figures of an arm have no defaults to fall back on.
template <class Keys>
void RequireKeys(const ConfigSource& source, const std::string& what, const Keys& keys) {
  for (const char* key : keys) {
    if (source.PlaceOf(key).empty()) {
      RefuseKey(source, "", what + " lacks the key " + key + "; it has no default");
    }
  }
}

Vector3 ToVector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

JointVector ToJoints(const std::array<double, kNumJoints>& v) {
  return Eigen::Map<const JointVector>(v.data());
}

ArmModel::Joint ReadJoint(const ConfigSource& source, int number, const ArmEntry& arm) {
  constexpr double kRoundedUnit = 1e-3;  // an axis written with four digits
  JointEntry entry;
  source.ReadInto(entry);
  const std::string what = "joint " + std::to_string(number) + " (" + entry.name + ")";
  RequireKeys(source, what, JointEntry::kKeys);
  ArmModel::Joint joint;
  joint.name = entry.name;
  joint.origin_in_parent_m = ToVector(entry.origin_m);
  const double length = ToVector(entry.axis).norm();
  if (std::abs(length - 1.0) > kRoundedUnit) {
    RefuseKey(source, "axis",
              what + ": axis has length " + Number(length) + ", a unit vector has 1");
  }
  joint.axis = ToVector(entry.axis) / length;
  joint.lower_rad = Radians(entry.range_deg[0]);
  joint.upper_rad = Radians(entry.range_deg[1]);
  if (joint.lower_rad >= joint.upper_rad) {
    RefuseKey(source, "range_deg",
              what + ": range_deg is [" + Number(entry.range_deg[0]) + ", " +
                  Number(entry.range_deg[1]) + "]; the first has to be below the second");
  }
  joint.max_speed_rad_s = Radians(entry.speed_deg_s);
  joint.max_effort_Nm = entry.effort_Nm;
  joint.max_acceleration_rad_s2 = joint.max_speed_rad_s / arm.acceleration_time_s;
  joint.max_jerk_rad_s3 = joint.max_acceleration_rad_s2 / arm.jerk_time_s;
  joint.armature_kgm2 = entry.armature_kgm2;
  joint.damping_Nms = entry.damping_Nms;
  joint.friction_Nm = entry.friction_Nm;
  return joint;
}

ArmModel::Link ReadLink(const ConfigSource& source, int number) {
  LinkEntry entry;
  source.ReadInto(entry);
  const std::string what = "link " + std::to_string(number) + " (" + entry.name + ")";
  RequireKeys(source, what, LinkEntry::kKeys);
  ArmModel::Link link;
  link.name = entry.name;
  link.mass_kg = entry.mass_kg;
  link.centre_of_mass_m = ToVector(entry.centre_m);
  const auto& I = entry.inertia_kgm2;  // xx yy zz xy xz yz
  link.inertia_kgm2 << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(link.inertia_kgm2, Eigen::EigenvaluesOnly);
  const Vector3 moments = eigen.eigenvalues();
  if (moments[0] <= 0 || moments[0] + moments[1] < moments[2]) {
    RefuseKey(source, "inertia_kgm2",
              what + ": inertia_kgm2 has the main moments " + Number(moments[0]) + ", " +
                  Number(moments[1]) + ", " + Number(moments[2]) +
                  ";\nof a body all are above 0 and none is above the sum of the others");
  }
  return link;
}

Shape ReadLinkShape(const ConfigSource& source, const ArmModel& arm) {
  ShapeLink of;
  Shape shape = ReadShape(source, [&of](ConfigVisitor& v) { of.Visit(v); });
  std::vector<std::string> links;
  for (const ArmModel::Link& link : arm.links) links.push_back(link.name);
  const auto link = std::find(links.begin(), links.end(), of.link);
  if (link == links.end()) {
    RefuseKey(source, "link",
              "shape '" + shape.name + "': no link is named '" + of.link + "'; the nearest is '" +
                  NearestName(of.link, links) + "'");
  }
  shape.link = static_cast<int>(link - links.begin());
  return shape;
}

/// Whether the flat list holds the pair.
bool HoldsPair(const std::vector<double>& list, int outer, int inner) {
  for (std::size_t i = 0; i + 1 < list.size(); i += 2) {
    if (std::max(list[i], list[i + 1]) == outer && std::min(list[i], list[i + 1]) == inner) {
      return true;
    }
  }
  return false;
}

/// Bodies three or more apart can meet, as a rule: two joints between them fold the arm.
std::vector<std::array<int, 2>> SelfPairs(const ConfigSource& source, const ArmEntry& entry) {
  for (const auto& [key, list] :
       {std::pair{"never_meet", &entry.never_meet}, std::pair{"may_meet", &entry.may_meet}}) {
    const bool whole = std::all_of(list->begin(), list->end(),
                                   [](double body) { return body == std::floor(body); });
    if (list->size() % 2 == 0 && whole) continue;
    RefuseKey(source, key, std::string(key) + " has to hold pairs of whole numbers, 0 to 7");
  }
  std::vector<std::array<int, 2>> pairs;
  for (int outer = kToolBody; outer > 0; --outer) {
    for (int inner = 0; inner < outer; ++inner) {
      const bool rule = outer - inner >= 3 && !HoldsPair(entry.never_meet, outer, inner);
      if (rule || HoldsPair(entry.may_meet, outer, inner)) pairs.push_back({outer, inner});
    }
  }
  return pairs;
}

/// Names serve messages: each means one thing.
template <class Named>
void CheckNames(const ConfigSource& source, const char* what, const Named& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return;
  RefuseKey(source, "", std::string("two ") + what + " are named '" + *twice + "'");
}

void RequireCount(const ConfigSource& source, const std::string& key,
                  const std::vector<ConfigSource>& tables, std::size_t count) {
  if (tables.size() == count) return;
  RefuseKey(source, "",
            "the arm has " + std::to_string(tables.size()) + " [[" + key + "]], but " +
                std::to_string(count) + " are needed");
}

}  // namespace

Json ArmFileSchema() {
  ArmEntry arm;
  JointEntry joint;
  LinkEntry link;
  ShapeLink of;
  const auto schema_of = [](auto& entry) {
    return TableSchema([&entry](ConfigVisitor& v) { entry.Visit(v); });
  };
  Json schema = schema_of(arm);
  AddTables("joint", "one of six, from the base on", schema_of(joint), kNumJoints, kNumJoints,
            schema);
  AddTables("link", "one of seven, the base first", schema_of(link), kNumJoints + 1, kNumJoints + 1,
            schema);
  AddTables("shape", "what a link looks like to the clearance check and to contacts",
            ShapeSchema([&of](ConfigVisitor& v) { of.Visit(v); }), 0, 0, schema);
  return schema;
}

ArmModel ReadArm(const ModelFile& file) {
  ConfigSource source = file.Source();
  const std::vector<ConfigSource> joints = source.TakeTables("joint");
  const std::vector<ConfigSource> links = source.TakeTables("link");
  const std::vector<ConfigSource> shapes = source.TakeTables("shape");
  ArmEntry entry;
  source.ReadInto(entry);  // A misspelt key is named before anything is missed.
  RequireCount(source, "joint", joints, kNumJoints);
  RequireCount(source, "link", links, kNumJoints + 1);
  RequireKeys(source, "the arm", ArmEntry::kKeys);

  ArmModel arm;
  arm.name = entry.name;
  arm.controller = entry.controller;
  arm.inverse = entry.inverse;
  for (int i = 0; i < kNumJoints; ++i) arm.joints[i] = ReadJoint(joints[i], i + 1, entry);
  for (int i = 0; i <= kNumJoints; ++i) arm.links[i] = ReadLink(links[i], i);
  CheckNames(source, "joints", arm.joints);
  CheckNames(source, "links", arm.links);
  for (const ConfigSource& shape : shapes) arm.shapes.push_back(ReadLinkShape(shape, arm));
  CheckNames(source, "shapes", arm.shapes);
  arm.X_6F = MakeTransform(RotationFromRpy(entry.flange_rpy_deg), ToVector(entry.flange_origin_m));
  arm.self_pairs = SelfPairs(source, entry);
  arm.working.q = ToJoints(entry.working_deg) * kPi / 180.0;
  arm.working.within_rad = ToJoints(entry.working_within_deg) * kPi / 180.0;
  arm.working.weight = ToJoints(entry.working_weight);
  try {
    MethodOf(arm).check(arm);
  } catch (const Error& error) {
    throw Error(error.kind(), source.PlaceOf("inverse") + ": " + error.what());
  }
  return arm;
}

ArmModel LoadArm(const std::string& name_or_path) {
  return ReadArm(OpenModelFile("arms", name_or_path, "arm"));
}

std::vector<std::string> ArmNames() { return ModelFileNames("arms"); }

}  // namespace tubetwin

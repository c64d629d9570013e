#include "models/gripper_spec.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/files/file_schema.h"
#include "models/model_file.h"

namespace tubetwin {
namespace {

constexpr double kOverAxis_m = 0.009;   // pads' centre over the tube's axis: holds best there
constexpr double kOverFloor_m = 0.002;  // pads' lower edge over the floor

constexpr const char* kOpeningCounts = "steps of the asked and measured opening over the stroke";
constexpr const char* kCommandCounts = "steps of force and speed between their ends";

using Table = std::vector<std::array<double, 2>>;  // opening, advance

double Secant(const Table& table, int i) {
  return (table[i + 1][1] - table[i][1]) / (table[i + 1][0] - table[i][0]);
}

/// Slope at a row, Fritsch and Butland's harmonic mean: keeps the cubic monotone.
double Slope(const Table& table, int i) {
  const int rows = static_cast<int>(table.size());
  if (i == 0) return Secant(table, 0);
  if (i == rows - 1) return Secant(table, rows - 2);
  const double below = Secant(table, i - 1), above = Secant(table, i);
  return below * above > 0.0 ? 2 * below * above / (below + above) : 0.0;
}

struct GripperEntry {
  GripperSpec spec;
  std::array<double, 2> force_N = {kNotGiven, kNotGiven};
  std::array<double, 2> speed_m_s = {kNotGiven, kNotGiven};
  std::vector<double> tip_opening_m, tip_advance_m;

  GripperEntry() {
    spec.stroke_m = spec.pad_width_m = spec.pad_height_m = spec.finger_thickness_m = kNotGiven;
    spec.finger_length_m = spec.mass_kg = spec.coupling_mass_kg = spec.finger_mass_kg = kNotGiven;
    spec.palm_centre_m = kNotGiven;
  }
  void Visit(ConfigVisitor& v) {
    const Range length{1e-3, 1.0}, mass{1e-3, 50.0};
    v.Field("name", "for messages and reports", spec.name);
    v.Choice("controller", "what drivers may speak to: Robotiq's registers, or none",
             spec.controller, {"none", "robotiq"});
    v.Field("stroke_m", "largest opening between the pads", spec.stroke_m, length);
    v.Field("force_N", "least and largest force of a pad", force_N, {0.1, 10000});
    v.Field("speed_m_s", "least and largest speed of the opening", speed_m_s, {1e-4, 10});
    v.Field("opening_counts", kOpeningCounts, spec.opening_counts, {10, 1000000});
    v.Field("command_counts", kCommandCounts, spec.command_counts, {1, 1000000});
    v.Field("pad_width_m", "of a pad, along a grasped tube", spec.pad_width_m, length);
    v.Field("pad_height_m", "of a pad, along the tool", spec.pad_height_m, length);
    v.Field("finger_thickness_m", "along the closing direction, from the pad's face outwards",
            spec.finger_thickness_m, length);
    v.Field("finger_length_m", "from the pads' lower edge towards the palm", spec.finger_length_m,
            length);
    v.Field("tip_opening_m", "openings, rising, of tip_advance_m; empty: the pads move straight",
            tip_opening_m, 0, {0.0, 1.0});
    v.Field("tip_advance_m", "how far the pads stand forward there, against fully open",
            tip_advance_m, 0, {-0.2, 0.2});
    v.Field("mass_kg", "with fingers", spec.mass_kg, mass);
    v.Field("coupling_mass_kg", "of what joins it to the sensor", spec.coupling_mass_kg,
            {0.0, 50.0});
    v.Field("finger_mass_kg", "of one finger with its drive", spec.finger_mass_kg, mass);
    v.Field("palm_centre_m", "centre of mass of palm and coupling over the sensor's tool face",
            spec.palm_centre_m, {0.0, 1.0});
  }
};

void RequireRising(const std::string& path, const char* key, double low, double high) {
  if (low < high) return;
  RefuseFile(path, std::string(key) + " is [" + Number(low) + ", " + Number(high) +
                       "]; the second number must be larger");
}

void RequireRisingOpenings(const std::string& path, const std::string& key,
                           const std::vector<double>& openings) {
  for (std::size_t i = 1; i < openings.size(); ++i) {
    if (openings[i] <= openings[i - 1]) {
      RefuseFile(path, key + " goes from " + Number(openings[i - 1]) + " to " +
                           Number(openings[i]) + "; openings must rise");
    }
  }
}

void RequireSameCount(const std::string& path, const std::string& key, std::size_t found,
                      const std::string& other, std::size_t needed) {
  if (found == needed) return;
  RefuseFile(path, key + " has " + std::to_string(found) + " numbers; one for each of " + other +
                       " is needed: " + std::to_string(needed));
}

struct LinkRows {
  std::vector<double> opening_m, y_m, z_m, angle_deg;
  void Visit(ConfigVisitor& v) {
    v.Field("opening_m", "openings, rising, of the three lists below", opening_m, 0, {0.0, 1.0});
    v.Field("y_m", "its centre in E at those, of the finger at +y", y_m, 0, {-1.0, 1.0});
    v.Field("z_m", "likewise", z_m, 0, {-1.0, 1.0});
    v.Field("angle_deg", "its turn about x", angle_deg, 0, {-180.0, 180.0});
  }
};

GripperSpec::Link ReadLink(const ConfigSource& source, const std::string& path) {
  LinkRows rows;
  GripperSpec::Link link;
  link.shape = ReadShape(source, [&rows](ConfigVisitor& v) { rows.Visit(v); });
  const auto& [opening_m, y_m, z_m, angle_deg] = rows;
  const std::string name = "link '" + link.shape.name + "': ";
  if (link.shape.kind != Shape::Kind::kBox && link.shape.kind != Shape::Kind::kCapsule) {
    RefuseFile(path, name + "kind is a cylinder or sphere; allowed: box, capsule");
  }
  if (opening_m.empty()) RefuseFile(path, name + "opening_m is empty; at least one row is needed");
  RequireRisingOpenings(path, name + "opening_m", opening_m);
  RequireSameCount(path, name + "y_m", y_m.size(), "opening_m", opening_m.size());
  RequireSameCount(path, name + "z_m", z_m.size(), "opening_m", opening_m.size());
  RequireSameCount(path, name + "angle_deg", angle_deg.size(), "opening_m", opening_m.size());
  for (std::size_t i = 0; i < opening_m.size(); ++i) {
    link.rows.push_back({opening_m[i], y_m[i], z_m[i], Radians(angle_deg[i])});
  }
  return link;
}

}  // namespace

double TipAdvance(const GripperSpec& gripper, double opening_m) {
  const Table& table = gripper.tip_advance_m;
  if (table.empty()) return 0.0;
  if (table.size() == 1) return table.front()[1];
  const double x = std::clamp(opening_m, table.front()[0], table.back()[0]);
  const int rows = static_cast<int>(table.size());
  int i = 0;
  while (i < rows - 2 && x > table[i + 1][0]) ++i;
  const double width = table[i + 1][0] - table[i][0];
  const double u = (x - table[i][0]) / width;
  const double rise = table[i + 1][1] - table[i][1];
  const double a = width * Slope(table, i) - rise, b = rise - width * Slope(table, i + 1);
  return table[i][1] + u * rise + u * (1 - u) * ((1 - u) * a + u * b);
}

double MinPadHeight(const GripperSpec& gripper) {
  return kOverFloor_m + 0.5 * gripper.pad_height_m;
}

double GraspHeightOverAxis(double axis_height_m, const GripperSpec& gripper) {
  return std::max(kOverAxis_m, MinPadHeight(gripper) - axis_height_m);
}

RigidTransform LinkPose(const GripperSpec::Link& link, double opening_m, int side) {
  const auto& rows = link.rows;
  const double x = std::clamp(opening_m, rows.front().opening_m, rows.back().opening_m);
  std::size_t i = 0;
  while (i + 2 < rows.size() && x > rows[i + 1].opening_m) ++i;
  GripperSpec::Link::Row at = rows[i];
  if (rows.size() > 1) {
    const auto& next = rows[i + 1];
    const double u = (x - at.opening_m) / (next.opening_m - at.opening_m);
    at.y_m += u * (next.y_m - at.y_m);
    at.z_m += u * (next.z_m - at.z_m);
    at.angle_rad += u * (next.angle_rad - at.angle_rad);
  }
  const RigidTransform X_ELink = MakeTransform(RotX(at.angle_rad), Vector3(0, at.y_m, at.z_m));
  return side > 0 ? X_ELink : MakeTransform(RotZ(kPi), Vector3::Zero()) * X_ELink;
}

Json GripperFileSchema() {
  GripperEntry entry;
  LinkRows rows;
  Json schema = TableSchema([&entry](ConfigVisitor& v) { entry.Visit(v); });
  AddTables("shape", "what does not move with the fingers, on the sensor's tool face",
            ShapeSchema(), 0, 0, schema);
  AddTables("link", "more of a finger than its bar, for instance bars of a linkage",
            ShapeSchema([&rows](ConfigVisitor& v) { rows.Visit(v); }), 0, 0, schema);
  return schema;
}

GripperSpec ReadGripper(const ModelFile& file) {
  ConfigSource source = file.Source();
  const std::vector<ConfigSource> shapes = source.TakeTables("shape");
  const std::vector<ConfigSource> links = source.TakeTables("link");
  GripperEntry entry;
  source.ReadInto(entry);
  RequireGiven([&](ConfigVisitor& v) { entry.Visit(v); }, file.path);
  GripperSpec& spec = entry.spec;
  if (spec.opening_counts == 0)
    RefuseFile(file.path, "opening_counts is missing: " + std::string(kOpeningCounts));
  if (spec.command_counts == 0)
    RefuseFile(file.path, "command_counts is missing: " + std::string(kCommandCounts));
  RequireRising(file.path, "force_N", entry.force_N[0], entry.force_N[1]);
  RequireRising(file.path, "speed_m_s", entry.speed_m_s[0], entry.speed_m_s[1]);
  spec.min_force_N = entry.force_N[0];
  spec.max_force_N = entry.force_N[1];
  spec.min_speed_m_s = entry.speed_m_s[0];
  spec.max_speed_m_s = entry.speed_m_s[1];
  RequireRisingOpenings(file.path, "tip_opening_m", entry.tip_opening_m);
  RequireSameCount(file.path, "tip_advance_m", entry.tip_advance_m.size(), "tip_opening_m",
                   entry.tip_opening_m.size());
  for (std::size_t i = 0; i < entry.tip_opening_m.size(); ++i) {
    spec.tip_advance_m.push_back({entry.tip_opening_m[i], entry.tip_advance_m[i]});
  }
  if (shapes.empty())
    RefuseFile(file.path, "no [[shape]]; the body that carries the fingers is needed");
  for (const ConfigSource& shape : shapes) {
    spec.body.push_back(ReadShape(shape));
    spec.body.back().link = kFlangeBody;
  }
  for (const ConfigSource& link : links) spec.links.push_back(ReadLink(link, file.path));
  return spec;
}

}  // namespace tubetwin

#include "twin/app/calibrate/views_file.h"

#include <cmath>
#include <filesystem>

#include "models/base/config/config.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/text.h"
#include "models/shape.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr Range kPlace_m{-20.0, 20.0};

struct ViewEntry {
  std::string cloud;
  std::vector<double> joints_deg, X_BF;
  void Visit(ConfigVisitor& v) {
    v.File("cloud", "organised cloud of the empty bin (PCD or PLY)", cloud);
    v.NumbersOrNone("joints_deg", "the arm's joints when it was taken, degrees", joints_deg,
                    kNumJoints, {-720.0, 720.0});
    v.PoseOrNone("X_BF",
                 "in place of joints: the flange in the base, x y z in metres, quaternion w x y z",
                 X_BF, kPlace_m);
  }
};

struct TouchEntry {
  std::string on = "floor";
  std::vector<double> p_BTip;
  void Visit(ConfigVisitor& v) {
    v.Choice("on", "what the tip touches", on, {"floor", "wall"});
    v.NumbersOrNone("p_BTip", "the tip in the base: x y z in metres", p_BTip, 3, kPlace_m);
  }
};

/// What the file may hold beside its tables: nothing.
struct NoEntry {
  void Visit(ConfigVisitor&) {}
};

[[noreturn]] void RefuseEntry(const ConfigSource& source, const std::string& problem) {
  throw Error(ErrorKind::kConfig, source.place() + ": " + problem);
}

RigidTransform FlangeOf(const ViewEntry& entry, const ConfigSource& source, const ArmModel& arm) {
  if (entry.joints_deg.empty() == entry.X_BF.empty()) {
    RefuseEntry(source, std::string("[[view]]: ") +
                            (entry.X_BF.empty() ? "neither joints_deg nor X_BF is"
                                                : "both joints_deg and X_BF are") +
                            " given, one of them is needed: where the arm was for that cloud");
  }
  if (!entry.X_BF.empty()) return PoseOfNumbers(entry.X_BF);
  JointVector q;
  for (int i = 0; i < kNumJoints; ++i) {
    const ArmModel::Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    q[i] = Radians(entry.joints_deg[static_cast<std::size_t>(i)]);
    if (q[i] >= joint.lower_rad && q[i] <= joint.upper_rad) continue;
    RefuseEntry(source, "[[view]]: joints_deg: joint " + std::to_string(i + 1) + " is at " +
                            Number(entry.joints_deg[static_cast<std::size_t>(i)]) +
                            ", the arm's allowed are " + Number(Degrees(joint.lower_rad)) + " to " +
                            Number(Degrees(joint.upper_rad)));
  }
  return FlangePose(arm, q);
}

CalibrationTouch TouchOf(const ConfigSource& source, std::size_t number) {
  TouchEntry entry;
  source.ReadInto(entry);
  if (entry.p_BTip.empty()) {
    RefuseEntry(source, "[[touch]]: p_BTip is missing: where the tip was, x y z in the base");
  }
  const std::vector<double>& p = entry.p_BTip;
  return {"touch " + std::to_string(number + 1), entry.on == "floor", Vector3(p[0], p[1], p[2])};
}

/// Adds text to the folder's file, which is a views file or not there.
void Append(const std::string& folder, const std::string& text) {
  MakeFolder(folder);
  const std::string path = ViewsFileOf(folder);
  std::string all = "# Views and touches for `tubetwin calibrate`, which adds to them.\n";
  if (fs::exists(path)) {
    all = ReadFile(path);
    ConfigSource source;
    source.AddText(all, path);
    source.TakeTables("view");
    source.TakeTables("touch");
    NoEntry none;
    source.ReadInto(none);
    if (!all.empty() && all.back() != '\n') all += '\n';
  }
  WriteFileAtomically(path, all + text);
}

template <class Numbers>
std::string ListOf(const Numbers& numbers) {
  std::vector<std::string> out;
  for (const double number : numbers) out.push_back(Number(number));
  return "[" + Join(out) + "]";
}

}  // namespace

std::string ViewsFileOf(const std::string& folder_or_file) {
  return fs::is_regular_file(folder_or_file) ? folder_or_file
                                             : (fs::path(folder_or_file) / kViewsFile).string();
}

void ReadViewsFile(const std::string& folder_or_file, const ArmModel& arm, const std::string& units,
                   CalibrationInput& input) {
  ConfigSource source;
  source.AddFile(ViewsFileOf(folder_or_file));
  for (const ConfigSource& table : source.TakeTables("view")) {
    ViewEntry entry;
    table.ReadInto(entry);
    if (entry.cloud.empty()) RefuseEntry(table, "[[view]]: cloud is missing: the file of a cloud");
    CalibrationView view;
    view.X_BF = FlangeOf(entry, table, arm);
    view.name = entry.cloud;
    try {
      view.cloud = ReadCloud(entry.cloud, MetresPer(units));
    } catch (const Error& error) {
      throw Error(error.kind(), table.place() + ": cloud: " + error.what());
    }
    input.views.push_back(std::move(view));
  }
  for (const ConfigSource& table : source.TakeTables("touch")) {
    input.touches.push_back(TouchOf(table, input.touches.size()));
  }
  NoEntry none;
  source.ReadInto(none);
}

std::string AddView(const std::string& folder, const OrganizedCloud& cloud, const JointVector& q) {
  MakeFolder(folder);
  std::string name;
  for (int number = 0; name.empty() || fs::exists(fs::path(folder) / name); ++number) {
    name = "view_" + std::to_string(number) + ".pcd";
  }
  const std::string path = (fs::path(folder) / name).string();
  WritePcd(cloud, path);
  std::vector<double> joints_deg;
  for (const double angle : q) joints_deg.push_back(std::round(1e4 * Degrees(angle)) / 1e4);
  Append(folder, "\n[[view]]\ncloud = \"" + name + "\"\njoints_deg = " + ListOf(joints_deg) + "\n");
  return path;
}

void AddTouch(const std::string& folder, const CalibrationTouch& touch) {
  std::vector<double> p;
  for (const double x : touch.p_B) p.push_back(std::round(1e6 * x) / 1e6);
  Append(folder, std::string("\n[[touch]]\non = \"") + (touch.on_floor ? "floor" : "wall") +
                     "\"\np_BTip = " + ListOf(p) + "\n");
}

}  // namespace tubetwin

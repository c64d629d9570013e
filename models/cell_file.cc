// Reads cell files, the only place that knows their format.

#include <cmath>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/cell_model.h"
#include "models/files/file_schema.h"
#include "models/model_file.h"

namespace tubetwin {
namespace {

using Pose7 = std::array<double, 7>;  // x y z, quaternion w x y z
using Pose4 = std::array<double, 4>;  // x y z, yaw in degrees
using Point = std::array<double, 3>;

constexpr Range kPlace{-20.0, 20.0}, kLength{0.005, 20.0};

template <std::size_t N>
std::array<double, N> NotGiven() {
  std::array<double, N> out;
  out.fill(kNotGiven);
  return out;
}

Vector3 ToVector(const Point& p) { return {p[0], p[1], p[2]}; }

RigidTransform ToPose(const Pose4& x) {
  return MakeTransform(RotZ(Radians(x[3])), Vector3(x[0], x[1], x[2]));
}

struct ToolEntry {
  Pose7 X_FK = NotGiven<7>(), X_FE = NotGiven<7>();
  void Visit(ConfigVisitor& v) {
    v.Pose("X_FK", "the sensor's tool face on the flange: x y z in metres, quaternion w x y z",
           X_FK, kPlace);
    v.Pose("X_FE", "the middle between the closed pads on the flange, likewise", X_FE, kPlace);
  }
};

struct MountEntry {
  std::string on;
  std::vector<double> X_FS, X_BS, p_BClear;
  void Visit(ConfigVisitor& v) {
    v.Choice("on", "what the scanner hangs on", on, {"flange", "stand"});
    v.PoseOrNone("X_FS",
                 "on the flange: the camera on the flange, x y z in metres, quaternion w x y z",
                 X_FS, kPlace);
    v.PoseOrNone("X_BS", "on a stand: the camera in the base, likewise", X_BS, kPlace);
    v.NumbersOrNone("p_BClear",
                    "on a stand: the pads while it looks, x y z, the tool pointing down", p_BClear,
                    3, kPlace);
  }
};

struct ScanEntry {
  double height_m = 0.0, covered_m = 0.0;
  CellLayout::ScanOffsets x, y;
  void Visit(ConfigVisitor& v) {
    v.Field("height_m", "camera over the floor in planned views", height_m, {0.0, 5.0});
    v.Field("covered_m", "planned views see everything up to this over the floor", covered_m,
            {0.0, 2.0});
    v.Field("offsets_x_m", "places of planned views along x of the base, from the bin's middle",
            x.offsets_m, 0, {-5.0, 5.0});
    v.Field("extent_x_m", "for bins whose extent along x lies between these", x.extent_m,
            {0.0, 5.0});
    v.Field("offsets_y_m", "likewise along y", y.offsets_m, 0, {-5.0, 5.0});
    v.Field("extent_y_m", "likewise along y", y.extent_m, {0.0, 5.0});
  }
};

struct BinEntry {
  Point size_m = NotGiven<3>();
  Pose4 X_BN = NotGiven<4>();
  void Visit(ConfigVisitor& v) {
    v.Field("size_m", "inner long, short and wall height in metres", size_m, {0.01, 3.0});
    v.Field("X_BN", "floor centre x y z in metres and yaw in degrees, in the base", X_BN);
  }
};

struct TrayEntry {
  Pose4 X_BT = NotGiven<4>();
  double size_m = kNotGiven, zone_m = kNotGiven, slot_pitch_m = kNotGiven;
  void Visit(ConfigVisitor& v) {
    v.Field("X_BT", "surface centre x y z in metres and yaw in degrees, in the base", X_BT);
    v.Field("size_m", "side of its square surface", size_m, kLength);
    v.Field("zone_m", "side of the square that the pads may reach", zone_m, kLength);
    v.Field("slot_pitch_m", "distance of neighbouring slots along its x", slot_pitch_m, kLength);
  }
};

struct StationEntry {
  Point p_BTilt = NotGiven<3>();
  void Visit(ConfigVisitor& v) {
    v.Field("p_BTilt", "the pads where several tubes are shaken off, x y z in the base", p_BTilt,
            kPlace);
  }
};

struct CarryEntry {
  double height_m = kNotGiven;
  void Visit(ConfigVisitor& v) {
    v.Field("height_m", "of the pads over the bin's floor while carrying", height_m, {0.05, 5.0});
  }
};

struct PlateEntry {
  double z_m = kNotGiven;
  std::array<double, 2> centre_m = NotGiven<2>(), size_m = NotGiven<2>();
  void Visit(ConfigVisitor& v) {
    v.Field("z_m", "upper face of the plate that all stands on, in the base", z_m, kPlace);
    v.Field("centre_m", "its middle, x y", centre_m, kPlace);
    v.Field("size_m", "its sides along x and y", size_m, kLength);
  }
};

struct CellEntry {
  std::string name, arm, gripper, wrist, scanner;
  ToolEntry tool;
  MountEntry mount;
  ScanEntry scan;
  BinEntry bin;
  TrayEntry tray;
  StationEntry station;
  CarryEntry carry;
  PlateEntry plate;

  void Visit(ConfigVisitor& v) {
    v.Field("name", "for messages and reports", name);
    v.Field("arm", "a shipped arm's name or an arm file", arm);
    v.Field("gripper", "a shipped gripper's name or a gripper file", gripper);
    v.Field("wrist", "a shipped force sensor's name or a sensor file", wrist);
    v.Field("scanner", "a shipped scanner's name or a scanner file", scanner);
    v.Section("tool", "how sensor and gripper hang on the flange", tool);
    v.Section("scanner_mount", "where the scanner is", mount);
    v.Section("scan", "planned views of a scanner on the flange", scan);
    v.Section("bin", "the bin, unless pile or configuration say another", bin);
    v.Section("tray", "where tubes are placed", tray);
    v.Section("station", "where several tubes are shaken off", station);
    v.Section("carry", "on the way", carry);
    v.Section("plate", "what the cell stands on", plate);
  }
};

struct KeepOutEntry {
  std::string name;
  Point centre_m = NotGiven<3>(), size_m = NotGiven<3>();
  double yaw_deg = 0.0;
  void Visit(ConfigVisitor& v) {
    v.Field("name", "for messages", name);
    v.Field("centre_m", "x y z in the base", centre_m, kPlace);
    v.Field("size_m", "length along its x, y, z", size_m, kLength);
    v.Field("yaw_deg", "about z", yaw_deg, {-360.0, 360.0});
  }
};

struct ScanPoseEntry {
  Pose7 X_BS = NotGiven<7>();
  void Visit(ConfigVisitor& v) {
    v.Pose("X_BS", "the camera in the base: x y z in metres, quaternion w x y z", X_BS, kPlace);
  }
};

RigidTransform PoseOf(const std::vector<double>& list, const std::string& path, const char* key,
                      const std::string& when) {
  if (list.empty()) {
    RefuseFile(path, std::string("scanner_mount.") + key + " is missing; " + when +
                         " it is needed: x y z, quaternion w x y z");
  }
  return PoseOfNumbers(list);
}

void SetMount(const MountEntry& entry, const std::string& path, CellLayout& layout) {
  if (entry.on == "flange") {
    if (!entry.X_BS.empty() || !entry.p_BClear.empty()) {
      RefuseFile(path, "scanner_mount.X_BS and p_BClear are for a stand; on is \"flange\"");
    }
    layout.scanner_mount = CellLayout::ScannerMount::kFlange;
    layout.X_FS = PoseOf(entry.X_FS, path, "X_FS", "on the flange");
    return;
  }
  if (!entry.X_FS.empty())
    RefuseFile(path, "scanner_mount.X_FS is for the flange; on is \"stand\"");
  layout.scanner_mount = CellLayout::ScannerMount::kStand;
  layout.X_BS = PoseOf(entry.X_BS, path, "X_BS", "on a stand");
  if (entry.p_BClear.empty()) {
    RefuseFile(path,
               "scanner_mount.p_BClear is missing; on a stand it is needed: x y z of the "
               "pads while it looks");
  }
  layout.p_BClear = {entry.p_BClear[0], entry.p_BClear[1], entry.p_BClear[2]};
}

void SetScan(const ScanEntry& entry, const std::vector<ConfigSource>& poses,
             const std::string& path, CellLayout& layout) {
  const bool flange = layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  if (!flange && (!poses.empty() || entry.height_m > 0.0)) {
    RefuseFile(path,
               "[scan] and [[scan_pose]] are for a scanner on the flange; this one is on a stand");
  }
  if (flange && poses.empty() && entry.height_m <= 0.0) {
    RefuseFile(path,
               "scan.height_m is missing: the camera's height over the floor in planned views is "
               "needed, or [[scan_pose]] tables");
  }
  layout.scan_height_m = entry.height_m;
  layout.scan_covered_m = entry.covered_m;
  layout.scan_offsets_x = entry.x;
  layout.scan_offsets_y = entry.y;
  for (const ConfigSource& source : poses) {
    ScanPoseEntry pose;
    source.ReadInto(pose);
    RequireGiven([&](ConfigVisitor& v) { pose.Visit(v); }, path + ": [[scan_pose]]");
    layout.scan_poses_BS.push_back(PoseOfNumbers(pose.X_BS));
  }
}

CellLayout::KeepOut ReadKeepOut(const ConfigSource& source, const std::string& path) {
  KeepOutEntry entry;
  source.ReadInto(entry);
  RequireGiven([&](ConfigVisitor& v) { entry.Visit(v); }, path + ": [[keep_out]]");
  return {entry.name, MakeTransform(RotZ(Radians(entry.yaw_deg)), ToVector(entry.centre_m)),
          0.5 * ToVector(entry.size_m)};
}

CellLayout LayoutOf(const CellEntry& entry, const std::vector<ConfigSource>& scan_poses,
                    const std::vector<ConfigSource>& keep_out, const std::string& path) {
  CellLayout layout;
  layout.X_FK = PoseOfNumbers(entry.tool.X_FK);
  layout.X_FE = PoseOfNumbers(entry.tool.X_FE);
  SetMount(entry.mount, path, layout);
  SetScan(entry.scan, scan_poses, path, layout);
  layout.bin_size_m = entry.bin.size_m;
  layout.X_BN = ToPose(entry.bin.X_BN);
  layout.X_BT = ToPose(entry.tray.X_BT);
  layout.tray_size_m = entry.tray.size_m;
  layout.tray_zone_m = entry.tray.zone_m;
  layout.slot_pitch_m = entry.tray.slot_pitch_m;
  layout.p_BTilt = ToVector(entry.station.p_BTilt);
  layout.carry_height_m = entry.carry.height_m;
  layout.plate_z_m = entry.plate.z_m;
  layout.plate_centre_m = entry.plate.centre_m;
  layout.plate_size_m = entry.plate.size_m;
  for (const ConfigSource& source : keep_out) {
    layout.keep_out.push_back(ReadKeepOut(source, path));
  }
  return layout;
}

/// A device file of a cell file: relative names are relative to the cell file.
std::string BesideCell(const std::string& name, const ModelFile& cell) {
  const std::filesystem::path path(name);
  if (!name.ends_with(".toml") || path.is_absolute() || cell.shipped) return name;
  return (std::filesystem::path(cell.path).parent_path() / path).string();
}

/// A cell file's content, without the devices.
struct CellText {
  CellEntry entry;
  std::vector<ConfigSource> scan_poses, keep_out;

  explicit CellText(const ModelFile& file) {
    ConfigSource source = file.Source();
    scan_poses = source.TakeTables("scan_pose");
    keep_out = source.TakeTables("keep_out");
    source.ReadInto(entry);
    RequireGiven([this](ConfigVisitor& v) { entry.Visit(v); }, file.path);
  }
};

}  // namespace

Json CellFileSchema() {
  CellEntry cell;
  ScanPoseEntry pose;
  KeepOutEntry keep_out;
  const auto schema_of = [](auto& entry) {
    return TableSchema([&entry](ConfigVisitor& v) { entry.Visit(v); });
  };
  Json schema = schema_of(cell);
  AddTables("scan_pose", "a view of a scanner on the flange, in place of planned ones",
            schema_of(pose), 0, 0, schema);
  AddTables("keep_out", "a box that nothing may touch", schema_of(keep_out), 0, 0, schema);
  return schema;
}

CellModel ReadCellModel(const CellFiles& files) {
  const CellText text(files.cell);
  CellModel model;
  model.name = text.entry.name;
  model.files = files;
  model.arm = ReadArm(files.arm);
  model.gripper = ReadGripper(files.gripper);
  model.wrist = ReadWrist(files.wrist);
  model.scanner = ReadScanner(files.scanner);
  model.layout = LayoutOf(text.entry, text.scan_poses, text.keep_out, files.cell.path);
  return model;
}

CellModel LoadCellModel(const std::string& name_or_path) {
  CellFiles files;
  files.cell = OpenModelFile("cells", name_or_path, "cell model");
  const CellEntry entry = CellText(files.cell).entry;
  const auto open = [&](const char* folder, const std::string& name, const char* what) {
    return OpenModelFile(folder, BesideCell(name, files.cell), what);
  };
  files.arm = open("arms", entry.arm, "arm");
  files.gripper = open("grippers", entry.gripper, "gripper");
  files.wrist = open("wrists", entry.wrist, "force sensor");
  files.scanner = open("scanners", entry.scanner, "scanner");
  return ReadCellModel(files);
}

std::vector<std::string> CellModelNames() { return ModelFileNames("cells"); }

}  // namespace tubetwin

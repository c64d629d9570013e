#include "twin/round/cell_config.h"

#include <array>

#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/frames.h"
#include "models/mesh/mesh.h"
#include "models/shape.h"

namespace tubetwin {
namespace {

std::vector<std::string> MeshUnitChoices() {
  std::vector<std::string> units = LengthUnits();
  units.insert(units.begin(), "");
  return units;
}

/// Calls `see` with each of the four roles.
template <class See>
void ForEachRole(const CellConfig& cell, See see) {
  see(cell.arm);
  see(cell.gripper);
  see(cell.wrist);
  see(cell.scanner);
}

}  // namespace

CellConfig::CellConfig(const DeviceDrivers& drivers) {
  arm.drivers = drivers.arm;
  gripper.drivers = drivers.gripper;
  wrist.drivers = drivers.wrist;
  scanner.drivers = drivers.scanner;
}

void CellConfig::Arm::Visit(ConfigVisitor& v) {
  CellRole::Visit(v);
  v.Field("armed", "a person's word that this arm may move; without it nothing is sent to it",
          armed);
  v.Field("start_speed_m_s",
          "a real arm's fingers move no faster until the first tube is placed; 0: as planned",
          start_speed_m_s, {0, 2});
  v.Files("visual_meshes",
          "meshes (STL, OBJ, PLY) of base and links 1 to 6 in their own frames, for pictures; "
          "empty texts: plain shapes",
          visual_meshes);
  v.Choice("visual_units", "unit of the meshes; empty: metres", visual_units, MeshUnitChoices());
}

void CellConfig::Scanner::Visit(ConfigVisitor& v) {
  CellRole::Visit(v);
  v.Field("hand_eye_error", "error of the scanner's pose against what [physics] draws; 0: none",
          hand_eye_error, {0, 100});
  effects.Visit(v);
}

void CellConfig::Visit(ConfigVisitor& v) {
  v.NameOrFile("model",
               "what the cell is like: the name of a shipped cell model or the file of one; the "
               "other keys say how to reach its devices",
               model);
  v.File("recording", "cell.rec.zst that devices with the driver replay answer from", recording);
  v.Section("arm", "the arm", arm);
  v.Section("gripper", "the gripper", gripper);
  v.Section("wrist", "the force/torque sensor", wrist);
  v.Section("scanner", "the scanner", scanner);
  v.Section("safety", "what stops the arm", safety);
}

bool CellConfig::IsTwin() const {
  bool all = true;
  ForEachRole(*this, [&](const auto& role) { all = all && role.IsTwin(); });
  return all;
}

bool CellConfig::HasTwin() const {
  bool any = false;
  ForEachRole(*this, [&](const auto& role) { any = any || role.IsTwin(); });
  return any;
}

void CellConfig::ValidateOrThrow() const {
  int replayed = 0;
  ForEachRole(*this, [&](const auto& role) { replayed += role.IsReplay() ? 1 : 0; });
  if (replayed != 0 && replayed != 4) {
    throw Error(ErrorKind::kConfig,
                "cell: " + std::to_string(replayed) +
                    " of 4 devices have the driver 'replay'; a recording answers what the whole "
                    "cell was asked, so it is all or none");
  }
  if (replayed == 4 && recording.empty()) {
    throw Error(ErrorKind::kConfig,
                "cell.recording: is empty; the driver 'replay' needs a recording (cell.rec.zst)");
  }
  ForEachRole(*this, [](const auto& role) {
    if (role.IsDevice()) role.Chosen().ValidateOrThrow(role.driver);
  });
}

void CalibrationConfig::Visit(ConfigVisitor& v) {
  v.PoseOrNone("X_FK",
               "the sensor's tool face on the flange: x y z in metres, quaternion w x y z; "
               "empty: the cell model's",
               X_FK);
  v.PoseOrNone("X_FE", "the middle between the closed pads on the flange, likewise", X_FE);
  v.PoseOrNone("X_FS", "the camera of a scanner on the flange, likewise", X_FS);
  v.PoseOrNone("X_BS", "the camera of a scanner on a stand in the robot's base, likewise", X_BS);
}

void CalibrationConfig::ApplyTo(CellLayout& layout) const {
  const auto set = [](const std::vector<double>& x, RigidTransform& pose) {
    if (!x.empty()) pose = PoseOfNumbers(x);
  };
  const bool flange = layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  if (!(flange ? X_BS : X_FS).empty()) {
    throw Error(ErrorKind::kConfig,
                flange ? "calibration.X_BS: is given, but the cell model's scanner hangs on the "
                         "flange; its pose is X_FS"
                       : "calibration.X_FS: is given, but the cell model's scanner is on a stand; "
                         "its pose is X_BS");
  }
  set(X_FK, layout.X_FK);
  set(X_FE, layout.X_FE);
  set(X_FS, layout.X_FS);
  set(X_BS, layout.X_BS);
}

}  // namespace tubetwin

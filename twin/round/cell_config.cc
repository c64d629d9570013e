#include "twin/round/cell_config.h"

#include <array>

#include "models/base/error.h"
#include "models/base/frames.h"
#include "models/layout.h"
#include "models/mesh/mesh.h"

namespace tubetwin {
namespace {

std::vector<std::string> MeshUnitChoices() {
  std::vector<std::string> units = MeshUnits();
  units.insert(units.begin(), "");
  return units;
}

std::vector<double> PoseNumbers(const RigidTransform& X_AB) {
  const Vector3 p = X_AB.translation();
  const std::array<double, 4> q = QuaternionWxyz(X_AB.linear());
  return {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]};
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
  v.Field("visual_meshes",
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
  v.Field("recording", "cell.rec.zst that devices with the driver replay answer from", recording);
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

CalibrationConfig::CalibrationConfig()
    : X_FK(PoseNumbers(CellLayout().X_FK)),
      X_FE(PoseNumbers(CellLayout().X_FE)),
      X_FS(PoseNumbers(CellLayout().X_FS)) {}

void CalibrationConfig::Visit(ConfigVisitor& v) {
  v.Field("X_FK", "the sensor's tool face on the flange: x y z in metres, quaternion w x y z", X_FK,
          7);
  v.Field("X_FE", "the middle between the closed pads on the flange, likewise", X_FE, 7);
  v.Field("X_FS", "the scanner's camera on the flange, likewise", X_FS, 7);
}

}  // namespace tubetwin

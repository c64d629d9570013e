#include "twin/round/cell_config.h"

#include <array>

#include "models/base/error.h"
#include "models/base/frames.h"
#include "models/layout.h"
#include "models/mesh/mesh.h"

namespace tubetwin {
namespace {

constexpr Range kPort = {1, 65535};

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

std::array<const std::string*, 4> Drivers(const CellConfig& cell) {
  return {&cell.arm.driver, &cell.gripper.driver, &cell.wrist.driver, &cell.scanner.driver};
}

int Count(const CellConfig& cell, const char* driver) {
  int count = 0;
  for (const std::string* chosen : Drivers(cell)) count += *chosen == driver ? 1 : 0;
  return count;
}

}  // namespace

void CellConfig::Arm::Visit(ConfigVisitor& v) {
  v.Choice("driver", "twin, a Yaskawa controller with MotoROS, or a recording", driver,
           {"twin", "simple_message", "replay"});
  v.Field("host", "address of the controller", host);
  v.Field("motion_port", "TCP, trajectories", motion_port, kPort);
  v.Field("state_port", "TCP, joints and status", state_port, kPort);
  v.Field("io_port", "TCP, inputs and outputs", io_port, kPort);
  v.Field("hses_port", "UDP, high-speed Ethernet server", hses_port, kPort);
  v.Field("pulses_per_degree", "of the encoders, for the controller's 30-pulse rules",
          pulses_per_degree, {1, 1e6});
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

void CellConfig::Gripper::Visit(ConfigVisitor& v) {
  v.Choice("driver", "twin, a Robotiq 2F-85 by serial line or network, or a recording", driver,
           {"twin", "modbus_rtu", "modbus_tcp", "replay"});
  v.Field("host", "modbus_tcp: address", host);
  v.Field("port", "modbus_tcp: port", port, kPort);
  v.Field("device", "modbus_rtu: serial device", device);
  v.Field("slave", "Modbus address", slave, {1, 247});
}

void CellConfig::Wrist::Visit(ConfigVisitor& v) {
  v.Choice("driver", "twin, an ATI Net F/T box, or a recording", driver, {"twin", "rdt", "replay"});
  v.Field("host", "address of the box", host);
  v.Field("port", "UDP, wrenches", port, kPort);
  v.Field("http_port", "TCP, the box's configuration page", http_port, kPort);
  v.Field("counts_per_N", "of the box's configuration", counts_per_N, {1, 1e9});
  v.Field("counts_per_Nm", "of the box's configuration", counts_per_Nm, {1, 1e9});
}

void CellConfig::Scanner::Visit(ConfigVisitor& v) {
  v.Choice("driver",
           "twin, a Photoneo PhoXi by a folder of saved scans or by GigE Vision, or a recording",
           driver, {"twin", "folder", "gige", "replay"});
  v.Field("host", "gige: IPv4 address", host);
  v.Field("path", "folder: where scans are asked for and saved", path);
  v.Field("timeout_s", "from a trigger to its whole scan", timeout_s, {0.1, 600});
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

bool CellConfig::IsTwin() const { return Count(*this, "twin") == 4; }
bool CellConfig::HasTwin() const { return Count(*this, "twin") > 0; }

void CellConfig::ValidateOrThrow() const {
  const int replayed = Count(*this, "replay");
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
  if (scanner.driver == "folder" && scanner.path.empty()) {
    throw Error(ErrorKind::kConfig,
                "cell.scanner.path: is empty; the driver 'folder' needs the folder of the scans");
  }
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

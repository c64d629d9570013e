#pragma once

#include <string>
#include <vector>

#include "hw_bridge/cell/safety.h"
#include "models/base/config/config.h"
#include "models/scanner_effects.h"

namespace tubetwin {

/// Which device serves each role of the cell and how it is reached: tables [cell.*]. Keys that a
/// driver does not need are ignored by it.
struct CellConfig {
  struct Arm {
    std::string driver = "twin";
    std::string host = "192.168.1.31";  ///< Factory address of the controller.
    int motion_port = 50240, state_port = 50241, io_port = 50242, hses_port = 10040;
    double pulses_per_degree = 1000.0;
    bool armed = false;
    double start_speed_m_s = 0.25;  ///< Of a real arm, until its first tube is placed.
    /// Base and links 1 to 6 in their own frames (models/arm/hc10.toml), for pictures; empty
    /// texts: plain shapes.
    std::vector<std::string> visual_meshes;
    std::string visual_units;
    void Visit(ConfigVisitor& v);
  } arm;
  struct Gripper {
    std::string driver = "twin";
    std::string host = "192.168.1.11";
    int port = 1502;
    std::string device = "/dev/ttyUSB0";  ///< modbus_rtu.
    int slave = 9;
    void Visit(ConfigVisitor& v);
  } gripper;
  struct Wrist {
    std::string driver = "twin";
    std::string host = "192.168.1.1";  ///< Factory address of the Net F/T box.
    int port = 49152, http_port = 8049;
    double counts_per_N = 1e6, counts_per_Nm = 1e6;
    void Visit(ConfigVisitor& v);
  } wrist;
  struct Scanner {
    std::string driver = "twin";
    std::string host = "192.168.1.27";
    std::string path;             ///< folder; relative to the file that names it.
    double timeout_s = 10.0;      ///< From a trigger to its whole scan, cell time.
    double hand_eye_error = 1.0;  ///< Of what [physics] draws; 0: none.
    ScannerEffects effects;
    void Visit(ConfigVisitor& v);
  } scanner;
  std::string recording;  ///< What devices with the driver "replay" answer from.
  SafetyLimits safety;

  void Visit(ConfigVisitor& v);

  /// Every device is the twin's.
  bool IsTwin() const;
  /// Any device is the twin's.
  bool HasTwin() const;
  /// Throws Error(kConfig) for what the keys' own ranges cannot say: a recording is replayed by all
  /// four devices or none, and needs its file.
  void ValidateOrThrow() const;
};

/// How the tools hang on the flange, table [calibration]: x y z in metres and the quaternion w x y
/// z. On the twin the cell is built so; on a real cell it is what was measured.
struct CalibrationConfig {
  std::vector<double> X_FK, X_FE, X_FS;
  CalibrationConfig();
  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin

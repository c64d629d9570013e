#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/cell/safety.h"
#include "hw_bridge/drivers/registry.h"
#include "models/base/config/config.h"
#include "models/scanner_effects.h"

namespace tubetwin {

/// Who serves one role of the cell: the twin, a recording, or a device by one of the registered
/// drivers.
template <class Device>
struct CellRole {
  std::string driver = "twin";  ///< "twin", "replay", or the name of a driver's link.
  DriverList<Device> drivers;   ///< Those to choose from, each with the values of its keys.

  bool IsTwin() const { return driver == "twin"; }
  bool IsReplay() const { return driver == "replay"; }
  /// A device of its own, by a registered driver.
  bool IsDevice() const { return !IsTwin() && !IsReplay(); }
  /// Precondition: IsDevice().
  const DeviceDriver<Device>& Chosen() const { return drivers.Of(driver); }
  DriverLink Link() const {
    for (const DriverLink& link : Chosen().Links()) {
      if (link.name == driver) return link;
    }
    return {};
  }
  std::unique_ptr<Device> Connect(const DriverContext& context) const {
    return Chosen().Connect(driver, context);
  }
  /// The key `driver`, then the drivers' own keys.
  void Visit(ConfigVisitor& v) {
    std::vector<std::string> allowed = drivers.Names();
    allowed.insert(allowed.begin(), "twin");
    allowed.push_back("replay");
    v.Choice("driver", ("twin, " + drivers.Summary() + ", or a recording").c_str(), driver,
             allowed);
    drivers.Visit(v);
  }
};

/// Which device serves each role of the cell and how it is reached: tables [cell.*]. Keys that a
/// driver does not need are ignored by it.
struct CellConfig {
  explicit CellConfig(const DeviceDrivers& drivers = BuiltInDrivers());

  struct Arm : CellRole<tubetwin::Arm> {
    bool armed = false;
    double start_speed_m_s = 0.25;  ///< Of a real arm, until its first tube is placed.
    /// Base and links 1 to 6 in their own frames (models/arms/hc10.toml), for pictures; empty
    /// texts: plain shapes.
    std::vector<std::string> visual_meshes;
    std::string visual_units;
    void Visit(ConfigVisitor& v);
  } arm;
  CellRole<tubetwin::Gripper> gripper;
  CellRole<ForceTorqueSensor> wrist;
  struct Scanner : CellRole<tubetwin::Scanner> {
    double hand_eye_error = 1.0;  ///< Of what [physics] draws; 0: none.
    ScannerEffects effects;
    void Visit(ConfigVisitor& v);
  } scanner;
  std::string model = "leao2020";  ///< Cell model: a shipped one's name, or a file.
  std::string recording;           ///< What devices with the driver "replay" answer from.
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

/// How tools and scanner hang, table [calibration]: x y z in metres and the quaternion w x y z;
/// empty: the cell model's. On the twin the cell is built so; on a real cell it is what was
/// measured.
struct CalibrationConfig {
  std::vector<double> X_FK, X_FE;
  std::vector<double> X_FS;  ///< Of a scanner on the flange.
  std::vector<double> X_BS;  ///< Of one on a stand.

  void Visit(ConfigVisitor& v);
  /// Throws Error(kConfig) for a quaternion that is not of length one, and for a pose of a scanner
  /// that hangs elsewhere.
  void ApplyTo(CellLayout& layout) const;
};

}  // namespace tubetwin

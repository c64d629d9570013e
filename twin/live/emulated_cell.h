#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "hw_bridge/emulators/ati/wrist_emulator.h"
#include "hw_bridge/emulators/photoneo/scanner_emulator.h"
#include "hw_bridge/emulators/robotiq/gripper_emulator.h"
#include "hw_bridge/emulators/yaskawa/arm_emulator.h"
#include "models/base/json_fwd.h"
#include "twin/cell/twin_cell.h"
#include "twin/live/cycle_moments.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// Where an emulated cell can be found.
struct EmulationPlaces {
  std::string listen = "127.0.0.1";  ///< Address of every port.
  bool any_ports = false;            ///< Free ports instead of those of [cell.*].
  std::string folder;                ///< Absolute: scans/ and, by serial line, gripper.tty.
  bool gige = false;  ///< The scanner on GigE Vision, UDP 3956 always, instead of scans/.
};

/// A twin whose four devices are served on their wire protocols, by the ports of the scenario's
/// [cell.*]; a gripper of modbus_rtu on a pseudo-terminal. One thread.
class EmulatedCell {
 public:
  /// Listens at once. `twin` must outlive it. Throws Error(kDevice) when a port cannot be had.
  EmulatedCell(TwinCell& twin, const Scenario& scenario, const EmulationPlaces& places);
  ~EmulatedCell();

  /// One control period: what the network brought, physics, what the devices send.
  void Step();
  /// What the network brought, without letting time pass.
  void Poll();
  TimeNs now() const;

  /// Hears the moments of the cycle, and "arm moves", "arm rests".
  void OnMoment(std::function<void(const std::string& moment)> hear);

  ArmEmulator& arm();
  GripperEmulator& gripper();
  WristEmulator& wrist();
  ScannerEmulator& scanner();

  /// The scenario with devices that reach this cell, for a cell file.
  Scenario Reaching() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

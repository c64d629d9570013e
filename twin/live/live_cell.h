#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "models/base/json_fwd.h"
#include "models/base/parallel.h"
#include "twin/round/scenario.h"

namespace tubetwin {

enum class CellPurpose {
  kRun,   ///< To pick: the gripper is activated, the arm must be armed.
  kLook,  ///< Nothing moves: the arm gets no byte on its motion port, the gripper stays as it is.
};

/// What the drivers of the scenario's cell are connected with. For a scanner believed_X_NS is to be
/// filled in. References are kept.
DriverContext ScenarioContext(const Scenario& scenario, const CellModel& model,
                              const CellClock& clock, CellPurpose purpose);

/// The device of a role as DeviceLock knows it, "wrist 192.168.1.1:49152"; empty: it is the twin's,
/// or nobody needs to own it.
template <class Role>
std::string DeviceToOwn(const std::string& name, const Role& role) {
  const std::string place = role.IsDevice() ? role.Chosen().Owned(role.driver) : "";
  return place.empty() ? "" : name + " " + place;
}

/// Throws Error(kConfig, exit 78) unless the scenario's arm may move: it is the twin's or a
/// recording's, or armed.
void RequireArmed(const Scenario& scenario);

/// The cell that a scenario chooses, device by device: real (or emulated) ones, and a twin of the
/// scenario's pile for the others, in time with the wall. Its clock runs `rate` times as fast. The
/// twin's arm follows a real one, so that the twin's scanner, wrist and fingers are on it.
class LiveCell {
 public:
  /// A person's word for what `what` says; see DriverContext.
  using Confirm = std::function<bool(const std::string& what)>;
  /// Owns the devices (DeviceLock) until its end; for kLook all but the arm. Throws as DeviceLock,
  /// the drivers' Connect, RequireArmed (for kRun), ScenarioPile and TwinCell do. Precondition: no
  /// device is "replay".
  LiveCell(const Scenario& scenario, CellPurpose purpose, Parallelism parallelism,
           const Confirm& confirm = {});
  ~LiveCell();
  Cell& cell();
  /// What came over the links so far and what was lost, as the drivers count it: {gripper:
  /// {unanswered, problem}, wrist: {samples, lost, ...}}. Devices that are the twin's, or that
  /// count nothing, are missing.
  Json Links() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

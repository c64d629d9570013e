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

// One device each, by the scenario's [cell.*], whose driver is not "twin" or "replay". They throw
// Error(kConfig), and Error(kDevice) naming device, place and what was awaited, within 10 s.
// References must outlive the device; the clock tells Now() to any thread.
std::unique_ptr<Arm> ConnectArm(const Scenario& scenario, const ArmModel& model,
                                const CellClock& clock, CellPurpose purpose);
std::unique_ptr<Gripper> ConnectGripper(const Scenario& scenario, const CellClock& clock,
                                        CellPurpose purpose);
std::unique_ptr<ForceTorqueSensor> ConnectWrist(const Scenario& scenario, const CellClock& clock);
/// `believed_X_NS`: where the scanner is now. `folder`: of relative paths.
std::unique_ptr<Scanner> ConnectScanner(const Scenario& scenario, const std::string& folder,
                                        std::function<RigidTransform()> believed_X_NS);

/// Throws Error(kConfig, exit 78) unless the scenario's arm may move: it is the twin's or a
/// recording's, or armed.
void RequireArmed(const Scenario& scenario);

/// The cell that a scenario chooses, device by device: real (or emulated) ones, and a twin of the
/// scenario's pile for the others, in time with the wall. Its clock runs `rate` times as fast.
class LiveCell {
 public:
  /// `scenario_folder`, `cell_folder`: of relative names in the scenario and in the cell file.
  /// Throws as the functions above, RequireArmed (for kRun), ScenarioPile and TwinCell do.
  /// Precondition: no device is "replay".
  LiveCell(const Scenario& scenario, const std::string& scenario_folder,
           const std::string& cell_folder, CellPurpose purpose, Parallelism parallelism);
  ~LiveCell();
  Cell& cell();
  /// What came over the links so far and what was lost: {gripper: {unanswered, problem}, wrist:
  /// {samples, lost, late, malformed, faulty}}; devices that are the twin's are missing.
  Json Links() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin

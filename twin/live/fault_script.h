#pragma once

#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/base/time.h"
#include "twin/live/emulated_cell.h"

namespace tubetwin {

/// One fault of a script, a table [[fault]].
struct ScriptedFault {
  double at_s = -1.0;    ///< Cell time since the start; negative: `on` says when.
  std::string on;        ///< A moment of CycleMoments.
  int nth = 1;           ///< Which of these moments, counted from 1.
  double delay_s = 0.0;  ///< After the moment, cell time.
  std::string device;    ///< FaultDevices().
  std::string action;    ///< FaultActions(device).
  double value = 0.0;    ///< delay, late: seconds; alarm, refuse, fault, status: the code.
  int count = 1;         ///< refuse: points; scans: how many; skip: records.
  double for_s = 0.0;    ///< Undone after so long, cell time; 0: it stays.
  void Visit(ConfigVisitor& v);
};

/// "arm", "arm.motion", "arm.state", "arm.io", "arm.supervision", "gripper", "gripper.link",
/// "wrist", "wrist.link", "scanner", "scanner.link": a device, or what it sends and receives.
const std::vector<std::string>& FaultDevices();
/// What can happen to a device. Precondition: one of FaultDevices().
std::vector<std::string> FaultActions(const std::string& device);

/// Does to `cell` what the fault says, or undoes it (nothing where there is nothing to undo: a lost
/// connection, a refused point).
void ApplyFault(EmulatedCell& cell, const ScriptedFault& fault, bool undo);

/// The faults of a script file. Throws Error(kMissing), Error(kConfig) with file:line:column for
/// what the script gets wrong.
std::vector<ScriptedFault> ReadFaultScript(const std::string& path);

/// Carries a script out on an emulated cell. One thread.
class FaultScript {
 public:
  explicit FaultScript(std::vector<ScriptedFault> faults);

  /// A moment has come.
  void Hear(const std::string& moment, TimeNs now);
  /// Carries out what is due. What was done, as lines for a log: "arm.motion freeze", "arm.motion
  /// freeze undone".
  std::vector<std::string> Act(EmulatedCell& cell, TimeNs now);
  int done() const { return done_; }  ///< Faults that have begun.

 private:
  struct Pending {
    ScriptedFault fault;
    TimeNs due{-1};  ///< Negative: waits for its moment.
    bool begun = false, over = false;
    int heard = 0;
  };
  std::vector<Pending> pending_;
  int done_ = 0;
};

}  // namespace tubetwin

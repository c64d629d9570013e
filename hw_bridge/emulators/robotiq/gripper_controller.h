#pragma once

#include <cstdint>
#include <vector>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/codecs/robotiq_registers.h"
#include "hw_bridge/emulators/robotiq/modbus_slave.h"

namespace tubetwin {

/// The controller of a Robotiq 2F gripper: reads commands from its registers, moves the fingers of
/// any Gripper, writes states. Activation opens, closes and opens the fingers. Without rACT or
/// rGTO, and in a major fault, moving fingers stop where they are; fingers that press keep
/// pressing.
class GripperController : public ModbusRegisters {
 public:
  /// `gripper` must outlive it.
  GripperController(Gripper& gripper, const GripperScale& scale,
                    int action_start = kGripperActionStart, int status_start = kGripperStatusStart)
      : gripper_(gripper),
        scale_(scale),
        action_start_(action_start),
        status_start_(status_start) {}

  // Of a client: 16 registers from `status_start` to read and as many from `action_start` to write
  // and read, of which the first three mean something, the others are 0. Where the two overlap,
  // reading reads the status.
  bool IsReadable(int start, int count) const override;
  bool IsWritable(int start, int count) const override;
  std::vector<std::uint16_t> Read(int start, int count) override;
  void Write(int start, const std::vector<std::uint16_t>& values) override;

  /// A request of a client has come in. Silence of 1 s is fault 0x09, reported once.
  void Heard(TimeNs now);
  /// After every control period.
  void Tick(TimeNs now);

  GripperStatus Status() const;

  // What fault scripts do.
  /// 0x05 to 0x0F. From 0x0A on the gripper does nothing until it is activated anew; others last
  /// until ClearFault().
  void RaiseFault(int code);
  void ClearFault();
  /// Until the next request the registers say that the fingers have closed on nothing.
  void LoseObject() { lost_ = true; }

 private:
  enum class Phase { kReset, kActivating, kActive, kReleasing, kReleased };
  void Take(const GripperAction& action);
  void Execute();
  void Halt();
  void Move(double opening_m, double speed_m_s, double force_N);
  void NextStepOfActivation();
  int Fault() const;
  GripperMotion Motion() const;

  Gripper& gripper_;
  GripperScale scale_;
  int action_start_, status_start_;
  GripperAction action_;
  Phase phase_ = Phase::kReset;
  int step_ = 0;           ///< Of the activation.
  bool delayed_ = false;   ///< A request waits for the end of the activation.
  bool executed_ = false;  ///< The fingers have been sent to action_.
  bool lost_ = false;
  int raised_ = 0;
  bool silent_ = false, silence_told_ = false;
  TimeNs heard_{0};
  double opening_m_ = 0.0;  ///< Of the fingers, and since when they stand so.
  TimeNs now_{0}, still_since_{0};
};

}  // namespace tubetwin

#pragma once

#include <cstdint>
#include <vector>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/codecs/robotiq_registers.h"
#include "hw_bridge/emulators/robotiq/modbus_slave.h"

namespace tubetwin {

/// The controller of a Robotiq 2F gripper: reads commands from its registers, moves the fingers of
/// any Gripper, writes states. Activation opens, closes and opens the fingers. No fault opens them:
/// fingers that move outwards stop, fingers that press keep pressing.
class GripperController : public ModbusRegisters {
 public:
  /// `gripper` must outlive it.
  GripperController(Gripper& gripper, const GripperScale& scale)
      : gripper_(gripper), scale_(scale) {}

  // Of a client: three registers from 0x03E8 to write and read, three from 0x07D0 to read.
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
  GripperAction action_;
  Phase phase_ = Phase::kReset;
  int step_ = 0;           ///< Of the activation.
  bool delayed_ = false;   ///< A request waits for the end of the activation.
  bool executed_ = false;  ///< The fingers have been sent to action_.
  bool lost_ = false;
  int raised_ = 0;
  bool silent_ = false, silence_told_ = false;
  TimeNs heard_{0};
};

}  // namespace tubetwin

#pragma once

#include <string>

#include "models/base/joint.h"
#include "models/base/time.h"

namespace tubetwin {

/// Where an arm shall be now, and how it shall go on. Radians and derivatives.
struct ServoReference {
  JointVector q = JointVector::Zero(), qd = JointVector::Zero(), qdd = JointVector::Zero();
};

struct ServoState {
  TimeNs time{0};
  JointVector q = JointVector::Zero();  ///< Measured, rad.
  JointVector qd = JointVector::Zero();
  JointVector q_commanded = JointVector::Zero();  ///< The newest reference.
  bool moving = false;                            ///< A reference is followed, or the arm halts.
  std::string fault;  ///< Why the drives gave up following; empty: they did not.
};

/// An arm as the inside of a robot controller sees it: its drives. An arm that also is an Arm is
/// used as one or as the other, never as both at once. Same thread as the cell's devices.
class ServoArm {
 public:
  virtual ~ServoArm() = default;
  virtual ServoState Servo() const = 0;
  /// The reference of the coming control period; nothing happens in a fault. Without a new one
  /// each period the arm halts as fast as its limits allow, and then holds where it is.
  /// Precondition: no trajectory of the Arm runs.
  virtual void Follow(const ServoReference& reference) = 0;
  /// Makes the drives ready again, holding where the arm is now.
  virtual void ClearServoFault() = 0;
};

}  // namespace tubetwin

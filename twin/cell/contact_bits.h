#pragma once

namespace tubetwin {

// Who may touch whom in the cell. Two geoms collide when the contype of one and the conaffinity of
// the other share a bit; every geom belongs to one group and lists those whom it accepts. Arm and
// gripper never collide with themselves: the planner's clearances keep them apart, and resting
// contacts inside the arm would only add phantom friction.
enum ContactBits : int {
  kTubeBit = 1,     ///< Tubes: accept tubes.
  kGripperBit = 4,  ///< Pads, fingers, palm: accept tubes.
  kArmBit = 8,      ///< Arm links from the elbow on, scanner housing: accept tubes.
  /// Bin, tray, plate are of no group and accept all three.
  kSceneAccepts = kTubeBit | kGripperBit | kArmBit,
};

}  // namespace tubetwin

#pragma once

#include <string>

namespace tubetwin {

/// A message's name and JSON schema. Names beginning with "foxglove." are those of the schemas that
/// viewers know, https://docs.foxglove.dev/docs/visualization/message-schemas.
struct McapSchema {
  std::string name, json;
};

McapSchema JointStatesSchema();
McapSchema FrameTransformsSchema();
McapSchema PointCloudSchema();
McapSchema LogSchema();
McapSchema WrenchSchema();   ///< tubetwin.Wrench: frame_id, force, torque, saturated.
McapSchema ArmSchema();      ///< tubetwin.ArmState: mode, progress_s, planned_s, done, fault.
McapSchema GripperSchema();  ///< tubetwin.GripperState: opening_m, requested_m, object, ...

}  // namespace tubetwin

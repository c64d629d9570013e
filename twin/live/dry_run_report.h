#pragma once

#include <string>
#include <vector>

#include "hw_bridge/cell/cell.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// A motion that an arm would have been sent, and where the fingers stood.
struct RehearsedMotion {
  JointTrajectory trajectory;
  double opening_m = 0.0;  ///< Between the pads when it began.
};

/// What a rehearsal shows of its motions.
struct DryRunReport {
  int trajectories = 0;      ///< All of them planned, checked and followed in thought.
  double duration_s = 0.0;   ///< Of all together.
  int gripper_commands = 0;  ///< That the fingers would have been sent.
  struct {
    double clearance_m = 0.0;      ///< Least distance of anything that moves from anything else.
    bool is_beyond = false;        ///< It is more than that: nothing came nearer.
    std::string moving, obstacle;  ///< Names of the pair.
    int trajectory = 0;            ///< From 1, in their order.
    double at_s = 0.0;             ///< Into that one.
  } nearest;
  struct {
    int joint = 0;  ///< From 1; the one that comes nearest to its speed limit and sets the pace.
    std::string name;
    double speed_rad_s = 0.0, limit_rad_s = 0.0;  ///< Its largest speed, and what it may have.
    int trajectory = 0;
  } slowest_joint;
};

/// Follows the motions in steps of 10 ms through the cell's collision shapes and joint limits. No
/// motion: zeros.
DryRunReport ReportOf(const Cell& cell, const std::vector<RehearsedMotion>& motions,
                      int gripper_commands);

/// dry_run.json of a result folder.
Json ToJson(const DryRunReport& report);

/// "14 trajectories checked (21.3 s of motion), least clearance 8.4 mm (scanner to bin wall),
/// slowest joint 4 (S) at 62 % of its limit; nothing was sent".
std::string ToText(const DryRunReport& report);

}  // namespace tubetwin

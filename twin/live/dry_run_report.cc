#include "twin/live/dry_run_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "models/base/json.h"
#include "planner/motion/motion_planner.h"

namespace tubetwin {
namespace {

constexpr double kStep_s = 0.01;  ///< As the planner samples.
constexpr double kFar_m = 0.05;   ///< What is farther apart is of no interest.

void LookAt(const ClearanceChecker& clearance, const RehearsedMotion& motion, int number,
            DryRunReport& report) {
  const int steps = static_cast<int>(std::ceil(motion.trajectory.duration_s() / kStep_s));
  for (int i = 0; i <= steps; ++i) {
    const double at_s = std::min(i * kStep_s, motion.trajectory.duration_s());
    const auto found = clearance.Check(Sample(motion.trajectory, at_s).q, motion.opening_m, kFar_m);
    if (found.moving.empty() || found.clearance_m >= report.nearest.clearance_m) continue;
    report.nearest = {found.clearance_m, false, found.moving, found.obstacle, number, at_s};
  }
}

void LookAtSpeeds(const ArmModel& arm, const RehearsedMotion& motion, int number,
                  DryRunReport& report) {
  auto& slowest = report.slowest_joint;
  for (const TrajectoryPoint& point : motion.trajectory.points) {
    for (int j = 0; j < kNumJoints; ++j) {
      const double limit_rad_s = arm.joints[j].max_speed_rad_s;
      const double speed_rad_s = std::abs(point.qd[j]);
      const bool first = slowest.joint == 0;
      if (!first && speed_rad_s * slowest.limit_rad_s <= slowest.speed_rad_s * limit_rad_s)
        continue;
      slowest = {j + 1, arm.joints[j].name, speed_rad_s, limit_rad_s, number};
    }
  }
}

}  // namespace

DryRunReport ReportOf(const Cell& cell, const std::vector<RehearsedMotion>& motions,
                      int gripper_commands) {
  DryRunReport report;
  report.gripper_commands = gripper_commands;
  if (motions.empty()) return report;
  const MotionPlanner planner(cell.model, cell.bin);
  report.nearest.clearance_m = kFar_m;
  report.nearest.is_beyond = true;
  for (const RehearsedMotion& motion : motions) {
    ++report.trajectories;
    report.duration_s += motion.trajectory.duration_s();
    LookAt(planner.clearance(), motion, report.trajectories, report);
    LookAtSpeeds(cell.model.arm, motion, report.trajectories, report);
  }
  return report;
}

Json ToJson(const DryRunReport& report) {
  return Json{{"schema", "tubetwin/dry_run/1"},
              {"sent", false},
              {"trajectories", report.trajectories},
              {"duration_s", report.duration_s},
              {"gripper_commands", report.gripper_commands},
              {"least_clearance",
               {{"clearance_m", report.nearest.clearance_m},
                {"at_least", report.nearest.is_beyond},
                {"moving", report.nearest.moving},
                {"obstacle", report.nearest.obstacle},
                {"trajectory", report.nearest.trajectory},
                {"at_s", report.nearest.at_s}}},
              {"slowest_joint",
               {{"joint", report.slowest_joint.joint},
                {"name", report.slowest_joint.name},
                {"speed_rad_s", report.slowest_joint.speed_rad_s},
                {"limit_rad_s", report.slowest_joint.limit_rad_s},
                {"trajectory", report.slowest_joint.trajectory}}}};
}

std::string ToText(const DryRunReport& report) {
  if (report.trajectories == 0) return "no motion was planned; nothing was sent";
  char text[256];
  std::snprintf(text, sizeof text, "%d %s checked (%.1f s of motion), least clearance ",
                report.trajectories, report.trajectories == 1 ? "trajectory" : "trajectories",
                report.duration_s);
  std::string out = text;
  const auto& near = report.nearest;
  std::snprintf(text, sizeof text, near.is_beyond ? "above %.0f mm" : "%.1f mm (",
                1e3 * near.clearance_m);
  out += text + (near.is_beyond ? std::string() : near.moving + " to " + near.obstacle + ")");
  const auto& joint = report.slowest_joint;
  std::snprintf(text, sizeof text,
                ", slowest joint %d (%s) at %.0f %% of its speed limit; nothing was sent",
                joint.joint, joint.name.c_str(),
                joint.limit_rad_s > 0.0 ? 100.0 * joint.speed_rad_s / joint.limit_rad_s : 0.0);
  return out + text;
}

}  // namespace tubetwin

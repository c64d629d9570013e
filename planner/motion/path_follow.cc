#include "planner/motion/path_follow.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "models/base/error.h"

namespace tubetwin {
namespace {

using Why = MotionRejection::Why;
using Status = InverseNearResult::Status;

constexpr double kSample_s = 0.010;
/// A larger step of a joint between two pieces of a line is another branch or a singular pose.
constexpr double kJump_rad = 0.10;
/// A start that is already beyond a bound may get worse by no more than this.
constexpr double kStartSlack_m = 0.0005;
constexpr double kStartSlack_rad = 0.001;
/// Checks stop looking this far beyond the clearance that is asked.
constexpr double kLookAhead_m = 0.001;

template <class... Args>
std::string Format(const char* format, Args... args) {
  char text[240];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

/// Bounds of one motion, loosened where its start is beyond them already.
class Bounds {
 public:
  Bounds(const FollowContext& context, const JointPath& path, const JointVector& q_start)
      : context_(context), path_(path) {
    const MotionOptions& o = context.options;
    for (int i = 0; i < kNumJoints; ++i) {
      const ArmModel::Joint& joint = context.arm.joints[i];
      lower_[i] = std::min(joint.lower_rad + o.joint_margin_rad, q_start[i] - kStartSlack_rad);
      upper_[i] = std::max(joint.upper_rad - o.joint_margin_rad, q_start[i] + kStartSlack_rad);
    }
    const double max_m = std::max(o.clearance_m, o.finger_clearance_m) + kLookAhead_m;
    const auto at_start = context.clearance.Check(q_start, context.opening_m, max_m);
    finger_clearance_m_ =
        std::min(o.finger_clearance_m, at_start.fingers.clearance_m - kStartSlack_m);
    clearance_m_ = std::min(o.clearance_m, at_start.others.clearance_m - kStartSlack_m);
    enough_m_ = max_m;
    if (path.Cartesian()) {
      manipulability_ =
          std::min(o.manipulability, 0.95 * Manipulability(context.arm, q_start, context.X_FE));
    }
  }

  std::optional<MotionRejection> Check(const JointVector& q) const {
    for (int i = 0; i < kNumJoints; ++i) {
      if (q[i] >= lower_[i] && q[i] <= upper_[i]) continue;
      const double limit = q[i] < lower_[i] ? lower_[i] : upper_[i];
      return MotionRejection{
          Why::kJointLimit,
          Format("joint %d at %.1f degrees, %.1f allowed", i + 1, Degrees(q[i]), Degrees(limit)),
          0.0, i};
    }
    if (path_.Cartesian()) {
      const double m = Manipulability(context_.arm, q, context_.X_FE);
      if (m < manipulability_) {
        return MotionRejection{
            Why::kSingular, Format("manipulability %.3f, %.3f asked", m, manipulability_), 0.0, -1};
      }
    }
    const auto near = context_.clearance.Check(q, context_.opening_m, enough_m_);
    if (near.others.clearance_m < clearance_m_) return Collision(near.others, clearance_m_);
    if (near.fingers.clearance_m < finger_clearance_m_) {
      return Collision(near.fingers, finger_clearance_m_);
    }
    return std::nullopt;
  }

 private:
  static MotionRejection Collision(const ClearanceChecker::Nearest& near, double asked_m) {
    return {Why::kCollision,
            Format("%s %.1f mm from %s, %.1f asked", near.moving.c_str(), near.clearance_m * 1e3,
                   near.obstacle.c_str(), asked_m * 1e3),
            0.0, -1};
  }

  const FollowContext& context_;
  const JointPath& path_;
  JointVector lower_, upper_;
  double clearance_m_, finger_clearance_m_, enough_m_, manipulability_ = 0.0;
};

std::optional<MotionRejection> CheckStep(const JointVector& q_before, const JointVector& q) {
  int joint = 0;
  const double step = (q - q_before).cwiseAbs().maxCoeff(&joint);
  if (step <= kJump_rad) return std::nullopt;
  if (step > kPi) {
    return MotionRejection{Why::kJointLimit, Format("joint %d would pass its limit", joint + 1),
                           0.0, joint};
  }
  return MotionRejection{Why::kJump,
                         Format("joint %d would jump by %.1f degrees", joint + 1, Degrees(step)),
                         0.0, joint};
}

/// A point between two followed ones, as a start for the inverse kinematics.
JointVector Interpolate(const std::vector<PathPoint>& points, double u) {
  const int pieces = static_cast<int>(points.size()) - 1;
  const int i = std::clamp(static_cast<int>(u * pieces), 0, pieces - 1);
  const double t = u * pieces - i;
  return points[i].q + t * (points[i + 1].q - points[i].q);
}

/// How much slower the motion must run to keep the joints' shares: 1 when it need not.
double NeededSlowdown(const FollowContext& context, const std::vector<TrajectoryPoint>& points) {
  const MotionOptions& o = context.options;
  double slowdown = 1.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int joint = 0; joint < kNumJoints; ++joint) {
      const ArmModel::Joint& limits = context.arm.joints[joint];
      const double speed = std::abs(points[i].qd[joint]) / limits.max_speed_rad_s;
      const double acceleration = std::abs(points[i].qdd[joint]) / limits.max_acceleration_rad_s2;
      slowdown = std::max(slowdown, speed / o.joint_speed_share);
      slowdown = std::max(slowdown, std::sqrt(acceleration / o.joint_acceleration_share));
      if (i == 0) continue;
      const double change = points[i].qdd[joint] - points[i - 1].qdd[joint];
      const double jerk =
          std::abs(change) / (points[i].time_s - points[i - 1].time_s) / limits.max_jerk_rad_s3;
      slowdown = std::max(slowdown, std::cbrt(jerk / o.joint_acceleration_share));
    }
  }
  return slowdown;
}

std::vector<TrajectoryPoint> SampleTimed(const JointPath& path,
                                         const std::vector<PathPoint>& points, const SCurve& law) {
  const int count = std::max(1, static_cast<int>(std::ceil(law.duration_s() / kSample_s - 1e-9)));
  const double duration_s = std::max(law.duration_s(), kSample_s);
  std::vector<TrajectoryPoint> out;
  out.reserve(count + 1);
  for (int i = 0; i <= count; ++i) {
    TrajectoryPoint sample;
    sample.time_s = duration_s * i / count;
    const SCurve::State s = law.At(law.duration_s() * i / count);
    PathPoint p;
    if (i == 0 || i == count) {
      p = i == 0 ? points.front() : points.back();
    } else {
      const JointPath::Place place = path.At(s.s, Interpolate(points, s.s));
      TT_CHECK(place.status == Status::kFound);  // The path was followed on both sides of it.
      p = place.point;
    }
    sample.q = p.q;
    sample.qd = p.dq * s.v;
    sample.qdd = p.ddq * (s.v * s.v) + p.dq * s.a;
    out.push_back(sample);
  }
  return out;
}

}  // namespace

std::variant<std::vector<PathPoint>, MotionRejection> FollowPath(const FollowContext& context,
                                                                 const JointPath& path,
                                                                 const JointVector& q_start) {
  const Bounds bounds(context, path, q_start);
  const int pieces = path.Pieces();
  std::vector<PathPoint> points;
  points.reserve(pieces + 1);
  JointVector q = q_start;
  for (int i = 0; i <= pieces; ++i) {
    const double u = static_cast<double>(i) / pieces;
    // The last step, continued, is the best guess of the next.
    const JointVector q_guess = i == 0 ? q_start : JointVector(q + points.back().dq / pieces);
    const JointPath::Place place = path.At(u, q_guess);
    std::optional<MotionRejection> rejection;
    if (place.status == Status::kUnreachable) {
      rejection = MotionRejection{Why::kUnreachable, "out of reach", 0.0, -1};
    } else if (place.status == Status::kOutsideLimits) {
      rejection = MotionRejection{Why::kJointLimit, "only reached beyond a joint limit", 0.0, -1};
    } else {
      if (path.Cartesian()) rejection = CheckStep(q, place.point.q);
      if (!rejection) rejection = bounds.Check(place.point.q);
    }
    if (rejection) {
      rejection->fraction = u;
      return *rejection;
    }
    points.push_back(place.point);
    q = place.point.q;
  }
  return points;
}

JointTrajectory TimePath(const FollowContext& context, const JointPath& path,
                         const std::vector<PathPoint>& points, const PathLimits& limits) {
  double slowdown = 1.0;
  std::vector<TrajectoryPoint> samples;
  // One pass is exact but for the samples' places; a second or third settles that.
  for (int pass = 0; pass < 4; ++pass) {
    samples = SampleTimed(path, points, SCurve(1.0, limits.Slowed(slowdown)));
    const double more = NeededSlowdown(context, samples);
    if (more <= 1.0) break;
    slowdown *= 1.001 * more;
  }
  return {std::move(samples)};
}

}  // namespace tubetwin

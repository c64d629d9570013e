#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/arm/arm.h"
#include "models/base/joint.h"

namespace tubetwin {

/// Cuts a trajectory into the points that are sent to a controller one by one, at whole
/// milliseconds of the stream's time and at most `spacing_ms` apart. The stream's time equals the
/// time along the path until a stop's ramp stretches it.
class PathStream {
 public:
  struct Point {
    std::int64_t time_ms = 0;
    JointVector q = JointVector::Zero(), qd = JointVector::Zero();
  };

  /// `q_start`: the commanded position of the arm at rest; its difference to the trajectory's first
  /// point is faded out over the first 0.3 s. Precondition: spacing_ms >= 4.
  PathStream(const JointTrajectory& trajectory, const JointVector& q_start, int spacing_ms);

  /// More path, from where the present one ends. Precondition: the first point is that end.
  void Append(const JointTrajectory& continuation);
  /// The next point to send; nothing when the path's end was given.
  std::optional<Point> Next();
  /// From the last point on, brings the arm to rest on the path with at most half of its
  /// acceleration limits. Close to its end the path ends as it would have.
  void RampDown(const ArmModel& arm);

  /// Next() has nothing more to give.
  bool finished() const;
  bool ramped() const { return ramp_.has_value(); }
  double planned_s() const { return path_.duration_s(); }
  const JointVector& end() const { return path_.points.back().q; }
  std::int64_t given_ms() const { return given_ms_; }  ///< Of the last point.
  /// Time along the path at that time of the stream, of what was given.
  double PathTime(double stream_s) const;
  /// Time along the path of its place nearest to `q`, within half a second of `path_s`.
  double NearestTime(const JointVector& q, double path_s) const;

 private:
  struct Ramp {
    double from_s = 0, length_s = 0;  ///< On the path; of the stream.
    std::int64_t from_ms = 0, length_ms = 0, step_ms = 0;
  };
  struct Mark {
    std::int64_t time_ms = 0;
    double path_s = 0;
  };
  void AddMarks(double duration_s);
  TrajectoryPoint At(double path_s) const;
  std::optional<Point> NextOfRamp();
  Point Give(std::int64_t time_ms, double path_s, double rate);

  JointTrajectory path_;
  JointVector lead_in_;
  double lead_in_s_ = 0;
  int spacing_ms_;
  std::vector<Mark> marks_;  ///< Points to come and those that were given.
  std::size_t next_ = 0;     ///< Of marks_.
  std::optional<Ramp> ramp_;
  std::int64_t given_ms_ = 0;
};

}  // namespace tubetwin

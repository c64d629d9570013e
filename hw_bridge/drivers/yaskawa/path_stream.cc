#include "hw_bridge/drivers/yaskawa/path_stream.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kLeadIn_s = 0.3;
constexpr double kRampShare = 0.5;
constexpr double kShortestRamp_s = 0.04;
constexpr std::int64_t kFinestRamp_ms = 4;
/// The controller cuts points into increments of that length: whole ones where that is free.
constexpr std::int64_t kIncrement_ms = 4;
// Where the arm may be found about its estimated place, and how finely.
constexpr double kBehind_s = 0.5, kAhead_s = 0.5, kSearchStep_s = 0.01, kFineStep_s = 0.0005;

}  // namespace

PathStream::PathStream(const JointTrajectory& trajectory, const JointVector& q_start,
                       int spacing_ms)
    : path_(trajectory), lead_in_(q_start - trajectory.points.front().q), spacing_ms_(spacing_ms) {
  TT_CHECK(spacing_ms >= kIncrement_ms);
  lead_in_s_ = std::min(kLeadIn_s, path_.duration_s());
  marks_.push_back({0, 0.0});
  AddMarks(path_.duration_s());
}

void PathStream::AddMarks(double duration_s) {
  const Mark from = marks_.back();
  // The last point is at the path's end; the stream gives it up to a millisecond later.
  const auto length_ms = static_cast<std::int64_t>(std::ceil(duration_s * 1e3 - 1e-6));
  const std::int64_t mean_ms = spacing_ms_ - (kIncrement_ms - 1);  // Rounding adds the rest.
  const std::int64_t steps = std::max<std::int64_t>(1, (length_ms + mean_ms - 1) / mean_ms);
  for (std::int64_t k = 1; k < steps; ++k) {
    const std::int64_t at_ms = length_ms * k / steps / kIncrement_ms * kIncrement_ms;
    marks_.push_back({from.time_ms + at_ms, from.path_s + 1e-3 * static_cast<double>(at_ms)});
  }
  marks_.push_back({from.time_ms + std::max<std::int64_t>(1, length_ms), from.path_s + duration_s});
}

void PathStream::Append(const JointTrajectory& continuation) {
  TT_CHECK(!ramped());
  const double offset_s = path_.duration_s() - continuation.points.front().time_s;
  for (std::size_t i = 1; i < continuation.points.size(); ++i) {
    TrajectoryPoint point = continuation.points[i];
    point.time_s += offset_s;
    path_.points.push_back(point);
  }
  AddMarks(continuation.points.back().time_s - continuation.points.front().time_s);
}

TrajectoryPoint PathStream::At(double path_s) const {
  TrajectoryPoint point = Sample(path_, path_s);
  if (path_s < lead_in_s_) {
    const double u = path_s / lead_in_s_;
    point.q += lead_in_ * (1.0 - u * u * (3.0 - 2.0 * u));
    point.qd -= lead_in_ * (6.0 * u * (1.0 - u) / lead_in_s_);
  }
  return point;
}

PathStream::Point PathStream::Give(std::int64_t time_ms, double path_s, double rate) {
  const TrajectoryPoint at = At(path_s);
  given_ms_ = time_ms;
  return {time_ms, at.q, rate * at.qd};
}

bool PathStream::finished() const {
  return ramp_ ? given_ms_ == ramp_->from_ms + ramp_->length_ms : next_ == marks_.size();
}

std::optional<PathStream::Point> PathStream::Next() {
  if (ramp_) return NextOfRamp();
  if (next_ == marks_.size()) return std::nullopt;
  const Mark mark = marks_[next_++];
  return Give(mark.time_ms, mark.path_s, 1.0);
}

void PathStream::RampDown(const ArmModel& arm) {
  if (ramped() || next_ == 0 || next_ == marks_.size()) return;
  const Mark from = marks_[next_ - 1];
  // The fastest that the joints become within the longest ramp that this could need.
  double length_s = kShortestRamp_s;
  for (int pass = 0; pass < 2; ++pass) {
    const double until_s = std::min(planned_s(), from.path_s + 0.5 * length_s);
    for (double t = from.path_s; t <= until_s; t += 0.01) {
      const JointVector qd = At(t).qd;
      for (int i = 0; i < kNumJoints; ++i) {
        // A half cosine's steepest slope is pi/2 of its mean.
        const double mean_rad_s2 = kRampShare * arm.joints[i].max_acceleration_rad_s2 * 2.0 / kPi;
        length_s = std::max(length_s, std::abs(qd[i]) / mean_rad_s2);
      }
    }
  }
  if (from.path_s + 0.5 * length_s >= planned_s()) return;
  marks_.resize(next_);
  Ramp ramp;
  ramp.from_s = from.path_s;
  ramp.from_ms = from.time_ms;
  ramp.length_ms = static_cast<std::int64_t>(std::ceil(length_s * 1e3));
  ramp.length_s = 1e-3 * static_cast<double>(ramp.length_ms);
  ramp.step_ms = std::clamp<std::int64_t>(ramp.length_ms / 4, kFinestRamp_ms, spacing_ms_);
  ramp_ = ramp;
}

std::optional<PathStream::Point> PathStream::NextOfRamp() {
  const std::int64_t passed_ms =
      std::min(ramp_->length_ms, given_ms_ + ramp_->step_ms - ramp_->from_ms);
  if (finished()) return std::nullopt;
  // Rate (1 + cos(pi u)) / 2, its integral along the path.
  const double u = static_cast<double>(passed_ms) / static_cast<double>(ramp_->length_ms);
  const double path_s = ramp_->from_s + 0.5 * ramp_->length_s * (u + std::sin(kPi * u) / kPi);
  const double rate = passed_ms == ramp_->length_ms ? 0.0 : 0.5 * (1.0 + std::cos(kPi * u));
  marks_.push_back({ramp_->from_ms + passed_ms, path_s});
  next_ = marks_.size();
  return Give(ramp_->from_ms + passed_ms, path_s, rate);
}

double PathStream::PathTime(double stream_s) const {
  const double ms = 1e3 * stream_s;
  const auto after = std::find_if(marks_.begin(), marks_.end(), [ms](const Mark& mark) {
    return static_cast<double>(mark.time_ms) >= ms;
  });
  if (after == marks_.begin()) return 0.0;
  if (after == marks_.end()) return marks_.back().path_s;
  const Mark& a = *(after - 1);
  const double u =
      (ms - static_cast<double>(a.time_ms)) / static_cast<double>(after->time_ms - a.time_ms);
  return a.path_s + u * (after->path_s - a.path_s);
}

double PathStream::NearestTime(const JointVector& q, double path_s) const {
  const auto nearest = [&](double from_s, double to_s, double step_s) {
    double best_s = from_s, min_sq = (q - At(from_s).q).squaredNorm();
    for (double t = from_s + step_s; t <= to_s; t += step_s) {
      const double off = (q - At(t).q).squaredNorm();
      if (off < min_sq) {
        min_sq = off;
        best_s = t;
      }
    }
    return best_s;
  };
  const double about_s = nearest(std::max(0.0, path_s - kBehind_s),
                                 std::min(planned_s(), path_s + kAhead_s), kSearchStep_s);
  return nearest(std::max(0.0, about_s - kSearchStep_s),
                 std::min(planned_s(), about_s + kSearchStep_s), kFineStep_s);
}

}  // namespace tubetwin

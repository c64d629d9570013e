// How well an arm did what it was told, from a recording of its cell (run --record):
//   motion_of_recording CELL.rec.zst
// One JSON object: motions; E's distance from the planned path while it moves and from its end once
// it is done, mm; age of the arm's states when they are read, ms, while it moves and at rest.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <vector>

#include "hw_bridge/recording/cell_recording.h"
#include "models/arm/arm.h"
#include "models/base/json.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

/// Part of the path about the reported progress in which the arm's place is looked for.
constexpr double kAround_s = 0.5, kStep_s = 0.004;

Json Spread(std::vector<double> values) {
  if (values.empty()) return Json{{"n", 0}};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return Json{{"n", values.size()}, {"median", at(0.5)}, {"p99", at(0.99)}, {"max", values.back()}};
}

class Motions {
 public:
  explicit Motions(const CellLayout& layout) : X_FE_(layout.X_FE) {}

  void Take(const ArmStarted& started) {
    if (!started.answer.accepted() || started.appended) return;
    path_ = started.trajectory;
    ended_ = false;
    ++motions_;
  }
  void Take(const ArmStopped&) { path_.reset(); }  // Where it comes to rest was not planned.

  void Take(const ArmState& state, TimeNs now) {
    const double age_ms = 1e3 * Seconds(now - state.time);
    (state.mode == ArmMode::kMoving ? age_moving_ms_ : age_rest_ms_).push_back(age_ms);
    if (!path_ || ended_) return;
    const Vector3 p_BE = E(state.q);
    if (state.done) {
      end_mm_.push_back(1e3 * (p_BE - E(path_->points.back().q)).norm());
      ended_ = true;
    } else if (state.mode == ArmMode::kMoving && state.time != seen_) {
      off_mm_.push_back(OffPath_mm(p_BE, state.progress_s));
    }
    seen_ = state.time;
  }

  Json Result() const {
    return Json{{"motions", motions_},
                {"off_path_mm", Spread(off_mm_)},
                {"off_end_mm", Spread(end_mm_)},
                {"state_age_moving_ms", Spread(age_moving_ms_)},
                {"state_age_at_rest_ms", Spread(age_rest_ms_)}};
  }

 private:
  Vector3 E(const JointVector& q) const {
    return (FlangePose(PaperCell().arm, q) * X_FE_).translation();
  }

  double OffPath_mm(const Vector3& p_BE, double progress_s) const {
    double least_m = 1e9;
    for (double t = std::max(0.0, progress_s - kAround_s); t <= progress_s + kAround_s;
         t += kStep_s) {
      // Distance from the chord between neighbouring samples, not from the samples.
      const Vector3 a = E(Sample(*path_, t).q), b = E(Sample(*path_, t + kStep_s).q);
      const double length2 = (b - a).squaredNorm();
      const double s = length2 > 0.0 ? std::clamp((p_BE - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
      least_m = std::min(least_m, (p_BE - a - s * (b - a)).norm());
    }
    return 1e3 * least_m;
  }

  RigidTransform X_FE_;
  std::optional<JointTrajectory> path_;
  bool ended_ = true;
  TimeNs seen_{-1};
  int motions_ = 0;
  std::vector<double> off_mm_, end_mm_, age_moving_ms_, age_rest_ms_;
};

Json Measure(const std::string& path) {
  CellRecording recording(path);
  Motions motions(recording.header().model.layout);
  TimeNs now{0};
  while (const std::optional<CellEvent> event = recording.Next()) {
    if (const auto* read = std::get_if<TimeRead>(&*event)) now = read->now;
    if (const auto* passed = std::get_if<TimeAdvanced>(&*event)) now = passed->now;
    if (const auto* started = std::get_if<ArmStarted>(&*event)) motions.Take(*started);
    if (const auto* stopped = std::get_if<ArmStopped>(&*event)) motions.Take(*stopped);
    if (const auto* read = std::get_if<ArmRead>(&*event)) motions.Take(read->state, now);
  }
  Json out = motions.Result();
  out["cell_s"] = Seconds(recording.end_time());
  return out;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: motion_of_recording CELL.rec.zst\n");
    return 64;
  }
  try {
    std::printf("%s\n", tubetwin::Measure(argv[1]).dump(2).c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "motion_of_recording: %s\n", e.what());
    return 65;
  }
}

#include "planner/cycle/view_scheduler.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {
namespace {

/// Two tubes nearer than this may hand a motion on to one another.
constexpr double kTouchMargin_m = 0.010;
/// Room for what a tube may have moved, added to the tangents of half the scanner's field of view.
constexpr double kFieldRoom = 0.12;

/// Whether each tube of a scene may have moved when one was taken: it and what touches it, and what
/// touches that.
std::vector<bool> MovedWith(const std::vector<PerceivedTube>& tubes, int tube_id) {
  std::vector<bool> moved(tubes.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    if (tubes[i].id != tube_id) continue;
    moved[i] = true;
    open.push_back(i);
  }
  while (!open.empty()) {
    const PerceivedTube& tube = tubes[open.back()];
    open.pop_back();
    for (std::size_t j = 0; j < tubes.size(); ++j) {
      if (moved[j]) continue;
      const double reach_m = tube.radius_m + tubes[j].radius_m + kTouchMargin_m;
      if (ClosestOfLines(tube.centerline_N, tubes[j].centerline_N).distance_m >= reach_m) continue;
      moved[j] = true;
      open.push_back(j);
    }
  }
  return moved;
}

}  // namespace

ViewScheduler::ViewScheduler(CycleContext& context) : context_(context) {
  poses_BS_ = ScanPoses(context.setup.scan, context.cell.model, context.cell.bin,
                        context.setup.part.radius_m);
  views_.resize(poses_BS_.size());
  ages_.assign(poses_BS_.size(), Age::kNever);
  taken_.assign(poses_BS_.size(), false);
  MarkAll();
}

void ViewScheduler::MarkAll() { marked_.assign(poses_BS_.size(), true); }

bool ViewScheduler::all_fresh() const {
  return std::all_of(ages_.begin(), ages_.end(),
                     [](Age age) { return age == Age::kFresh || age == Age::kUnreachable; });
}

std::vector<OrganizedCloud> ViewScheduler::clouds() const {
  std::vector<OrganizedCloud> out;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (taken_[v]) out.push_back(views_[v]);
  }
  return out;
}

bool ViewScheduler::Sees(std::size_t view, const Polyline& line_N) const {
  const ScannerSpec& scanner = context_.cell.model.scanner;
  const double field_x = 0.5 * scanner.full_width / scanner.focal_px + kFieldRoom;
  const double field_y = 0.5 * scanner.full_height / scanner.focal_px + kFieldRoom;
  const RigidTransform X_SN = poses_BS_[view].inverse() * context_.cell.bin.X_BN;
  return std::any_of(line_N.begin(), line_N.end(), [&](const Vector3& p_N) {
    const Vector3 p_S = X_SN * p_N;
    return std::abs(p_S.x()) < field_x * p_S.z() && std::abs(p_S.y()) < field_y * p_S.z();
  });
}

void ViewScheduler::MarkAround(int tube_id) {
  if (context_.setup.scan.rescan_all) return MarkAll();
  const std::vector<bool> moved = MovedWith(scene_.tubes, tube_id);
  for (std::size_t v = 0; v < poses_BS_.size(); ++v) {
    for (std::size_t i = 0; i < scene_.tubes.size(); ++i) {
      if (moved[i] && Sees(v, scene_.tubes[i].centerline_N)) marked_[v] = true;
    }
  }
}

StepOutcome ViewScheduler::GoTo(std::size_t view, bool first) {
  // The way from where the attempt before ended; a second look begins over the bin.
  using Phases = AttemptReport::Phases;
  const bool back = first && context_.report.phases_s.look == 0.0;
  const CycleContext::During going(context_, back ? &Phases::back : &Phases::look);
  const CycleConfig& config = context_.setup.cycle;
  const MotionPlanner& planner = context_.executor.planner();
  // From one view to the next the joints go straight: views lie at one height over all else.
  const MotionOptions options =
      first ? NearGrasp(config.transfer_speed_m_s, config.transfer_acceleration_m_s2)
            : MotionOptions();
  PathBuilder path = context_.Path();
  path.Add("to view " + std::to_string(view + 1), options,
           Transfer{planner.PoseOfEForScan(poses_BS_[view]), /*direct=*/!first});
  return context_.CheckAndRun(path.path());
}

StepOutcome ViewScheduler::Take(std::size_t view) {
  const CycleContext::Timed timed(context_, &AttemptReport::SimTime::scan);
  // A scan that fails is asked for once more.
  for (int attempt = 0;; ++attempt) {
    try {
      views_[view] = Scan(context_.cell);
      taken_[view] = true;
      return {};
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kDevice) throw;
      if (attempt > 0) {
        return {StepOutcome::Status::kTrouble, WaitOutcome::Status::kDone, error.what()};
      }
      context_.observer.OnStep(std::string("scanning again: ") + error.what());
    }
  }
}

StepOutcome ViewScheduler::Look() {
  bool first = true;
  StepOutcome refused;
  for (std::size_t v = 0; v < poses_BS_.size(); ++v) {
    if (ages_[v] == Age::kFresh) ages_[v] = Age::kOld;
    if (!marked_[v]) continue;
    StepOutcome step = GoTo(v, first);
    if (step.refused()) {
      ages_[v] = Age::kUnreachable;
      refused = step;
      continue;
    }
    if (!step.ok()) return step;
    first = false;
    step = Take(v);
    if (!step.ok()) return step;
    ages_[v] = Age::kFresh;
  }
  marked_.assign(poses_BS_.size(), false);
  if (first && refused.refused()) return refused;
  Model();
  return {};
}

void ViewScheduler::Model() {
  const double began = WallClock_s();
  const std::vector<OrganizedCloud> clouds = this->clouds();
  context_.observer.OnClouds(clouds);
  scene_ = Perceive(clouds, context_.setup.part, context_.cell.bin, context_.setup.perception,
                    context_.setup.parallelism);
  context_.report.compute_s.modelling += WallClock_s() - began;
}

}  // namespace tubetwin

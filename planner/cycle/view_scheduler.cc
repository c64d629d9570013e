#include <algorithm>

#include "models/base/error.h"
#include "planner/cycle/cycle_context.h"

namespace tubetwin {
namespace {

/// Two tubes nearer than this may hand a motion on to one another.
constexpr double kTouchMargin_m = 0.010;
/// Half field of view of the scanner as tangents, with room for what a tube may have moved.
constexpr double kFieldX = 0.5 * 2064.0 / 2534.0 + 0.12, kFieldY = 0.5 * 1544.0 / 2534.0 + 0.12;

/// A scan that fails is asked for once more.
OrganizedCloud ScanOrAgain(CycleContext& c) {
  try {
    return Scan(c.cell);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kDevice) throw;
    c.observer.OnStep(std::string("scanning again: ") + error.what());
  }
  return Scan(c.cell);
}

}  // namespace

ViewScheduler::ViewScheduler(CycleContext& context) : context_(context) {
  poses_BS_ = ScanPoses(context.setup.scan, context.cell.bin);
  views_.resize(poses_BS_.size());
  taken_last_.assign(poses_BS_.size(), false);
  MarkAll();
}

void ViewScheduler::MarkAll() { marked_.assign(poses_BS_.size(), true); }

bool ViewScheduler::all_fresh() const {
  return std::find(taken_last_.begin(), taken_last_.end(), false) == taken_last_.end();
}

bool ViewScheduler::Sees(std::size_t view, const Polyline& line_N) const {
  const RigidTransform X_SN = poses_BS_[view].inverse() * context_.cell.bin.X_BN;
  for (const Vector3& p_N : line_N) {
    const Vector3 p_S = X_SN * p_N;
    if (std::abs(p_S.x()) < kFieldX * p_S.z() && std::abs(p_S.y()) < kFieldY * p_S.z()) return true;
  }
  return false;
}

void ViewScheduler::MarkAround(int tube_id) {
  if (context_.setup.scan.rescan_all) return MarkAll();
  const auto& tubes = scene_.tubes;
  std::vector<bool> moved(tubes.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    if (tubes[i].id == tube_id) {
      moved[i] = true;
      open.push_back(i);
    }
  }
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    for (std::size_t j = 0; j < tubes.size(); ++j) {
      if (moved[j]) continue;
      const double reach = tubes[i].radius_m + tubes[j].radius_m + kTouchMargin_m;
      if (ClosestOfLines(tubes[i].centerline_N, tubes[j].centerline_N).distance_m < reach) {
        moved[j] = true;
        open.push_back(j);
      }
    }
  }
  for (std::size_t v = 0; v < poses_BS_.size(); ++v) {
    for (std::size_t i = 0; i < tubes.size(); ++i) {
      if (moved[i] && Sees(v, tubes[i].centerline_N)) marked_[v] = true;
    }
  }
}

const TubeScene& ViewScheduler::Look() {
  Cell& cell = context_.cell;
  const CycleConfig& speeds = context_.setup.cycle;
  const RigidTransform X_SE = cell.layout.X_FS.inverse() * cell.layout.X_FE;
  bool first = true;
  for (std::size_t v = 0; v < poses_BS_.size(); ++v) {
    taken_last_[v] = marked_[v];
    if (!marked_[v]) continue;
    {
      const CycleContext::Timed timed(context_, &AttemptReport::SimTime::move);
      const RigidTransform X_BE = poses_BS_[v] * X_SE;
      if (first) {
        context_.executor.Transfer(X_BE, speeds.transfer_speed_m_s,
                                   speeds.transfer_acceleration_m_s2, true);
      } else {
        context_.executor.Joint(X_BE, true);
      }
      first = false;
    }
    const CycleContext::Timed timed(context_, &AttemptReport::SimTime::scan);
    views_[v] = ScanOrAgain(context_);
  }
  marked_.assign(poses_BS_.size(), false);
  const double began = ComputeClock_s();
  context_.observer.OnClouds(views_);
  scene_ = Perceive(views_, context_.setup.part, cell.bin, context_.setup.perception,
                    context_.setup.parallelism);
  context_.report.compute_s.modelling += ComputeClock_s() - began;
  return scene_;
}

}  // namespace tubetwin

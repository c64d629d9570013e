#pragma once

#include <vector>

#include "planner/cycle/cycle_context.h"

namespace tubetwin {

/// Looking into the bin: which views to take again, the clouds, and the scene they give.
class ViewScheduler {
 public:
  explicit ViewScheduler(CycleContext& context);

  /// Everything may have moved: the next Look goes to every view.
  void MarkAll();
  /// Only what touches this tube may have moved: views that see it or what it touches.
  void MarkAround(int tube_id);
  /// Moves to the marked views, scans, models. A view that the arm cannot reach is left out;
  /// refused when it can reach none. Trouble when the arm or the scanner fails.
  StepOutcome Look();
  /// Every view that the arm can reach was taken by the last Look.
  bool all_fresh() const;
  const TubeScene& scene() const { return scene_; }
  /// The newest cloud of every view that was ever taken.
  std::vector<OrganizedCloud> clouds() const;

 private:
  enum class Age { kNever, kOld, kFresh, kUnreachable };
  bool Sees(std::size_t view, const Polyline& line_N) const;
  StepOutcome GoTo(std::size_t view, bool first);
  StepOutcome Take(std::size_t view);
  void Model();

  CycleContext& context_;
  std::vector<RigidTransform> poses_BS_;
  std::vector<OrganizedCloud> views_;
  std::vector<bool> marked_, taken_;
  std::vector<Age> ages_;
  TubeScene scene_;
};

}  // namespace tubetwin

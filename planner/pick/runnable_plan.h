#pragma once

#include <optional>
#include <vector>

#include "planner/motion/path_config.h"
#include "planner/motion/pick_path.h"
#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// A plan of a list and its path, checked whole from where the arm stands.
struct RunnablePlan {
  std::size_t index = 0;  ///< In the list.
  CheckedPath path;
};

/// The first of `plans` whose path the arm can run from `start`; none: it can run none of them. A
/// path that is refused costs nothing but the next plan: it is added to `rejections`. Precondition:
/// the plans' targets are tubes of the problem's scene.
std::optional<RunnablePlan> FirstRunnable(const PickProblem& problem,
                                          const std::vector<PickPlan>& plans,
                                          const MotionPlanner& planner, const PathConfig& config,
                                          const PathStart& start,
                                          std::vector<Rejection>& rejections);

}  // namespace tubetwin

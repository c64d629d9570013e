#include "planner/pick/runnable_plan.h"

#include "planner/grasp/held_part.h"
#include "planner/pick/grasp_choice.h"
#include "planner/pick/make_path.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {

std::optional<RunnablePlan> FirstRunnable(const PickProblem& problem,
                                          const std::vector<PickPlan>& plans,
                                          const MotionPlanner& planner, const PathConfig& config,
                                          const PathStart& start,
                                          std::vector<Rejection>& rejections) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const PickPlan& plan = plans[i];
    const Polyline& line_N = TubeOf(problem.scene, plan.target).centerline_N;
    const HeldPart held = HeldPartOf(Transformed(plan.grasp.X_NG.inverse(), line_N), problem.part);
    PathCheck check = Check(planner,
                            MakePickPath(plan.grasp, plan.motion,
                                         {planner.model().gripper, problem.bin, config,
                                          problem.part.radius_m, held.period_s}),
                            start);
    if (const MotionRejection* refusal = RefusalOf(check)) {
      rejections.push_back(
          GraspChoice::ArmRejection(plan.motion, plan.grasp.at_m, refusal->reason));
      continue;
    }
    return RunnablePlan{i, std::get<CheckedPath>(std::move(check))};
  }
  return std::nullopt;
}

}  // namespace tubetwin

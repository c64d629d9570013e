#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// Whether a place on a tube lies within 20 mm of one of others: two tries so near are one try.
bool IsNearAny(const std::vector<double>& tried_m, double at_m);

/// Which grasps of a motion the arm can run: asks the feasibility function once about each grasp
/// and either of the gripper's two equal yaws, and remembers the answers. One per plan; one thread.
class GraspChoice {
 public:
  /// `feasible` must outlive this.
  explicit GraspChoice(const FeasibilityFunction& feasible) : feasible_(feasible) {}

  /// Why the arm can run the motion neither with this grasp nor with the hand turned by half a
  /// turn; nothing: it can, with the grasp as it is then.
  std::optional<std::string> RefusalOf(Grasp& grasp, const CandidateMotion& motion);

  /// The first of `grasps` with which the arm can run the motion, of those that are apart; why not
  /// otherwise.
  struct Choice {
    std::optional<Grasp> grasp;
    std::vector<Rejection> rejections;
  };
  Choice FirstRunnable(const CandidateMotion& motion, const std::vector<Grasp>& grasps);

  /// "arm: ..." for a motion and a place on its tube.
  static Rejection ArmRejection(const CandidateMotion& motion, double at_m,
                                const std::string& reason);

 private:
  struct Answer {
    std::optional<std::string> refusal;
    bool turned = false;
  };
  using Key = std::tuple<int, std::string, int, double>;  ///< Tube, motion, variant, place.

  const FeasibilityFunction& feasible_;
  std::map<Key, Answer> answers_;
};

}  // namespace tubetwin

#include "planner/pick/grasp_choice.h"

#include <algorithm>
#include <cmath>

#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr double kApart_m = 0.020;

}  // namespace

bool IsNearAny(const std::vector<double>& tried_m, double at_m) {
  return std::any_of(tried_m.begin(), tried_m.end(),
                     [&](double other_m) { return std::abs(other_m - at_m) < kApart_m - 1e-9; });
}

std::optional<std::string> GraspChoice::RefusalOf(Grasp& grasp, const CandidateMotion& motion) {
  const Key key{motion.tube, motion.name, motion.variant, grasp.at_m};
  const auto turn = [&] { grasp.X_NG.linear() = grasp.X_NG.linear() * RotZ(kPi); };
  if (const auto known = answers_.find(key); known != answers_.end()) {
    if (known->second.turned) turn();
    return known->second.refusal;
  }
  Answer answer;
  answer.refusal = feasible_(grasp, motion);
  if (answer.refusal) {
    turn();
    answer.turned = true;
    if (!feasible_(grasp, motion)) answer.refusal.reset();
  }
  answers_[key] = answer;
  return answer.refusal;
}

GraspChoice::Choice GraspChoice::FirstRunnable(const CandidateMotion& motion,
                                               const std::vector<Grasp>& grasps) {
  std::vector<double> tried;
  std::string first_refusal;
  for (Grasp grasp : grasps) {
    if (IsNearAny(tried, grasp.at_m)) continue;
    tried.push_back(grasp.at_m);
    const std::optional<std::string> refusal = RefusalOf(grasp, motion);
    if (!refusal) return {grasp, {}};
    if (first_refusal.empty()) first_refusal = *refusal;
  }
  if (tried.empty()) return {};
  return {std::nullopt, {ArmRejection(motion, tried.front(), first_refusal)}};
}

Rejection GraspChoice::ArmRejection(const CandidateMotion& motion, double at_m,
                                    const std::string& reason) {
  return {motion.tube, motion.name, "at " + Number(std::round(at_m * 1e3) / 1e3) + " m",
          "arm: " + reason};
}

}  // namespace tubetwin

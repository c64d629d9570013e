#include "planner/motion/pick_path.h"

#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

std::vector<RigidTransform> Resolved(const std::vector<PathGoal>& goals,
                                     const RigidTransform& X_BE_start) {
  std::vector<RigidTransform> X_BE;
  for (const PathGoal& goal : goals) X_BE.push_back(goal.X_BE(X_BE_start));
  return X_BE;
}

MotionResult PlanTransferSegment(const MotionPlanner& planner, const Transfer& transfer,
                                 const MotionOptions& options, const PathStart& start) {
  if (transfer.direct) {
    if (const auto q_goal = planner.Reach(transfer.X_BE, start.q[5])) {
      MotionResult direct = planner.PlanJoint(start.q, *q_goal, options);
      if (std::holds_alternative<CheckedTrajectory>(direct)) return direct;
    }
  }
  return planner.PlanTransfer(start.q, transfer.X_BE, options);
}

}  // namespace

PathGoal By(const Vector3& move_B) { return {Translation(move_B), true}; }
PathGoal To(const RigidTransform& X_BE) { return {X_BE, false}; }

bool MovesArm(const PathSegment& segment) {
  return !std::holds_alternative<MoveFingers>(segment.what) &&
         !std::holds_alternative<Pause>(segment.what);
}

MotionResult PlanSegment(const MotionPlanner& planner, const PathSegment& segment,
                         const PathStart& start) {
  MotionOptions options = segment.options;
  options.opening_m = start.opening_m;
  const RigidTransform X_BE = planner.PoseOfE(start.q);
  return std::visit(
      Overloaded{
          [&](const Transfer& transfer) {
            return PlanTransferSegment(planner, transfer, options, start);
          },
          [&](const Follow& follow) {
            return planner.PlanPolyline(start.q, Resolved(follow.goals, X_BE), options);
          },
          [&](const GuardedLine& line) {
            return planner.PlanLine(start.q, line.goal.X_BE(X_BE), options);
          },
          [&](const Turn& turn) { return planner.PlanTilt(start.q, turn.rotation_B, options); },
          [](const auto&) -> MotionResult { throw LogicError("the segment moves no arm"); },
      },
      segment.what);
}

/// Plans segment after segment.
class PathChecker {
 public:
  PathChecker(const MotionPlanner& planner, const PickPath& path) : planner_(planner), path_(path) {
    out_.end_.opening_m = planner.model().gripper.stroke_m;
  }

  PathCheck From(const PathStart& start) {
    out_.end_ = start;
    return Go(0);
  }

  std::optional<MotionRejection> RefusalFromOver() {
    // Fingers that move before the transfer stand where they go to.
    std::size_t first = 0;
    while (first < path_.segments.size() && !MovesArm(path_.segments[first])) {
      Pass(path_.segments[first++]);
    }
    TT_CHECK(first < path_.segments.size());
    PathSegment down = path_.segments[first];
    const auto* transfer = std::get_if<Transfer>(&down.what);
    TT_CHECK(transfer != nullptr);
    const RigidTransform X_BE_goal = transfer->X_BE;
    const auto q_over = planner_.Reach(planner_.OverGoal(X_BE_goal, down.options));
    if (!q_over) {
      return MotionRejection{MotionRejection::Why::kUnreachable,
                             down.label + ": the place over the goal is out of reach", 0.0, -1};
    }
    out_.end_.q = *q_over;
    down.what = Follow{{To(X_BE_goal)}};
    if (auto refusal = Plan(down)) return refusal;
    const PathCheck rest = Go(first + 1);
    if (const MotionRejection* refusal = RefusalOf(rest)) return *refusal;
    return std::nullopt;
  }

 private:
  PathCheck Go(std::size_t first) {
    for (std::size_t i = first; i < path_.segments.size(); ++i) {
      const PathSegment& segment = path_.segments[i];
      TT_CHECK(i == 0 || segment.stage >= path_.segments[i - 1].stage);
      if (!MovesArm(segment)) {
        Pass(segment);
      } else if (auto refusal = Plan(segment)) {
        return *refusal;
      }
    }
    return std::move(out_);
  }

  void Pass(const PathSegment& segment) {
    out_.segments_.push_back({segment, out_.end_, std::nullopt});
    if (const auto* fingers = std::get_if<MoveFingers>(&segment.what)) {
      out_.end_.opening_m = fingers->expected_opening_m;
    }
  }

  std::optional<MotionRejection> Plan(const PathSegment& segment) {
    MotionResult planned = PlanSegment(planner_, segment, out_.end_);
    if (auto* refused = std::get_if<MotionRejection>(&planned)) {
      refused->reason = segment.label + ": " + refused->reason;
      return *refused;
    }
    CheckedTrajectory& trajectory = std::get<CheckedTrajectory>(planned);
    const JointVector q_end = EndOf(trajectory);
    out_.segments_.push_back({segment, out_.end_, std::move(trajectory)});
    out_.end_.q = q_end;
    return std::nullopt;
  }

  const MotionPlanner& planner_;
  const PickPath& path_;
  CheckedPath out_;
};

PathCheck Check(const MotionPlanner& planner, const PickPath& path, const PathStart& start) {
  return PathChecker(planner, path).From(start);
}

std::optional<MotionRejection> RefusalFromOver(const MotionPlanner& planner, const PickPath& path) {
  return PathChecker(planner, path).RefusalFromOver();
}

const MotionRejection* RefusalOf(const PathCheck& check) {
  return std::get_if<MotionRejection>(&check);
}

}  // namespace tubetwin

#include "planner/pick/tool_path.h"

#include "models/base/rotation.h"

namespace tubetwin {
namespace {

constexpr double kUpright_rad = 0.01;
constexpr double kSameTurn_rad = 1e-6;
constexpr double kNoMove_m = 1e-9;

/// The shortest turn, in N, that makes the tool point down.
Eigen::AngleAxisd TurnDown(const RigidTransform& X_NE) {
  return Eigen::AngleAxisd(RotationBetween(X_NE.linear().col(2), -Vector3::UnitZ()));
}

double AngleBetween(const RigidTransform& a, const RigidTransform& b) {
  return Eigen::AngleAxisd(Matrix3(a.linear().transpose() * b.linear())).angle();
}

}  // namespace

bool PointsDown(const RigidTransform& X_NE) { return TurnDown(X_NE).angle() < kUpright_rad; }

std::vector<RigidTransform> ToolPath(const ObjectPath& way, const RigidTransform& X_NE_grasp) {
  std::vector<RigidTransform> out;
  for (std::size_t k = 1; k < way.waypoints_N.size(); ++k) {
    out.push_back(PoseAt(way, k) * X_NE_grasp);
  }
  if (!out.empty() && !PointsDown(out.back())) out.push_back(Upright(out.back()));
  return out;
}

RigidTransform Upright(const RigidTransform& X_NE) {
  if (PointsDown(X_NE)) return X_NE;
  return MakeTransform(TurnDown(X_NE).toRotationMatrix() * X_NE.linear(), X_NE.translation());
}

SplitPath SplitAt(const std::vector<RigidTransform>& X_NE, const RigidTransform& X_NE_grasp,
                  double cut_m) {
  SplitPath out;
  double gone_m = 0.0;
  bool cut = false;
  RigidTransform before = X_NE_grasp;
  for (const RigidTransform& pose : X_NE) {
    const Vector3 leg = pose.translation() - before.translation();
    const double leg_m = leg.norm();
    if (leg_m < kNoMove_m && AngleBetween(before, pose) < kSameTurn_rad) continue;
    if (cut) {
      out.rest.push_back(pose);
    } else if (gone_m + leg_m > cut_m && gone_m < cut_m && PointsDown(pose) &&
               AngleBetween(before, pose) < kSameTurn_rad) {
      out.first.push_back(
          MakeTransform(pose.linear(), before.translation() + (cut_m - gone_m) / leg_m * leg));
      out.rest.push_back(pose);
      cut = true;
    } else {
      out.first.push_back(pose);
      cut = gone_m + leg_m >= cut_m && PointsDown(pose);
    }
    gone_m += leg_m;
    before = pose;
  }
  return out;
}

}  // namespace tubetwin

// Inverse kinematics of any geometry: damped Gauss-Newton steps from many starts, until no solution
// is left that was met only once or twice.
//
// Starts are points of a Halton sequence over the joints, so that the same pose gives the same
// answer everywhere. The damping is half the squared error (Sugihara, "Solvability-unconcerned
// inverse kinematics by the Levenberg-Marquardt method", IEEE T-RO 27(5), 2011): strong far away,
// none at the goal. How much of the starts' space leads to solutions not met yet is estimated by
// the share of starts whose solution was met once (Good and Turing).

#include <algorithm>
#include <cmath>
#include <optional>

#include "models/arm/inverse/geometry.h"
#include "models/arm/inverse/inverse_method.h"
#include "models/arm/inverse/pose_steps.h"

namespace tubetwin {
namespace {

constexpr int kFewestStarts = 120;
constexpr int kMostStarts = 600;
constexpr int kStartsWithoutAny = 200;      // no solution until then: out of reach
constexpr int kMeetings = 3;                // of every solution, before the search ends
constexpr int kSteps = 40;                  // of one start
constexpr int kLook = 8;                    // steps after which the error must have halved
constexpr double kLever_m = 0.3;            // what a radian counts
constexpr double kNear = 1e-4;              // error from which plain Newton steps finish
constexpr double kSame_rad = 1e-5;          // solutions closer than this are one
constexpr double kSingular = 3e-5;          // smallest singular value at a singular pose
constexpr double kSameSingular_rad = 1e-4;  // there rounding moves joints by its square root
constexpr int kMostSingular = 8;            // members that stand for a continuum

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Flange pose and its Jacobian at q, in one pass.
struct Kinematics {
  RigidTransform X_BF;
  JacobianMatrix J;

  Kinematics(const ArmModel& arm, const JointVector& q) {
    const auto X_BL = LinkPoses(arm, q);
    X_BF = X_BL[kNumJoints] * arm.X_6F;
    for (int i = 0; i < kNumJoints; ++i) {
      const Vector3 axis_B = X_BL[i + 1].linear() * arm.joints[i].axis;
      J.block<3, 1>(0, i) = axis_B.cross(X_BF.translation() - X_BL[i + 1].translation());
      J.block<3, 1>(3, i) = axis_B;
    }
  }
};

/// Point `index` of the Halton sequence, each joint over a full turn.
JointVector Start(int index) {
  constexpr std::array<int, kNumJoints> kPrimes = {2, 3, 5, 7, 11, 13};
  JointVector q;
  for (int i = 0; i < kNumJoints; ++i) {
    double fraction = 1.0, value = 0.0;
    for (int n = index + 1; n > 0; n /= kPrimes[i]) {
      fraction /= kPrimes[i];
      value += fraction * (n % kPrimes[i]);
    }
    q[i] = 2 * kPi * (value - 0.5);
  }
  return q;
}

/// One descent; nothing when it ends in a place that is no solution.
std::optional<JointVector> Descend(const ArmModel& arm, const RigidTransform& X_BF, JointVector q) {
  double looked_at = 1e9;
  for (int i = 0; i < kSteps; ++i) {
    Kinematics here(arm, q);
    const Eigen::AngleAxisd turn(Matrix3(X_BF.linear() * here.X_BF.linear().transpose()));
    Vector6 error;
    error << X_BF.translation() - here.X_BF.translation(), kLever_m * turn.angle() * turn.axis();
    const double size = error.norm();
    if (size < kNear) return PolishJoints(arm, X_BF, q, 6);
    if (i % kLook == kLook - 1) {
      if (size > 0.5 * looked_at) return std::nullopt;
      looked_at = size;
    }
    here.J.bottomRows<3>() *= kLever_m;
    const JacobianMatrix damped =
        here.J * here.J.transpose() + 0.5 * size * size * JacobianMatrix::Identity();
    q += here.J.transpose() * damped.ldlt().solve(error);
  }
  return std::nullopt;
}

/// Whether solutions may lie side by side here: a continuum, or two that are about to part.
bool IsSingular(const ArmModel& arm, const JointVector& q) {
  const JacobianMatrix J = Kinematics(arm, q).J;
  const Eigen::SelfAdjointEigenSolver<JacobianMatrix> eigen(J * J.transpose(),
                                                            Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] < kSingular * kSingular;
}

struct Found {
  JointVector q;
  bool singular = false;
  int meetings = 1;
};

std::vector<JointVector> SolveNumeric(const ArmModel& arm, const RigidTransform& X_BF) {
  std::vector<Found> found;
  int singular_ones = 0;
  for (int start = 0; start < kMostStarts; ++start) {
    if (found.empty() && start >= kStartsWithoutAny) break;
    const bool all_met = std::all_of(found.begin(), found.end(), [](const Found& f) {
      return f.singular || f.meetings >= kMeetings;
    });
    if (start >= kFewestStarts && !found.empty() && all_met) break;
    const auto q = Descend(arm, X_BF, Start(start));
    if (!q) continue;
    const bool singular = IsSingular(arm, *q);
    const double same_rad = singular ? kSameSingular_rad : kSame_rad;
    const auto known = std::find_if(found.begin(), found.end(), [&](const Found& f) {
      return LargestDifference(f.q, *q) < same_rad;
    });
    if (known != found.end()) {
      ++known->meetings;
    } else if (!singular || ++singular_ones <= kMostSingular) {
      found.push_back({*q, singular});
    }
  }
  std::vector<JointVector> out;
  for (const Found& f : found) out.push_back(f.q);
  return out;
}

/// Any six joints will do, as long as they can move the flange in every direction at all.
void CheckNumeric(const ArmModel& arm) {
  double best = 0.0;
  for (int start = 0; start < kFewestStarts; ++start) {
    const JacobianMatrix J = Kinematics(arm, Start(start)).J;
    const Eigen::SelfAdjointEigenSolver<JacobianMatrix> eigen(J * J.transpose(),
                                                              Eigen::EigenvaluesOnly);
    best = std::max(best, eigen.eigenvalues()[0]);
  }
  if (best > kSingular * kSingular) return;
  RefuseGeometry(arm, "in no posture can its six axes move the flange in every direction");
}

}  // namespace

InverseMethod NumericInverse() { return {"numeric", CheckNumeric, SolveNumeric, true}; }

}  // namespace tubetwin

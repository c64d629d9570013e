// Inverse kinematics of an arm with an offset wrist (axes 4, 5, 6 do not meet), complete.
//
// Frames and letters: S shoulder (axes 1 and 2 meet), E elbow, A where axes 4 and 5 meet, W where
// axes 5 and 6 meet, h the unit direction of axis 5 with W = A + w h. The flange pose gives W and
// axis 6; h is perpendicular to axis 6 and has one unknown phase psi: h = cos(psi) x6 + sin(psi)
// y6. S, E, A form a triangle with two known sides in the vertical plane through A, and axis 4
// (along E A) is perpendicular to axis 5. With a = A - S, D = |a|^2, z = a_z, c = a.h,
// k = D + L2^2 - L1^2 that closure reads, with the elbow's sign squared away and D divided out,
//
//     k^2 (c^2 + D hz^2 - 2 hz z c) - 4 L2^2 (D hz - z c)^2 = 0,
//
// a trigonometric polynomial of degree 4 in psi (the terms of degree 5 cancel), hence of degree 8
// in exp(i psi): sample it, transform, take the companion matrix's eigenvalues near the unit
// circle, polish each with Newton steps on the unsquared closure of either elbow, read the joints.

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "models/arm/arm.h"
#include "models/base/error.h"
#include "models/base/rotation.h"

namespace tubetwin {
namespace {

constexpr int kDegree = 8;
constexpr int kSamples = 16;
constexpr double kPoseTolerance = 1e-9;     // metres and radians, of every returned solution
constexpr double kUnitCircleBand = 0.05;    // double roots leave the circle by about 1e-4 at most
constexpr double kSameSolution_rad = 1e-6;  // closer ones are one solution found twice
constexpr double kNewtonReach_rad = 0.35;   // InverseNear: further away all branches are compared
constexpr double kFamilyStep_rad = 0.035;   // InverseWorking: tilt per continuation step
constexpr double kFamilyJump_rad = 0.35;    // a larger joint step means another branch

double WrapToPi(double angle) {
  const double wrapped = std::remainder(angle, 2 * kPi);
  return wrapped <= -kPi ? wrapped + 2 * kPi : wrapped;
}

/// Lengths of the offset-wrist arm, and one target seen from the shoulder.
struct Target {
  double L1, L2, w;  // shoulder-elbow, elbow-A, A-W
  Vector3 b;         // W - S
  Matrix3 R_B6;

  Target(const ArmModel& arm, const RigidTransform& X_BF) {
    const RigidTransform X_B6 = X_BF * arm.X_6F.inverse();
    L1 = arm.joints[2].origin_in_parent_m.z();
    L2 = -arm.joints[3].origin_in_parent_m.z();
    w = arm.joints[4].origin_in_parent_m.y();
    b = X_B6.translation() - arm.joints[0].origin_in_parent_m;
    R_B6 = X_B6.linear();
  }

  Vector3 AxisFive(double psi) const {
    return std::cos(psi) * R_B6.col(0) + std::sin(psi) * R_B6.col(1);
  }
  double Polynomial(double psi) const {
    const Vector3 h = AxisFive(psi);
    const Vector3 a = b - w * h;
    const double D = a.squaredNorm(), z = a.z(), c = a.dot(h);
    const double k = D + L2 * L2 - L1 * L1;
    const double m = D * h.z() - z * c;
    return k * k * (c * c + D * h.z() * h.z() - 2 * h.z() * z * c) - 4 * L2 * L2 * m * m;
  }
};

/// The triangle S, E, A for one phase and elbow sign.
struct Triangle {
  Vector3 h, a, e;       // e = E - S
  double closure = 0.0;  // h.(E - A) / L2
};

std::optional<Triangle> SolveTriangle(const Target& t, double psi, double elbow) {
  Triangle out;
  out.h = t.AxisFive(psi);
  out.a = t.b - t.w * out.h;
  const double d = out.a.norm();
  const double r = std::hypot(out.a.x(), out.a.y());
  if (d < 1e-6 || r < 1e-9) return std::nullopt;  // A on axis 1: the arm's plane is undefined.
  const double along = (d * d + t.L1 * t.L1 - t.L2 * t.L2) / (2 * d);
  const double across_sq = t.L1 * t.L1 - along * along;
  // A negative value is a false root; a tiny one is the straight arm within rounding.
  if (across_sq < -1e-12) return std::nullopt;
  const Vector3 radial(out.a.x() / r, out.a.y() / r, 0.0);
  const Vector3 normal = (-out.a.z() * radial + r * Vector3::UnitZ()) / d;
  out.e = along / d * out.a + elbow * std::sqrt(std::max(0.0, across_sq)) * normal;
  out.closure = out.h.dot(out.e - out.a) / t.L2;
  return out;
}

/// Newton steps on the closure with a central difference; nothing when it leaves the reach.
std::optional<double> PolishPhase(const Target& t, double psi, double elbow) {
  constexpr double kStep = 1e-6;
  constexpr int kIterations = 12;
  for (int i = 0; i < kIterations; ++i) {
    const auto here = SolveTriangle(t, psi, elbow);
    if (!here) return std::nullopt;
    if (std::abs(here->closure) < 1e-15) break;
    const auto plus = SolveTriangle(t, psi + kStep, elbow);
    const auto minus = SolveTriangle(t, psi - kStep, elbow);
    if (!plus || !minus) break;
    const double slope = (plus->closure - minus->closure) / (2 * kStep);
    if (std::abs(slope) < 1e-9) break;
    const double step = std::clamp(here->closure / slope, -0.05, 0.05);
    psi -= step;
    if (std::abs(step) < 1e-14) break;
  }
  return psi;
}

/// Phases near which the polynomial vanishes: at most eight.
std::vector<double> RootPhases(const Target& t) {
  using Complex = std::complex<double>;
  std::array<double, kSamples> sample;
  double largest = 0.0;
  for (int j = 0; j < kSamples; ++j) {
    sample[j] = t.Polynomial(2 * kPi * j / kSamples);
    largest = std::max(largest, std::abs(sample[j]));
  }
  if (largest == 0.0) return {};
  std::array<Complex, kDegree + 1> coefficient;  // of z^0..z^8, z = exp(i psi)
  for (int n = 0; n <= kDegree; ++n) {
    Complex sum = 0.0;
    for (int j = 0; j < kSamples; ++j) {
      sum += sample[j] * std::polar(1.0, -2 * kPi * j * (n - kDegree / 2) / kSamples);
    }
    coefficient[n] = sum / (kSamples * largest);
  }
  // The polynomial is self-reciprocal: a vanishing leading coefficient lowers both ends alike.
  int low = 0;
  while (low < kDegree / 2 && std::abs(coefficient[kDegree - low]) < 1e-13) ++low;
  const int degree = kDegree - 2 * low;
  if (degree == 0) return {};
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(degree, degree);
  for (int n = 0; n < degree; ++n) {
    companion(n, degree - 1) = -coefficient[low + n] / coefficient[low + degree];
    if (n > 0) companion(n, n - 1) = 1.0;
  }
  // A companion matrix has Hessenberg form as it is: its eigenvalues are the diagonal of its Schur
  // form. (ComplexEigenSolver would bring it into that form again, and compile for 8 s.)
  Eigen::ComplexSchur<Eigen::MatrixXcd> schur(degree);
  schur.computeFromHessenberg(companion, companion, false);
  Eigen::VectorXcd roots = schur.matrixT().diagonal();
  const auto smaller = [](const Complex& a, const Complex& b) { return std::abs(a) < std::abs(b); };
  for (auto from = roots.begin(); from != roots.end(); ++from) {
    std::iter_swap(from, std::min_element(from, roots.end(), smaller));
  }
  std::vector<double> phases;
  for (const Complex& root : roots) {
    if (std::abs(std::abs(root) - 1.0) < kUnitCircleBand) phases.push_back(std::arg(root));
  }
  return phases;
}

/// Joints from the triangle; `flip`: axis 1 turned by half a turn, same A and E.
JointVector ReadJoints(const Target& t, double psi, const Triangle& s, bool flip) {
  JointVector q;
  q[0] = std::atan2(s.a.y(), s.a.x()) + (flip ? kPi : 0.0);
  const Matrix3 R_B1 = RotZ(q[0]);
  const Vector3 e_1 = R_B1.transpose() * s.e;
  const Vector3 up_1 = R_B1.transpose() * (s.e - s.a);  // z of link 3
  q[1] = std::atan2(e_1.x(), e_1.z());
  const double pitch = std::atan2(up_1.x(), up_1.z());  // q2 - q3
  q[2] = q[1] - pitch;
  const Matrix3 R_B3 = R_B1 * RotY(pitch);
  const Vector3 h_3 = R_B3.transpose() * s.h;
  q[3] = std::atan2(-h_3.x(), h_3.y());
  q[5] = kPi / 2 - psi;
  const Matrix3 R_45 = (R_B3 * RotZ(q[3])).transpose() * t.R_B6 * RotZ(-q[5]);
  q[4] = -std::atan2(R_45(0, 2), R_45(2, 2));
  return q;
}

double PoseError(const RigidTransform& X_BF, const RigidTransform& X_BGoal) {
  const double turn = (X_BF.linear() - X_BGoal.linear()).norm();
  return std::max(turn, (X_BF.translation() - X_BGoal.translation()).norm());
}

/// q3 into its range, all others into (-pi, pi].
void WrapIntoRange(const ArmModel& arm, JointVector& q) {
  for (int i = 0; i < kNumJoints; ++i) q[i] = WrapToPi(q[i]);
  while (q[2] < arm.joints[2].lower_rad) q[2] += 2 * kPi;
  while (q[2] > arm.joints[2].upper_rad) q[2] -= 2 * kPi;
}

double LargestDifference(const JointVector& a, const JointVector& b) {
  double largest = 0.0;
  for (int i = 0; i < kNumJoints; ++i) {
    largest = std::max(largest, std::abs(WrapToPi(a[i] - b[i])));
  }
  return largest;
}

/// Newton steps from q towards the pose; nothing when they do not converge at once.
std::optional<JointVector> PolishJoints(const ArmModel& arm, const RigidTransform& X_BF,
                                        JointVector q, int iterations) {
  for (int i = 0; i <= iterations; ++i) {
    const RigidTransform X_BNow = FlangePose(arm, q);
    if (PoseError(X_BNow, X_BF) < 0.1 * kPoseTolerance) return q;
    if (i == iterations) break;
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = X_BF.translation() - X_BNow.translation();
    const Eigen::AngleAxisd turn(Matrix3(X_BF.linear() * X_BNow.linear().transpose()));
    error.tail<3>() = turn.angle() * turn.axis();
    // A trace of damping keeps the step finite at a singular pose.
    const JacobianMatrix J = Jacobian(arm, q, RigidTransform::Identity());
    const JacobianMatrix damped = J * J.transpose() + 1e-12 * JacobianMatrix::Identity();
    const JointVector step = J.transpose() * damped.ldlt().solve(error);
    if (!step.allFinite() || step.cwiseAbs().maxCoeff() > kNewtonReach_rad) return std::nullopt;
    q += step;
  }
  return std::nullopt;
}

/// Each joint moved by full turns to where it is nearest to q_near within [lower, upper] less the
/// margin; nothing when a joint has no place there.
std::optional<JointVector> NearestWithinLimits(const ArmModel& arm, const JointVector& q,
                                               const JointVector& q_near, double margin_rad) {
  JointVector out;
  for (int i = 0; i < kNumJoints; ++i) {
    double best = 0.0, best_distance = -1.0;
    for (int turn = -2; turn <= 2; ++turn) {
      const double value = q[i] + 2 * kPi * turn;
      if (value < arm.joints[i].lower_rad + margin_rad) continue;
      if (value > arm.joints[i].upper_rad - margin_rad) continue;
      const double distance = std::abs(value - q_near[i]);
      if (best_distance < 0.0 || distance < best_distance) {
        best = value;
        best_distance = distance;
      }
    }
    if (best_distance < 0.0) return std::nullopt;
    out[i] = best;
  }
  return out;
}

}  // namespace

std::vector<JointVector> InverseAll(const ArmModel& arm, const RigidTransform& X_BF) {
  const Target target(arm, X_BF);
  std::vector<JointVector> solutions;
  for (const double phase : RootPhases(target)) {
    for (const double elbow : {1.0, -1.0}) {
      const auto psi = PolishPhase(target, phase, elbow);
      if (!psi) continue;
      const auto triangle = SolveTriangle(target, *psi, elbow);
      if (!triangle || std::abs(triangle->closure) > 1e-6) continue;
      for (const bool flip : {false, true}) {
        JointVector q = ReadJoints(target, *psi, *triangle, flip);
        if (PoseError(FlangePose(arm, q), X_BF) > kPoseTolerance) {
          const auto polished = PolishJoints(arm, X_BF, q, 4);
          if (!polished) continue;
          q = *polished;
        }
        WrapIntoRange(arm, q);
        const bool known =
            std::any_of(solutions.begin(), solutions.end(), [&](const JointVector& other) {
              return LargestDifference(q, other) < kSameSolution_rad;
            });
        if (!known) solutions.push_back(q);
      }
    }
  }
  std::sort(solutions.begin(), solutions.end(), [](const JointVector& a, const JointVector& b) {
    return std::lexicographical_compare(a.data(), a.data() + kNumJoints, b.data(),
                                        b.data() + kNumJoints);
  });
  return solutions;
}

InverseNearResult InverseNear(const ArmModel& arm, const RigidTransform& X_BF,
                              const JointVector& q_near, double margin_rad) {
  using Status = InverseNearResult::Status;
  if (const auto q = PolishJoints(arm, X_BF, q_near, 6)) {
    if ((*q - q_near).cwiseAbs().maxCoeff() < kNewtonReach_rad) {
      const auto inside = NearestWithinLimits(arm, *q, q_near, margin_rad);
      if (inside && (*inside - *q).cwiseAbs().maxCoeff() < 1e-9) return {Status::kFound, *inside};
    }
  }
  const auto all = InverseAll(arm, X_BF);
  if (all.empty()) return {Status::kUnreachable, q_near};
  InverseNearResult best{Status::kOutsideLimits, q_near};
  double best_distance = 0.0;
  for (const JointVector& q : all) {
    const auto inside = NearestWithinLimits(arm, q, q_near, margin_rad);
    if (!inside) continue;
    const double distance = (*inside - q_near).cwiseAbs().maxCoeff();
    if (best.status == Status::kFound && distance >= best_distance) continue;
    best = {Status::kFound, *inside};
    best_distance = distance;
  }
  return best;
}

namespace {

/// Front, elbow up, q4 nearest to 0, for a tool exactly along the vertical.
std::optional<JointVector> WorkingVertical(const ArmModel& arm, const RigidTransform& X_BF) {
  std::optional<JointVector> best;
  for (const JointVector& q : InverseAll(arm, X_BF)) {
    const auto X_BL = LinkPoses(arm, q);
    const Vector3 a_1 = X_BL[1].inverse() * X_BL[4].translation();
    const bool front = a_1.x() > 0.0;
    const bool elbow_up = q[2] > 0.0 && q[2] < kPi;
    if (!front || !elbow_up || std::abs(q[3]) > kPi / 3) continue;
    if (!best || std::abs(q[3]) < std::abs((*best)[3])) best = q;
  }
  return best;
}

}  // namespace

InverseNearResult InverseWorking(const ArmModel& arm, const RigidTransform& X_BF,
                                 double q6_near_rad) {
  using Status = InverseNearResult::Status;
  // Tilt the tool back to the vertical about the wrist W, where the family is plain, and follow it
  // from there.
  const Vector3 axis_B = X_BF.linear().col(2);
  const Vector3 pole_B = axis_B.z() > 0 ? Vector3::UnitZ() : Vector3(-Vector3::UnitZ());
  const Eigen::AngleAxisd tilt(RotationBetween(pole_B, axis_B));
  const Vector3 p_BW = (X_BF * arm.X_6F.inverse()).translation();
  const auto pose_at = [&](double share) {
    const Matrix3 R = Eigen::AngleAxisd((share - 1.0) * tilt.angle(), tilt.axis()).matrix();
    return Translation(p_BW) * MakeTransform(R, Vector3::Zero()) * Translation(-p_BW) * X_BF;
  };
  const auto start = WorkingVertical(arm, pose_at(0.0));
  if (!start) return {Status::kUnreachable, JointVector::Zero()};
  JointVector q = *start;
  const int steps = tilt.angle() < 1e-9 ? 0 : 1 + static_cast<int>(tilt.angle() / kFamilyStep_rad);
  for (int i = 1; i <= steps; ++i) {
    const auto next = PolishJoints(arm, pose_at(static_cast<double>(i) / steps), q, 8);
    if (!next || (*next - q).cwiseAbs().maxCoeff() > kFamilyJump_rad) {
      return {Status::kUnreachable, JointVector::Zero()};
    }
    q = *next;
  }
  JointVector q_near = q;
  q_near[5] = q6_near_rad;
  const auto inside = NearestWithinLimits(arm, q, q_near, 0.0);
  if (!inside) return {Status::kOutsideLimits, q};
  return {Status::kFound, *inside};
}

}  // namespace tubetwin

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

#include "models/arm/inverse/geometry.h"
#include "models/arm/inverse/inverse_method.h"

namespace tubetwin {
namespace {

constexpr int kDegree = 8;
constexpr int kSamples = 16;
constexpr double kUnitCircleBand = 0.05;  // double roots leave the circle by about 1e-4 at most

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
  constexpr int kMiddle = kDegree / 2;
  std::array<Complex, kDegree + 1> coefficient;  // of z^0..z^8, z = exp(i psi)
  for (int n = 0; n <= kDegree; ++n) {
    Complex sum = 0.0;
    for (int j = 0; j < kSamples; ++j) {
      sum += sample[j] * std::polar(1.0, -2 * kPi * j * (n - kMiddle) / kSamples);
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
  const Matrix3 R_B4 = R_B3 * RotZ(q[3]);
  const Matrix3 R_45 = R_B4.transpose() * t.R_B6 * RotZ(-q[5]);
  q[4] = -std::atan2(R_45(0, 2), R_45(2, 2));
  return q;
}

/// The polynomial is written for these axes, and for each origin along one of them.
void CheckOffsetWrist(const ArmModel& arm) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  const std::array<Vector3, kNumJoints> axes = {z, y, -y, z, -y, z};
  // Directions in which an axis may lie off the one before.
  const std::array<Vector3, kNumJoints> free = {x + y + z, Vector3::Zero(), z, z,
                                                y,         Vector3::Zero()};
  for (int i = 0; i < kNumJoints; ++i) {
    const ArmModel::Joint& joint = arm.joints[i];
    if ((joint.axis - axes[i]).norm() > kSameGeometry) {
      RefuseGeometry(arm, "axis " + std::to_string(i + 1) + " points along " +
                              VectorText(joint.axis) + ", but has to point along " +
                              VectorText(axes[i]));
    }
    const Vector3 off = joint.origin_in_parent_m.cwiseProduct(Vector3::Ones() - free[i]);
    if (off.norm() > kSameGeometry) {
      RefuseGeometry(arm, "axis " + std::to_string(i + 1) + " lies " + VectorText(off) +
                              " m off axis " + std::to_string(i) + ", which has to be zero");
    }
  }
  if (arm.joints[2].origin_in_parent_m.z() <= 0 || arm.joints[3].origin_in_parent_m.z() >= 0) {
    RefuseGeometry(arm, "axis 3 has to lie above axis 2, and axis 4 below axis 3, at zero");
  }
}

std::vector<JointVector> SolveOffsetWrist(const ArmModel& arm, const RigidTransform& X_BF) {
  const Target target(arm, X_BF);
  std::vector<JointVector> candidates;
  for (const double phase : RootPhases(target)) {
    for (const double elbow : {1.0, -1.0}) {
      const auto psi = PolishPhase(target, phase, elbow);
      if (!psi) continue;
      const auto triangle = SolveTriangle(target, *psi, elbow);
      if (!triangle || std::abs(triangle->closure) > 1e-6) continue;
      for (const bool flip : {false, true}) {
        candidates.push_back(ReadJoints(target, *psi, *triangle, flip));
      }
    }
  }
  return candidates;
}

}  // namespace

InverseMethod OffsetWristInverse() {
  return {"offset_wrist", CheckOffsetWrist, SolveOffsetWrist, false};
}

}  // namespace tubetwin

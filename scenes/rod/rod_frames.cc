#include "scenes/rod/rod_frames.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Dense>

#include "models/base/error.h"
#include "models/base/rotation.h"

namespace tubetwin {
namespace {

constexpr double kPoisson = 0.5;             // Rubber hardly changes its volume.
constexpr double kFirstFreeRoot = 4.730041;  // Of cosh(x) cos(x) = 1.

std::vector<Vector3> Tangents(const Polyline& line) {
  std::vector<Vector3> tangents;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    tangents.push_back((line[i + 1] - line[i]).normalized());
  }
  return tangents;
}

// Twist-free frames along the links: z along the link, each turned from the one before by the
// smallest rotation.
std::vector<Matrix3> TwistFreeFrames(const std::vector<Vector3>& tangents) {
  std::vector<Matrix3> frames(tangents.size());
  frames[0].col(2) = tangents[0];
  frames[0].col(0) = tangents[0].unitOrthogonal();
  frames[0].col(1) = tangents[0].cross(frames[0].col(0));
  for (std::size_t i = 1; i < tangents.size(); ++i) {
    const Matrix3 turn = RotationBetween(tangents[i - 1], tangents[i]).toRotationMatrix();
    frames[i] = turn * frames[i - 1];
    frames[i].col(2) = tangents[i];
  }
  return frames;
}

// Bend between link i and i + 1 as a rotation vector in the frame's x and y.
std::complex<double> Bend(const std::vector<Matrix3>& frames, std::size_t i) {
  const Vector3 axis = frames[i].col(2).cross(frames[i + 1].col(2));
  const double sine = axis.norm();
  if (sine < 1e-12) return 0.0;
  const double angle = std::atan2(sine, frames[i].col(2).dot(frames[i + 1].col(2)));
  const Vector3 bend = axis * (angle / sine);
  return {bend.dot(frames[i].col(0)), bend.dot(frames[i].col(1))};
}

// The elastic energy of a rod by the turn of each link's material against its twist-free frame.
class TurnEnergy {
 public:
  TurnEnergy(const std::vector<Matrix3>& current, const std::vector<Matrix3>& rest,
             const std::vector<double>& joint_m, const RodStiffness& stiffness) {
    for (std::size_t i = 0; i + 1 < current.size(); ++i) {
      bends_.push_back(Bend(current, i));
      rest_bends_.push_back(Bend(rest, i));
      bending_.push_back(stiffness.bending_Nm2 / joint_m[i]);
      torsion_.push_back(stiffness.torsion_Nm2 / joint_m[i]);
    }
  }

  // All links turned alike: the best of those is known in closed form.
  double BestCommonTurn() const {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < bends_.size(); ++i) {
      sum += bending_[i] * bends_[i] * std::conj(rest_bends_[i]);
    }
    return std::abs(sum) > 1e-12 ? std::arg(sum) : 0.0;
  }

  double At(const Eigen::VectorXd& turns) const {
    double energy = 0.0;
    for (std::size_t i = 0; i < bends_.size(); ++i) {
      energy += bending_[i] * std::norm(Seen(turns, i) - rest_bends_[i]);
      energy += torsion_[i] * std::pow(turns[Index(i) + 1] - turns[Index(i)], 2);
    }
    return energy;
  }

  // Gradient and Gauss-Newton Hessian of At.
  void Derivatives(const Eigen::VectorXd& turns, Eigen::VectorXd& gradient,
                   Eigen::MatrixXd& hessian) const {
    gradient.setZero(turns.size());
    hessian.setZero(turns.size(), turns.size());
    for (std::size_t i = 0; i < bends_.size(); ++i) {
      const Eigen::Index a = Index(i), b = a + 1;
      const std::complex<double> seen = Seen(turns, i);
      // Both links' turns move the joint by half: d seen / d turn = -i seen / 2.
      const std::complex<double> slope = std::complex<double>(0.0, -0.5) * seen;
      const std::complex<double> off = seen - rest_bends_[i];
      const double pull = 2.0 * bending_[i] * (slope * std::conj(off)).real();
      const double stiff = 2.0 * bending_[i] * std::norm(slope);
      const double twist = 2.0 * torsion_[i] * (turns[b] - turns[a]);
      gradient[a] += pull - twist;
      gradient[b] += pull + twist;
      hessian(a, a) += stiff + 2.0 * torsion_[i];
      hessian(b, b) += stiff + 2.0 * torsion_[i];
      hessian(a, b) += stiff - 2.0 * torsion_[i];
      hessian(b, a) += stiff - 2.0 * torsion_[i];
    }
  }

 private:
  static Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  // The bend in the material's frame, half way between those of both links.
  std::complex<double> Seen(const Eigen::VectorXd& turns, std::size_t i) const {
    const double turn = 0.5 * (turns[Index(i)] + turns[Index(i) + 1]);
    return bends_[i] * std::polar(1.0, -turn);
  }

  std::vector<std::complex<double>> bends_, rest_bends_;
  std::vector<double> bending_, torsion_;
};

// Levenberg and Marquardt from the best common turn.
Eigen::VectorXd BestTurns(const TurnEnergy& energy, std::size_t links) {
  constexpr int kTries = 50;
  constexpr double kSmallest = 1e-12;
  Eigen::VectorXd turns =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(links), energy.BestCommonTurn());
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  double now = energy.At(turns), damping = 1e-6;
  energy.Derivatives(turns, gradient, hessian);
  for (int i = 0; i < kTries; ++i) {
    Eigen::MatrixXd damped = hessian;
    damped.diagonal().array() += damping * (1.0 + hessian.diagonal().maxCoeff());
    const Eigen::VectorXd step = damped.ldlt().solve(gradient);
    const double next = energy.At(turns - step);
    if (next > now) {
      damping *= 10.0;
      continue;
    }
    turns -= step;
    const bool done = now - next < kSmallest;
    now = next;
    if (done) break;
    damping = std::max(1e-12, 0.1 * damping);
    energy.Derivatives(turns, gradient, hessian);
  }
  return turns;
}

}  // namespace

double TorsionalStiffness(double bending_Nm2) { return bending_Nm2 / (1.0 + kPoisson); }

double FirstFreeBending(double bending_Nm2, double mass_kg, double length_m) {
  TT_CHECK(mass_kg > 0.0 && length_m > 0.0);
  return std::pow(kFirstFreeRoot / length_m, 2) * std::sqrt(bending_Nm2 * length_m / mass_kg);
}

RodFrames LeastEnergyFrames(const Polyline& current, const Polyline& rest,
                            const RodStiffness& stiffness) {
  TT_CHECK(current.size() >= 3 && rest.size() == current.size());
  RodFrames frames{TwistFreeFrames(Tangents(current)), TwistFreeFrames(Tangents(rest))};
  std::vector<double> joint_m;
  for (std::size_t i = 0; i + 2 < current.size(); ++i) {
    joint_m.push_back(0.5 * (current[i + 2] - current[i + 1]).norm() +
                      0.5 * (current[i + 1] - current[i]).norm());
  }
  const TurnEnergy energy(frames.current, frames.rest, joint_m, stiffness);
  const Eigen::VectorXd turns = BestTurns(energy, frames.current.size());
  for (std::size_t i = 0; i < frames.current.size(); ++i) {
    frames.current[i] = frames.current[i] * RotZ(turns[static_cast<Eigen::Index>(i)]);
  }
  return frames;
}

RodJoint JointBetween(const Matrix3& R_ParentChild, const Matrix3& rest_R_ParentChild) {
  RodJoint joint;
  const Vector3 parent_z = R_ParentChild.transpose() * Vector3::UnitZ();
  const Vector3 mean = (parent_z + Vector3::UnitZ()).normalized();
  joint.axes = RotationBetween(Vector3::UnitZ(), mean).toRotationMatrix();
  const Matrix3 R =
      joint.axes.transpose() * R_ParentChild.transpose() * rest_R_ParentChild * joint.axes;
  // The hinges follow each other: R = Rx Ry Rz.
  joint.rest_rad = {std::atan2(-R(1, 2), R(2, 2)), std::asin(std::clamp(R(0, 2), -1.0, 1.0)),
                    std::atan2(-R(0, 1), R(0, 0))};
  return joint;
}

}  // namespace tubetwin

#include "models/arm/arm.h"

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>

#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/joints.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

constexpr double kTablePosition_m = 1e-6;  // the reference tables print six decimals
constexpr double kTableAngle_deg = 1e-4;   // ... and four of a degree
constexpr double kRounding = 1e-12;

JointVector Deg(double s, double l, double u, double r, double b, double t) {
  JointVector q;
  q << s, l, u, r, b, t;
  return q * kPi / 180.0;
}

JointVector RandomJoints(RandomStream& stream) {
  JointVector q;
  for (int i = 0; i < kNumJoints; ++i) {
    q[i] = stream.Uniform(PaperCell().arm.joints[i].lower_rad, PaperCell().arm.joints[i].upper_rad);
  }
  return q;
}

TEST_CASE("The flange stands where the vendor's joint table puts it", "[unit]") {
  struct Row {
    JointVector q;
    Vector3 p;
    Matrix3 R;
  };
  const auto rows = [](std::initializer_list<double> v) {
    Matrix3 R;
    auto it = v.begin();
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = *it++;
    return R;
  };
  const Row table[] = {
      {Deg(0, 0, 0, 0, 0, 0), {0, 0.162, 0.345}, rows({1, 0, 0, 0, -1, 0, 0, 0, -1})},
      {Deg(30, 0, 0, 0, 0, 0),
       {-0.081, 0.140296, 0.345},
       rows({0.866025, 0.5, 0, 0.5, -0.866025, 0, 0, 0, -1})},
      {Deg(0, 20, 90, 0, 0, 0),
       {0.831420, 0.162, 0.717312},
       rows({0.342020, 0, 0.939693, 0, -1, 0, 0.939693, 0, -0.342020})},
      {Deg(10, 20, 100, 30, -40, 50),
       {0.773949, 0.236503, 0.677631},
       rows({0.250188, 0.665140, 0.703559, 0.967763, -0.150037, -0.202295, -0.028995, 0.731490,
             -0.681236})},
      {Deg(0, 30, 120, 0, 90, 0), {0.85, 0.162, 1.011218}, rows({-1, 0, 0, 0, -1, 0, 0, 0, 1})}};
  for (const Row& row : table) {
    const RigidTransform X_BF = FlangePose(PaperCell().arm, row.q);
    CHECK((X_BF.translation() - row.p).cwiseAbs().maxCoeff() < kTablePosition_m);
    CHECK((X_BF.linear() - row.R).cwiseAbs().maxCoeff() < kTablePosition_m);
  }
}

TEST_CASE("Forward kinematics agrees with KDL over random joints", "[unit]") {
  using KDL::Frame, KDL::Joint, KDL::Segment, KDL::Vector;
  const Joint::JointType types[] = {Joint::RotZ, Joint::RotY, Joint::RotY,
                                    Joint::RotZ, Joint::RotY, Joint::RotZ};
  const double signs[] = {1, 1, -1, 1, -1, 1};
  // A KDL segment turns first and is translated to its tip then.
  const Vector tips[] = {{0, 0, 0},     {0, 0, 0.700}, {0, 0, -0.500},
                         {0, 0.162, 0}, {0, 0, 0},     {0, 0, -0.130}};
  KDL::Chain chain;
  chain.addSegment(Segment(Joint(Joint::None), Frame(Vector(0, 0, 0.275))));
  for (int i = 0; i < kNumJoints; ++i) {
    const KDL::Rotation roll = i == 5 ? KDL::Rotation::RotX(kPi) : KDL::Rotation::Identity();
    chain.addSegment(Segment(Joint(types[i], signs[i]), Frame(roll, tips[i])));
  }
  KDL::ChainFkSolverPos_recursive solver(chain);
  RandomStream stream(1, 0, "kdl");
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector q = RandomJoints(stream);
    KDL::JntArray joints(kNumJoints);
    joints.data = q;
    Frame frame;
    REQUIRE(solver.JntToCart(joints, frame) == 0);
    const RigidTransform X_BF = FlangePose(PaperCell().arm, q);
    for (int i = 0; i < 3; ++i) {
      CHECK(std::abs(X_BF.translation()[i] - frame.p(i)) < kRounding);
      for (int j = 0; j < 3; ++j) CHECK(std::abs(X_BF.linear()(i, j) - frame.M(i, j)) < kRounding);
    }
  }
}

TEST_CASE("The Jacobian is the derivative of the pose of E", "[unit]") {
  RandomStream stream(2, 0, "jacobian");
  const RigidTransform X_FE = Translation(0.01, -0.02, 0.177);
  constexpr double kStep = 1e-6;
  constexpr double kDifferenceError = 1e-8;  // of a central difference with that step
  for (int trial = 0; trial < 50; ++trial) {
    const JointVector q = RandomJoints(stream);
    const JacobianMatrix J = Jacobian(PaperCell().arm, q, X_FE);
    for (int i = 0; i < kNumJoints; ++i) {
      const JointVector dq = kStep * JointVector::Unit(i);
      const RigidTransform X_a = FlangePose(PaperCell().arm, q - dq) * X_FE;
      const RigidTransform X_b = FlangePose(PaperCell().arm, q + dq) * X_FE;
      const Vector3 v = (X_b.translation() - X_a.translation()) / (2 * kStep);
      const Matrix3 spin = (X_b.linear() - X_a.linear()) / (2 * kStep) * X_a.linear().transpose();
      const Vector3 w(spin(2, 1), spin(0, 2), spin(1, 0));
      CHECK((v - J.block<3, 1>(0, i)).norm() < kDifferenceError);
      CHECK((w - J.block<3, 1>(3, i)).norm() < 1e-5);  // one-sided factor: first order
    }
  }
}

TEST_CASE("All eight solutions of a general pose are found", "[unit]") {
  const std::vector<JointVector> expected = {
      Deg(10, 20, 100, 30, -40, 50),
      Deg(-170, -20, 260, -150, -40, 50),
      Deg(26.7704, 19.6236, 74.6323, -116.6919, 33.8381, -178.7995),
      Deg(-153.2296, -19.6236, 285.3677, 63.3081, 33.8381, -178.7995),
      Deg(9.9278, 91.2086, 278.2262, 29.3537, -139.1601, 96.9624),
      Deg(-170.0722, -91.2086, 81.7738, -150.6463, -139.1601, 96.9624),
      Deg(30.9051, 91.5456, 257.5692, -140.5250, 122.7084, -99.8374),
      Deg(-149.0949, -91.5456, 102.4308, 39.4750, 122.7084, -99.8374)};
  const auto all = InverseAll(PaperCell().arm, FlangePose(PaperCell().arm, expected[0]));
  CHECK(all.size() == expected.size());
  for (const JointVector& q : expected) CHECK(Holds(all, q, Radians(kTableAngle_deg)));
}

TEST_CASE("All twelve solutions of a vertical tool are found", "[unit]") {
  const RigidTransform X_BF = MakeTransform(RotX(kPi), Vector3(0.6, -0.1, 0.1));
  const auto all = InverseAll(PaperCell().arm, X_BF);
  CHECK(all.size() == 12);
  for (const JointVector& q : {Deg(5.9835, 49.7503, 55.7247, 180, 5.9744, 174.0165),
                               Deg(-24.9081, 49.7503, 55.7247, 0, -5.9744, 24.9081),
                               Deg(4.9688, 49.4584, 49.4584, -159.3503, 0, 154.3815),
                               Deg(-23.8934, 49.4584, 49.4584, -20.6497, 0, 44.5432)}) {
    CHECK(Holds(all, q, Radians(kTableAngle_deg)));
  }
}

TEST_CASE("Every inverse solution reaches its pose and the generating joints are among them",
          "[unit]") {
  RandomStream stream(3, 0, "inverse");
  int found = 0, regular = 0, regular_found = 0, odd = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const JointVector q = RandomJoints(stream);
    const RigidTransform X_BF = FlangePose(PaperCell().arm, q);
    const auto all = InverseAll(PaperCell().arm, X_BF);
    CHECK(all.size() <= 16);
    if (all.size() % 2 != 0) ++odd;
    for (const JointVector& other : all) {
      const RigidTransform X = FlangePose(PaperCell().arm, other);
      CHECK((X.translation() - X_BF.translation()).norm() < 1e-9);
      CHECK((X.linear() - X_BF.linear()).norm() < 1e-9);
      CHECK(other[2] >= PaperCell().arm.joints[2].lower_rad);
      CHECK(other[2] <= PaperCell().arm.joints[2].upper_rad);
    }
    const bool hit = Holds(all, q, 1e-5);
    found += hit;
    if (Manipulability(PaperCell().arm, q, RigidTransform::Identity()) > 0.02) {
      ++regular;
      regular_found += hit;
    }
  }
  CHECK(found >= kTrials * 0.9995);  // a root within rounding of a double root may be missed
  CHECK(regular_found == regular);
  CHECK(odd <= 2);  // solutions come in pairs by the flip of the base
}

TEST_CASE("The nearest inverse solution follows small moves and keeps the limits", "[unit]") {
  RandomStream stream(4, 0, "near");
  for (int trial = 0; trial < 300; ++trial) {
    JointVector q = 0.9 * RandomJoints(stream);
    q[2] = std::max(q[2], 0.1);
    if (Manipulability(PaperCell().arm, q, RigidTransform::Identity()) < 0.05) continue;
    JointVector q_near = q;
    for (int i = 0; i < kNumJoints; ++i) q_near[i] += stream.Uniform(-0.01, 0.01);
    const auto result = InverseNear(PaperCell().arm, FlangePose(PaperCell().arm, q), q_near);
    REQUIRE(result.status == InverseNearResult::Status::kFound);
    CHECK((result.q - q).cwiseAbs().maxCoeff() < 1e-6);
  }
  const RigidTransform far = Translation(2.0, 0.0, 0.5);
  CHECK(InverseNear(PaperCell().arm, far, JointVector::Zero()).status ==
        InverseNearResult::Status::kUnreachable);
}

TEST_CASE("The working family is front, elbow up, with joint 4 at zero for a vertical tool",
          "[unit]") {
  for (double x : {0.34, 0.6, 0.86}) {
    for (double y : {-0.36, 0.0, 0.36}) {
      for (double yaw_deg : {-120.0, 0.0, 75.0}) {
        const RigidTransform X_BF =
            MakeTransform(RotX(kPi) * RotZ(Radians(yaw_deg)), Vector3(x, y, 0.30));
        const auto result = InverseWorking(PaperCell().arm, X_BF);
        REQUIRE(result.status == InverseNearResult::Status::kFound);
        CHECK(std::abs(result.q[3]) < 1e-6);
        CHECK(result.q[2] > 0);
        CHECK(result.q[2] < kPi);
        const RigidTransform X = FlangePose(PaperCell().arm, result.q);
        CHECK((X.translation() - X_BF.translation()).norm() < 1e-9);
      }
    }
  }
}

TEST_CASE("The arm's masses add up to the catalogue's and every inertia is physical", "[unit]") {
  double sum = 0;
  for (const auto& link : PaperCell().arm.links) {
    sum += link.mass_kg;
    const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(link.inertia_kgm2);
    const Vector3 moments = eigen.eigenvalues();
    CHECK(moments[0] > 0);
    CHECK(moments[0] + moments[1] > 0.999 * moments[2]);  // triangle inequality, printed digits
  }
  CHECK(std::abs(sum - 47.0) < 0.05);
}

}  // namespace
}  // namespace tubetwin

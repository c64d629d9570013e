// Inverse kinematics by every method: against each other, against KDL, and at the edges.

#include "models/arm/arm.h"

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/joints.h"

namespace tubetwin {
namespace {

constexpr double kFlangeRounding = 1e-12;
constexpr double kPose = 1e-9;              // what InverseAll promises
constexpr double kSameSolution_rad = 1e-5;  // both sides stop at poses that are 1e-9 off at most
constexpr double kRegular = 0.02;           // manipulability; below, solutions fall together

JointVector RandomJoints(const ArmModel& arm, RandomStream& stream) {
  JointVector q;
  for (int i = 0; i < kNumJoints; ++i) {
    q[i] = stream.Uniform(std::max(-kPi, arm.joints[i].lower_rad),
                          std::min(kPi, arm.joints[i].upper_rad));
  }
  return q;
}

double Manipulability(const ArmModel& arm, const JointVector& q) {
  return tubetwin::Manipulability(arm, q, RigidTransform::Identity());
}

ArmModel With(ArmModel arm, const std::string& inverse) {
  arm.inverse = inverse;
  return arm;
}

/// An arm whose axes are all askew: no closed form solves it.
ArmModel AskewArm() {
  ArmModel arm = With(LoadArm("gp12"), "numeric");
  arm.name = "askew";
  RandomStream stream(11, 0, "askew");
  for (ArmModel::Joint& joint : arm.joints) {
    for (int k = 0; k < 3; ++k) {
      joint.axis[k] += stream.Uniform(-0.2, 0.2);
      joint.origin_in_parent_m[k] += stream.Uniform(-0.05, 0.05);
    }
    joint.axis.normalize();
  }
  return arm;
}

/// One joint as a URDF gives it: the child's frame in the parent's, then the axis in the child's.
struct UrdfJoint {
  KDL::Vector xyz;
  double roll, pitch, yaw;
  KDL::Vector axis;
};

KDL::Chain ChainOf(const std::vector<UrdfJoint>& joints, const KDL::Frame& flange) {
  KDL::Chain chain;
  for (const UrdfJoint& j : joints) {
    const KDL::Frame frame(KDL::Rotation::RPY(j.roll, j.pitch, j.yaw), j.xyz);
    const bool fixed = j.axis == KDL::Vector::Zero();
    const KDL::Joint joint = fixed ? KDL::Joint(KDL::Joint::None)
                                   : KDL::Joint(frame.p, frame.M * j.axis, KDL::Joint::RotAxis);
    chain.addSegment(KDL::Segment(joint, frame));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), flange));
  return chain;
}

/// The vendors' own descriptions, frame by frame, as their URDF files have them.
KDL::Chain VendorChain(const std::string& name) {
  using KDL::Frame, KDL::Rotation, KDL::Vector;
  const Vector x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  if (name == "hc10") {
    return ChainOf({{{0, 0, 0.275}, 0, 0, 0, z},
                    {{0, 0, 0}, 0, 0, 0, y},
                    {{0, 0, 0.700}, 0, 0, 0, -y},
                    {{0, 0, -0.500}, 0, 0, 0, z},
                    {{0, 0.162, 0}, 0, 0, 0, -y},
                    {{0, 0, 0}, 0, 0, 0, z}},
                   Frame(Rotation::RPY(kPi, 0, 0), Vector(0, 0, -0.130)));
  }
  if (name == "gp12") {
    return ChainOf({{{0, 0, 0.450}, 0, 0, 0, z},
                    {{0.155, 0, 0}, 0, 0, 0, y},
                    {{0, 0, 0.614}, 0, 0, 0, -y},
                    {{0.640, 0, 0.200}, 0, 0, 0, -x},
                    {{0, 0, 0}, 0, 0, 0, -y},
                    {{0, 0, 0}, 0, 0, 0, -x}},
                   Frame(Rotation::RPY(kPi, -kPi / 2, 0), Vector(0.100, 0, 0)));
  }
  // The UR10e's frames turn from link to link, and its base looks backwards.
  return ChainOf({{Vector::Zero(), 0, 0, kPi, Vector::Zero()},
                  {{0, 0, 0.1807}, 0, 0, 0, z},
                  {{0, 0, 0}, kPi / 2, 0, 0, z},
                  {{-0.6127, 0, 0}, 0, 0, 0, z},
                  {{-0.57155, 0, 0.17415}, 0, 0, 0, z},
                  {{0, -0.11985, 0}, kPi / 2, 0, 0, z},
                  {{0, 0.11655, 0}, kPi / 2, kPi, kPi, z}},
                 Frame::Identity());
}

KDL::Frame ToKdl(const RigidTransform& X) {
  KDL::Frame frame;
  for (int i = 0; i < 3; ++i) {
    frame.p(i) = X.translation()[i];
    for (int j = 0; j < 3; ++j) frame.M(i, j) = X.linear()(i, j);
  }
  return frame;
}

TEST_CASE("Forward kinematics of every shipped arm is that of the vendor's description by KDL",
          "[unit]") {
  for (const std::string& name : ArmNames()) {
    const ArmModel arm = LoadArm(name);
    const KDL::Chain chain = VendorChain(name);
    KDL::ChainFkSolverPos_recursive solver(chain);
    RandomStream stream(1, 0, name);
    double worst = 0.0;
    for (int trial = 0; trial < 1000; ++trial) {
      const JointVector q = RandomJoints(arm, stream);
      KDL::JntArray joints(kNumJoints);
      joints.data = q;
      KDL::Frame frame;
      REQUIRE(solver.JntToCart(joints, frame) == 0);
      const KDL::Frame ours = ToKdl(FlangePose(arm, q));
      for (int i = 0; i < 3; ++i) {
        worst = std::max(worst, std::abs(ours.p(i) - frame.p(i)));
        for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(ours.M(i, j) - frame.M(i, j)));
      }
    }
    INFO(name << ": largest difference " << worst);
    CHECK(worst < kFlangeRounding);
  }
}

TEST_CASE("KDL's own numeric inverse finds nothing that the methods here miss", "[unit]") {
  for (const std::string& name : ArmNames()) {
    const ArmModel arm = LoadArm(name);
    const ArmModel numeric = With(arm, "numeric");
    const KDL::Chain chain = VendorChain(name);
    KDL::ChainIkSolverPos_LMA solver(chain, 1e-12, 500, 1e-15);
    RandomStream stream(2, 0, name);
    int solved = 0, by_closed = 0, by_numeric = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const JointVector q = RandomJoints(arm, stream);
      const RigidTransform X_BF = FlangePose(arm, q);
      KDL::JntArray start(kNumJoints), found(kNumJoints);
      start.data = RandomJoints(arm, stream);
      if (solver.CartToJnt(start, ToKdl(X_BF), found) != 0) continue;
      const JointVector q_kdl = found.data;
      if (Manipulability(arm, q_kdl) < kRegular) continue;
      ++solved;
      by_closed += Holds(InverseAll(arm, X_BF), q_kdl, kSameSolution_rad);
      by_numeric += Holds(InverseAll(numeric, X_BF), q_kdl, kSameSolution_rad);
    }
    INFO(name << ": KDL solved " << solved);
    CHECK(solved > 20);
    CHECK(by_closed == solved);
    CHECK(by_numeric == solved);
  }
}

/// Every solution of either method is one of the other's, on seeded poses of the arm. `poses` with
/// a solution near a singular posture are left out: there solutions fall together.
void CheckAgreement(const ArmModel& arm, const std::string& one, const std::string& other,
                    int poses) {
  const ArmModel a = With(arm, one), b = With(arm, other);
  RandomStream stream(3, 0, arm.name + one + other);
  int compared = 0, solutions = 0, missed_by_other = 0, missed_by_one = 0;
  std::size_t most = 0;
  while (compared < poses) {
    const RigidTransform X_BF = FlangePose(arm, RandomJoints(arm, stream));
    const auto of_a = InverseAll(a, X_BF), of_b = InverseAll(b, X_BF);
    const auto singular = [&](const JointVector& q) { return Manipulability(arm, q) < kRegular; };
    if (std::any_of(of_a.begin(), of_a.end(), singular)) continue;
    if (std::any_of(of_b.begin(), of_b.end(), singular)) continue;
    ++compared;
    solutions += static_cast<int>(of_a.size());
    most = std::max(most, of_a.size());
    for (const JointVector& q : of_a) missed_by_other += !Holds(of_b, q, kSameSolution_rad);
    for (const JointVector& q : of_b) missed_by_one += !Holds(of_a, q, kSameSolution_rad);
  }
  INFO(arm.name << ": " << one << " against " << other << ", " << compared << " poses, "
                << solutions << " solutions, at most " << most);
  CHECK(missed_by_other == 0);
  CHECK(missed_by_one == 0);
  WARN(arm.name << ": " << one << " and " << other << " agree on " << solutions << " solutions of "
                << compared << " poses, at most " << most << " of one");
}

TEST_CASE("Closed forms and the numeric inverse find the same solutions", "[unit]") {
  CheckAgreement(LoadArm("hc10"), "offset_wrist", "numeric", 100);
  CheckAgreement(LoadArm("gp12"), "spherical_wrist", "numeric", 100);
  CheckAgreement(LoadArm("ur10e"), "three_parallel", "numeric", 100);
}

TEST_CASE("Closed forms hold for other offsets and senses of axes", "[unit]") {
  RandomStream stream(4, 0, "variants");
  for (int variant = 0; variant < 12; ++variant) {
    const bool ur = variant % 2 == 0;
    ArmModel arm = LoadArm(ur ? "ur10e" : "gp12");
    arm.name += " variant " + std::to_string(variant);
    for (int i = 0; i < kNumJoints; ++i) {
      ArmModel::Joint& joint = arm.joints[i];
      if (stream.Uniform(0, 1) < 0.5) joint.axis = -joint.axis;
      // Three axes of a spherical wrist keep meeting, as do axes 5 and 6 of the other.
      const bool moves = ur ? i < 5 : i < 4;
      if (moves) {
        for (int k = 0; k < 3; ++k) joint.origin_in_parent_m[k] += stream.Uniform(-0.15, 0.15);
      }
    }
    // Axis 1 and the wrist's axes may lean.
    arm.joints[0].axis = (arm.joints[0].axis + Vector3(0.2, 0.1, 0)).normalized();
    arm.joints[5].axis = (arm.joints[5].axis + Vector3(0.1, 0.1, 0.2)).normalized();
    if (ur) arm.joints[5].origin_in_parent_m = 0.117 * arm.joints[5].axis;
    const std::string inverse = arm.inverse;
    if (!ur) arm.joints[4].axis = (arm.joints[4].axis + Vector3(0, 0.1, 0.3)).normalized();
    CheckAgreement(arm, inverse, "numeric", 8);
  }
}

TEST_CASE("Two closed forms that solve one arm agree", "[unit]") {
  // With no offset between axes 4 and 6, the HC10 would have a spherical wrist.
  ArmModel arm = LoadArm("hc10");
  arm.name = "HC10 without its offset";
  arm.joints[4].origin_in_parent_m.setZero();
  CheckAgreement(arm, "spherical_wrist", "numeric", 20);
}

TEST_CASE("An arm that no closed form solves has the solution that made the pose", "[unit]") {
  const ArmModel arm = AskewArm();
  RandomStream stream(5, 0, "askew poses");
  int regular = 0, found = 0, solutions = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const JointVector q = RandomJoints(arm, stream);
    if (Manipulability(arm, q) < kRegular) continue;
    ++regular;
    const auto all = InverseAll(arm, FlangePose(arm, q));
    solutions += static_cast<int>(all.size());
    CHECK(all.size() <= 16);
    found += Holds(all, q, kSameSolution_rad);
  }
  CHECK(regular > 80);
  CHECK(found == regular);
  CHECK(solutions > 3 * regular);
}

TEST_CASE("All solutions reach the pose, are sorted, wrapped and there once", "[unit]") {
  std::vector<ArmModel> arms;
  for (const std::string& name : ArmNames()) arms.push_back(LoadArm(name));
  arms.push_back(AskewArm());
  for (const ArmModel& arm : arms) {
    RandomStream stream(6, 0, arm.name);
    for (int trial = 0; trial < 40; ++trial) {
      const RigidTransform X_BF = FlangePose(arm, RandomJoints(arm, stream));
      const auto all = InverseAll(arm, X_BF);
      CHECK_FALSE(all.empty());
      for (std::size_t i = 0; i < all.size(); ++i) {
        const RigidTransform X = FlangePose(arm, all[i]);
        CHECK((X.translation() - X_BF.translation()).norm() < kPose);
        CHECK((X.linear() - X_BF.linear()).norm() < kPose);
        for (int k = 0; k < kNumJoints; ++k) {
          const ArmModel::Joint& joint = arm.joints[k];
          const bool wrapped = all[i][k] > -kPi && all[i][k] <= kPi;
          const bool inside = all[i][k] >= joint.lower_rad && all[i][k] <= joint.upper_rad;
          CHECK((wrapped || inside));
        }
        if (i == 0) continue;
        CHECK(LargestDifference(all[i], all[i - 1]) > 1e-6);
        CHECK(std::lexicographical_compare(all[i - 1].data(), all[i - 1].data() + kNumJoints,
                                           all[i].data(), all[i].data() + kNumJoints));
      }
    }
  }
}

TEST_CASE("A general pose has eight solutions where wrist, elbow and shoulder have two ways each",
          "[unit]") {
  JointVector q;
  q << 0.3, -1.2, 1.5, -1.4, -1.3, 0.4;
  const ArmModel ur = LoadArm("ur10e");
  CHECK(InverseAll(ur, FlangePose(ur, q)).size() == 8);
  q << 0.3, -0.4, 0.1, 0.5, 0.7, 0.9;
  const ArmModel gp = LoadArm("gp12");
  CHECK(InverseAll(gp, FlangePose(gp, q)).size() == 8);
}

TEST_CASE("Singular poses are solved, a continuum by some of its members", "[unit]") {
  for (const std::string name : {"gp12", "ur10e"}) {
    for (const bool numeric : {false, true}) {
      ArmModel arm = LoadArm(name);
      if (numeric) arm.inverse = "numeric";
      INFO(arm.name << " by " << arm.inverse);
      // Axes 4 and 6 in line, or axis 6 along axis 2: two joints share one turn.
      JointVector q;
      q << 0.3, -0.4, 0.1, 0.5, 0.0, 0.9;
      const RigidTransform X_BF = FlangePose(arm, q);
      REQUIRE(Manipulability(arm, q) < 1e-6);
      const auto all = InverseAll(arm, X_BF);
      CHECK_FALSE(all.empty());
      CHECK(all.size() <= 16);
      for (const JointVector& other : all) {
        CHECK((FlangePose(arm, other).translation() - X_BF.translation()).norm() < kPose);
      }
    }
  }
}

TEST_CASE("At the end of the reach the elbow's two ways fall together, beyond it there is none",
          "[unit]") {
  const ArmModel arm = LoadArm("gp12");
  // W's greatest distance from axis 2, out of the URDF's offsets.
  const double reach = 0.614 + std::hypot(0.640, 0.200);
  const auto pose_at = [&](double distance) {
    const Vector3 p_BW(0.155 + distance * std::cos(0.3), 0, 0.450 + distance * std::sin(0.3));
    const Matrix3 R_BF = RotY(0.8);
    return MakeTransform(R_BF, p_BW + 0.100 * R_BF.col(2));
  };
  const auto elbows = [&](double distance) {
    int front = 0;
    for (const JointVector& q : InverseAll(arm, pose_at(distance))) front += std::abs(q[0]) < 0.1;
    return front;
  };
  CHECK(elbows(reach - 1e-3) == 4);
  CHECK(elbows(reach + 1e-6) == 0);
  CHECK(elbows(reach + 0.5) == 0);
  const ArmModel numeric = With(arm, "numeric");
  CHECK(InverseAll(numeric, pose_at(reach + 0.5)).empty());
  CHECK(InverseNear(numeric, pose_at(reach + 0.5), JointVector::Zero()).status ==
        InverseNearResult::Status::kUnreachable);
}

TEST_CASE("The numeric inverse gives the same bits again and keeps within its time", "[unit]") {
  const ArmModel arm = AskewArm();
  RandomStream stream(7, 0, "again");
  double seconds = 0.0;
  constexpr int kTrials = 30;
  for (int trial = 0; trial < kTrials; ++trial) {
    const RigidTransform X_BF = FlangePose(arm, RandomJoints(arm, stream));
    const auto begin = std::chrono::steady_clock::now();
    const auto all = InverseAll(arm, X_BF);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    CHECK(all == InverseAll(arm, X_BF));
  }
  WARN("numeric inverse: " << 1e3 * seconds / kTrials << " ms a pose");
  CHECK(seconds / kTrials < 0.5);  // 20 ms on an idle machine; sanitizers and neighbours slow it
}

TEST_CASE("A method refuses an arm that is not of its kind and says which axes", "[unit]") {
  const RigidTransform X_BF = Translation(0.5, 0, 0.5);
  const auto refusal = [&](const std::string& arm, const std::string& inverse) -> std::string {
    try {
      InverseAll(With(LoadArm(arm), inverse), X_BF);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::kConfig);
      return error.what();
    }
    return "";
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(refusal("hc10", "spherical_wrist"),
             Contains("axes 4, 5 and 6 have to meet in one point, but axis"));
  CHECK_THAT(refusal("hc10", "three_parallel"), Contains("axes 3 and 4 have to be parallel"));
  CHECK_THAT(refusal("gp12", "three_parallel"), Contains("axes 3 and 4 have to be parallel"));
  CHECK_THAT(refusal("gp12", "offset_wrist"), Contains("axis 2 lies [0.155, 0, 0] m off axis 1"));
  CHECK_THAT(refusal("ur10e", "offset_wrist"), Contains("axis 3 points along [0, 1, 0]"));
  CHECK_THAT(refusal("ur10e", "spherical_wrist"), Contains("axes 4, 5 and 6 have to meet"));
  CHECK_THAT(refusal("ur10e", "numerik"), Contains("the nearest is 'numeric'"));
}

}  // namespace
}  // namespace tubetwin

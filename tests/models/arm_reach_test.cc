// What the shipped arms reach in their working family, and that they do not meet themselves there.

#include <map>

#include "models/arm/arm.h"
#include "models/base/random.h"
#include "models/clearance.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

using Status = InverseNearResult::Status;

const RigidTransform kX_FE = Translation(0, 0, 0.177);  // a straight tool
constexpr double kSlow = 0.05;                          // manipulability: slow below

RigidTransform ToolDown(const Vector3& p_BE, double yaw_rad) {
  return MakeTransform(RotX(kPi) * RotZ(yaw_rad), p_BE) * kX_FE.inverse();
}

/// Where a bin of 0.4 x 0.6 m stands in front of an arm: the centre of its floor.
const std::map<std::string, Vector3>& BinFloors() {
  static const std::map<std::string, Vector3> floors = {
      {"hc10", {0.70, 0, 0.10}}, {"gp12", {0.95, 0, 0.45}}, {"ur10e", {0.70, 0, 0.10}}};
  return floors;
}

TEST_CASE("Each arm's tool reaches every point of a bin's floor in one family", "[unit]") {
  for (const std::string& name : ArmNames()) {
    const ArmModel arm = LoadArm(name);
    const Vector3& centre = BinFloors().at(name);
    double least = 1.0;
    JointVector last = JointVector::Zero();
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 30; ++j) {
        // To and fro, so that neighbours follow each other.
        const int column = i % 2 == 0 ? j : 30 - j;
        const Vector3 p_BE = centre + Vector3(0.02 * i - 0.2, 0.02 * column - 0.3, 0);
        const auto result = InverseWorking(arm, ToolDown(p_BE, 0.0));
        INFO(name << " at " << p_BE.transpose());
        REQUIRE(result.status == Status::kFound);
        least = std::min(least, Manipulability(arm, result.q, kX_FE));
        if (i + j > 0) CHECK((result.q - last).cwiseAbs().maxCoeff() < 0.35);
        last = result.q;
      }
    }
    WARN(name << ": least manipulability over the floor at " << centre.transpose() << " is "
              << least);
    CHECK(least >= kSlow);
  }
}

TEST_CASE("The working family of each arm follows the tool as it leans", "[unit]") {
  for (const std::string& name : ArmNames()) {
    const ArmModel arm = LoadArm(name);
    RandomStream stream(1, 0, name);
    int found = 0, trials = 200;
    for (int trial = 0; trial < trials; ++trial) {
      const Vector3 p_BE =
          BinFloors().at(name) +
          Vector3(stream.Uniform(-0.1, 0.1), stream.Uniform(-0.2, 0.2), stream.Uniform(0.05, 0.2));
      const double way = stream.Uniform(-kPi, kPi);
      const Eigen::AngleAxisd lean(stream.Uniform(0, 0.4),
                                   Vector3(std::cos(way), std::sin(way), 0));
      const RigidTransform X_BE =
          MakeTransform(Matrix3(lean * RotX(kPi) * RotZ(stream.Uniform(-1.5, 1.5))), p_BE);
      const auto result = InverseWorking(arm, X_BE * kX_FE.inverse());
      if (result.status != Status::kFound) continue;
      ++found;
      CHECK((FlangePose(arm, result.q).matrix() - (X_BE * kX_FE.inverse()).matrix()).norm() < 2e-9);
    }
    INFO(name << ": " << found << " of " << trials);
    CHECK(found >= 0.97 * trials);
  }
}

TEST_CASE("Without a closed form the working family is the same", "[unit]") {
  for (const std::string& name : ArmNames()) {
    const ArmModel arm = LoadArm(name);
    ArmModel numeric = arm;
    numeric.inverse = "numeric";
    RandomStream stream(2, 0, name);
    int same = 0, trials = 200;
    for (int trial = 0; trial < trials; ++trial) {
      const Vector3 p_BE = BinFloors().at(name) +
                           Vector3(stream.Uniform(-0.2, 0.2), stream.Uniform(-0.3, 0.3), 0.05);
      const RigidTransform X_BF = ToolDown(p_BE, stream.Uniform(-kPi, kPi));
      const auto a = InverseWorking(arm, X_BF), b = InverseWorking(numeric, X_BF);
      REQUIRE(a.status == Status::kFound);
      REQUIRE(b.status == Status::kFound);
      same += (a.q - b.q).cwiseAbs().maxCoeff() < 1e-6;
    }
    INFO(name);
    CHECK(same == trials);
  }
}

TEST_CASE("At work no arm comes near itself or its tool", "[unit]") {
  for (const std::string& name : ArmNames()) {
    CellModel model = PaperCell();
    model.arm = LoadArm(name);
    // The GP12's fork leaves no room beside it for a scanner where the HC10 carries it.
    if (name == "gp12") model.layout.X_FS = Translation(0, 0.20, 0.030);
    const ArmModel& arm = model.arm;
    const ClearanceChecker checker(model, Bin());
    // Over the bin and the tray of the default layout, carried high.
    for (const Vector3& p_BE : {Vector3(0.6, 0, 0.4), Vector3(0.05, -0.78, 0.4)}) {
      for (const double yaw : {-1.0, 0.0, 1.0}) {
        const auto result = InverseWorking(arm, ToolDown(p_BE, yaw));
        INFO(name << " at " << p_BE.transpose() << ", yaw " << yaw);
        REQUIRE(result.status == Status::kFound);
        const auto clearance = checker.Check(result.q, 0.085);
        INFO(clearance.moving << " and " << clearance.obstacle);
        CHECK(clearance.clearance_m > 0.0);
      }
    }
  }
}

TEST_CASE("A folded arm meets itself", "[unit]") {
  const std::map<std::string, std::array<double, 6>> folded = {{"gp12", {0, 60, -85, 0, -120, 0}},
                                                               {"ur10e", {0, -60, 170, 0, -90, 0}}};
  for (const auto& [name, q_deg] : folded) {
    CellModel model = PaperCell();
    model.arm = LoadArm(name);
    const JointVector q = Eigen::Map<const JointVector>(q_deg.data()) * kPi / 180.0;
    INFO(name);
    CHECK(ClearanceChecker(model, Bin()).Check(q, 0.085).others.clearance_m < 0.0);
  }
}

}  // namespace
}  // namespace tubetwin

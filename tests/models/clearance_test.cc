#include "models/clearance.h"

#include "models/base/random.h"
#include "models/gripper_spec.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

constexpr double kSolver_m = 1e-4;  // of the iterative distance query
constexpr double kOpen_m = 0.085;

JointVector JointsAt(const Vector3& p_BE, double yaw_rad) {
  const RigidTransform X_BE = MakeTransform(RotX(kPi) * RotZ(yaw_rad), p_BE);
  const auto result = InverseWorking(PaperCell().arm, X_BE * PaperCell().layout.X_FE.inverse());
  REQUIRE(result.status == InverseNearResult::Status::kFound);
  return result.q;
}

const ClearanceChecker& Checker() {
  static const ClearanceChecker checker(PaperCell(), Bin());
  return checker;
}

/// Signed distance of a point to a box at the origin.
double BoxDistance(const Vector3& p, const Vector3& half_m) {
  const Vector3 d = p.cwiseAbs() - half_m;
  return d.cwiseMax(0.0).norm() + std::min(0.0, d.maxCoeff());
}

/// Points on a shape's surface, about 6 mm apart, in its own frame.
std::vector<Vector3> SurfacePoints(const Shape& shape) {
  using Kind = Shape::Kind;
  std::vector<Vector3> points;
  const Vector3& s = shape.size_m;
  const auto span = [](double half) { return std::max(2, static_cast<int>(half / 0.003)); };
  if (shape.kind == Kind::kBox) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i <= span(s[u]); ++i) {
        for (int j = 0; j <= span(s[v]); ++j) {
          for (const double side : {-1.0, 1.0}) {
            Vector3 p;
            p[axis] = side * s[axis];
            p[u] = s[u] * (2.0 * i / span(s[u]) - 1);
            p[v] = s[v] * (2.0 * j / span(s[v]) - 1);
            points.push_back(p);
          }
        }
      }
    }
    return points;
  }
  constexpr int kAround = 96;
  const bool round_ends = shape.kind != Kind::kCylinder;
  for (int a = 0; a < kAround; ++a) {
    const Vector3 out(std::cos(2 * kPi * a / kAround), std::sin(2 * kPi * a / kAround), 0);
    for (int i = 0; i <= 100; ++i) {
      points.push_back(s.x() * out + Vector3(0, 0, s.y() * (i / 50.0 - 1)));
    }
    for (int i = 0; i <= 24; ++i) {
      for (const double side : {-1.0, 1.0}) {
        const double angle = 0.5 * kPi * i / 24;
        const Vector3 cap =
            round_ends
                ? Vector3(std::cos(angle) * out * s.x() + Vector3(0, 0, std::sin(angle) * s.x()))
                : Vector3(out * s.x() * i / 24.0);
        points.push_back(Vector3(cap.x(), cap.y(), side * (cap.z() + s.y())));
      }
    }
  }
  return points;
}

TEST_CASE("Over the middle of the floor the fingers are the pads' lower edge away", "[unit]") {
  const GripperSpec& gripper = PaperCell().gripper;
  for (const double opening : {0.0, 0.030, 0.085}) {
    for (const double height : {0.0215, 0.030, 0.045}) {
      // E is the pads' centre of closed fingers; open ones are drawn back.
      const double expected =
          height - 0.5 * gripper.pad_height_m + PadRetreat(PaperCell().gripper, opening);
      const JointVector q = JointsAt(Vector3(0.6, 0, 0.10 + height), kPi / 2);
      const auto result = Checker().Check(q, opening, 0.10);
      CHECK(std::abs(result.fingers.clearance_m - expected) < kSolver_m);
      CHECK(result.fingers.moving == "finger");
      CHECK(result.fingers.obstacle == "bin floor");
      CHECK(result.clearance_m == result.fingers.clearance_m);
      CHECK(result.others.clearance_m > 0.03);
    }
  }
}

TEST_CASE("A finger beside a wall is as far from it as the geometry says", "[unit]") {
  // Closing direction along B's x: y of E is along B's x for a yaw of 90 degrees.
  const double opening = 0.030, height = 0.060;
  for (const double gap : {0.012, 0.004}) {
    const double reach = 0.5 * opening + PaperCell().gripper.finger_thickness_m;
    const Vector3 p_BE(0.60 + 0.29 - reach - gap, 0.0, 0.10 + height);
    const auto result = Checker().Check(JointsAt(p_BE, kPi / 2), opening);
    CHECK(std::abs(result.fingers.clearance_m - gap) < kSolver_m);
    CHECK(result.fingers.obstacle == "bin wall -y");
  }
  // Beyond the wall the distance is negative: contact.
  const Vector3 p_BE(0.60 + 0.29 - 0.015, 0.0, 0.10 + height);
  CHECK(Checker().Check(JointsAt(p_BE, kPi / 2), opening).fingers.clearance_m < 0.0);
}

TEST_CASE("Every scan pose is free and lies between the forearm and the bin", "[unit]") {
  for (const auto& X_BS : ScanPosesOf(PaperCell(), Bin())) {
    const auto ik = InverseWorking(PaperCell().arm, X_BS * PaperCell().layout.X_FS.inverse());
    REQUIRE(ik.status == InverseNearResult::Status::kFound);
    // What comes nearest is the upper end of the housing to the forearm.
    const auto result = Checker().Check(ik.q, kOpen_m);
    CHECK(result.clearance_m > 0.025);
    CHECK((result.clearance_m == 0.05 || result.moving == "scanner"));
  }
}

TEST_CASE("The folded arm hits itself and says with what", "[unit]") {
  JointVector q = JointVector::Zero();
  q[1] = Radians(-10);
  const auto result = Checker().Check(q, kOpen_m);
  CHECK(result.others.clearance_m < 0.0);
  CHECK_FALSE(result.moving.empty());
  CHECK_FALSE(result.obstacle.empty());
}

TEST_CASE("Clearance to bin, tray and plate agrees with densely sampled surfaces", "[unit]") {
  struct Obstacle {
    RigidTransform X_BBox;
    Vector3 half_m;
  };
  const CellLayout layout = PaperCell().layout;
  const Bin bin;
  const double x = bin.half_x_m(), y = bin.half_y_m(), t = Bin::kWallThickness_m, h = 0.045;
  const RigidTransform& X_BN = bin.X_BN;
  const std::vector<Obstacle> obstacles = {
      {X_BN * Translation(0, 0, -0.05), {x + t, y + t, 0.05}},
      {X_BN * Translation(x + t / 2, 0, h), {t / 2, y + t, h}},
      {X_BN * Translation(-x - t / 2, 0, h), {t / 2, y + t, h}},
      {X_BN * Translation(0, y + t / 2, h), {x + t, t / 2, h}},
      {X_BN * Translation(0, -y - t / 2, h), {x + t, t / 2, h}},
      {layout.X_BT * Translation(0, 0, -0.05), {0.3, 0.3, 0.05}},
      {Translation(0, 0, -0.05), {2, 2, 0.05}}};
  const auto shapes = MovingShapes(PaperCell());
  RandomStream stream(5, 0, "clearance");
  constexpr double kSampling_m = 0.0045;  // half the diagonal of the points' grid
  constexpr double kNear_m = 0.10;
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Vector3 p_BE(stream.Uniform(0.40, 0.86), stream.Uniform(-0.36, 0.36),
                       0.10 + stream.Uniform(0.02, 0.12));
    const JointVector q = JointsAt(p_BE, stream.Uniform(-1.5, 1.5));
    const auto X_BL = LinkPoses(PaperCell().arm, q);
    double sampled = 1.0;
    for (const auto& shape : shapes) {
      if (shape.link < 2) continue;
      const RigidTransform X_BBody =
          shape.link == 7 ? X_BL[6] * PaperCell().arm.X_6F : X_BL[shape.link];
      for (const Vector3& p : SurfacePoints(shape)) {
        const Vector3 p_B = X_BBody * shape.X_LinkShape * p;
        for (const Obstacle& o : obstacles) {
          sampled = std::min(sampled, BoxDistance(o.X_BBox.inverse() * p_B, o.half_m));
        }
      }
    }
    // Fingers closed, so that they stay below everything else and never decide "others".
    const auto result = Checker().Check(q, 0.0, kNear_m);
    if (sampled > kNear_m) continue;
    ++compared;
    if (sampled > 0.0) {
      CHECK(result.others.clearance_m < sampled + kSolver_m);
      const bool self = result.others.obstacle.find("bin") == std::string::npos;
      if (!self) CHECK(result.others.clearance_m > sampled - kSampling_m);
    } else {
      CHECK(result.others.clearance_m < kSolver_m);
    }
  }
  CHECK(compared > 20);
}

TEST_CASE("Shapes carry distinct names and stay near the vendor's mesh boxes", "[unit]") {
  const auto shapes = MovingShapes(PaperCell());
  std::vector<std::string> names;
  for (const auto& shape : shapes) names.push_back(shape.name);
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  // Mesh bounding boxes (reference sheet), links 2 and 4: the big ones.
  struct Mesh {
    int link;
    Vector3 low, high;
  };
  constexpr double kStandIn_m = 0.06;  // caps of the capsules
  for (const Mesh& mesh : {Mesh{2, {-0.081, -0.301, -0.082}, {0.081, -0.098, 0.768}},
                           Mesh{4, {-0.057, -0.068, -0.057}, {0.057, 0.064, 0.393}}}) {
    Vector3 low = Vector3::Constant(9), high = Vector3::Constant(-9);
    for (const auto& shape : shapes) {
      if (shape.link != mesh.link) continue;
      for (const Vector3& p : SurfacePoints(shape)) {
        low = low.cwiseMin(shape.X_LinkShape * p);
        high = high.cwiseMax(shape.X_LinkShape * p);
      }
    }
    CHECK((low - mesh.low).cwiseAbs().maxCoeff() < kStandIn_m);
    CHECK((high - mesh.high).cwiseAbs().maxCoeff() < kStandIn_m);
  }
}

}  // namespace
}  // namespace tubetwin

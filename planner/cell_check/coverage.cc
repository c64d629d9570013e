#include <algorithm>
#include <cmath>

#include "planner/cell_check/cell_check.h"
#include "planner/motion/motion_planner.h"
#include "planner/scene_query/box_distance.h"

namespace tubetwin {
namespace {

constexpr int kGrid = 21;  // places along each side
constexpr double kShoulder_rad = kPi / 3;

/// Whether the way from `p_NFrom`, over the bin or beside it, to a place in it passes its rim.
bool PassesRim(const Bin& bin, const Vector3& p_NFrom, const Vector3& p_N) {
  const double rim_m = bin.wall_m();
  if (p_N.z() >= rim_m) return true;
  if (p_NFrom.z() <= rim_m) return false;
  const double share = (rim_m - p_N.z()) / (p_NFrom.z() - p_N.z());
  const Vector3 at_rim = p_N + share * (p_NFrom - p_N);
  return std::abs(at_rim.x()) <= bin.half_x_m() && std::abs(at_rim.y()) <= bin.half_y_m();
}

/// One view: camera and projector over the bin.
class View {
 public:
  View(const ScannerSpec& spec, const Bin& bin, const RigidTransform& X_BS)
      : spec_(spec),
        bin_(bin),
        X_SN_(X_BS.inverse() * bin.X_BN),
        X_PN_(ProjectorPose(spec).inverse() * X_SN_),
        p_NCamera_(X_SN_.inverse().translation()),
        p_NProjector_(X_PN_.inverse().translation()) {}

  /// Whether something stands between the place and camera or projector; its boxes in N.
  bool Hidden(const Vector3& p_N, const std::vector<OrientedBox>& boxes_N) const {
    return std::any_of(boxes_N.begin(), boxes_N.end(), [&](const OrientedBox& box) {
      return SegmentBoxDistance(p_N, p_NCamera_, box) <= 0.0 ||
             SegmentBoxDistance(p_N, p_NProjector_, box) <= 0.0;
    });
  }

  bool Sees(const Vector3& p_N) const {
    const Vector3 p_S = X_SN_ * p_N, p_P = X_PN_ * p_N;
    if (p_S.z() < spec_.near_half_m || p_S.z() > spec_.far_half_m || p_P.z() <= 0.0) return false;
    const double x = 0.5 * spec_.full_width / spec_.focal_px;
    const double y = 0.5 * spec_.full_height / spec_.focal_px;
    if (std::abs(p_S.x()) > x * p_S.z() || std::abs(p_S.y()) > y * p_S.z()) return false;
    const double width = std::tan(Radians(0.5 * spec_.projector_width_deg));
    const double height = std::tan(Radians(0.5 * spec_.projector_height_deg));
    if (std::abs(p_P.x()) > width * p_P.z() || std::abs(p_P.y()) > height * p_P.z()) return false;
    return PassesRim(bin_, p_NCamera_, p_N) && PassesRim(bin_, p_NProjector_, p_N);
  }

 private:
  const ScannerSpec& spec_;
  const Bin& bin_;
  RigidTransform X_SN_, X_PN_;
  Vector3 p_NCamera_, p_NProjector_;
};

/// Boxes around what moves, in N, with the arm where it waits for a scanner on a stand; none when
/// it does not get there.
std::vector<OrientedBox> WaitingArm(const CellCheckInput& input) {
  const CellModel& model = input.model;
  const MotionPlanner planner(model, input.bin);
  const auto q = planner.Reach(planner.PoseOfEForScan(RigidTransform::Identity()));
  std::vector<OrientedBox> boxes;
  if (!q) return boxes;
  const auto X_BL = LinkPoses(model.arm, *q);
  const RigidTransform X_NB = input.bin.X_BN.inverse();
  for (const Shape& shape : MovingShapes(model)) {
    const RigidTransform X_BBody = shape.link == kFlangeBody
                                       ? RigidTransform(X_BL[kNumJoints] * model.arm.X_6F)
                                       : X_BL[shape.link];
    boxes.push_back({X_NB * X_BBody * shape.X_LinkShape, HalfExtent(shape)});
  }
  return boxes;
}

}  // namespace

CoverageShares CoverageOf(const CellCheckInput& input) {
  std::vector<View> views;
  for (const RigidTransform& X_BS : input.views_BS) {
    views.emplace_back(input.model.scanner, input.bin, X_BS);
  }
  const auto seen = [&](const Vector3& p_N) {
    return std::any_of(views.begin(), views.end(), [&](const View& v) { return v.Sees(p_N); });
  };
  // A tube is seen where its crown is, or its shoulder towards the middle: the wall's shadow may
  // lie on the rest.
  const double radius_m = input.part.radius_m;
  const auto seen_tube = [&](const Vector3& crown_N, int to_x, int to_y) {
    const double aside_m = std::sin(kShoulder_rad) * radius_m;
    const double down_m = (1.0 - std::cos(kShoulder_rad)) * radius_m;
    return seen(crown_N) || seen(crown_N + Vector3(to_x * aside_m, to_y * aside_m, -down_m));
  };
  const auto inward = [](int i) { return i == 0 ? 1 : i == kGrid - 1 ? -1 : 0; };
  const double x = input.bin.half_x_m() - radius_m, y = input.bin.half_y_m() - radius_m;
  int floor = 0, walls = 0, all_walls = 0;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const double u = 2.0 * i / (kGrid - 1) - 1.0, v = 2.0 * j / (kGrid - 1) - 1.0;
      const bool at_wall = inward(i) != 0 || inward(j) != 0;
      const bool sees = seen_tube(Vector3(u * x, v * y, 2.0 * radius_m), inward(i), inward(j));
      floor += sees ? 1 : 0;
      all_walls += at_wall ? 1 : 0;
      walls += at_wall && sees ? 1 : 0;
    }
  }
  CoverageShares shares;
  shares.floor = static_cast<double>(floor) / (kGrid * kGrid);
  shares.walls = static_cast<double>(walls) / all_walls;
  if (input.model.layout.scanner_mount == CellLayout::ScannerMount::kStand) {
    const std::vector<OrientedBox> arm_N = WaitingArm(input);
    int hidden = 0;
    for (int i = 0; i < kGrid * kGrid; ++i) {
      const int column = i % kGrid, row = i / kGrid;
      const double u = 2.0 * column / (kGrid - 1) - 1.0;
      const double v = 2.0 * row / (kGrid - 1) - 1.0;
      hidden += views.front().Hidden(Vector3(u * x, v * y, 0), arm_N) ? 1 : 0;
    }
    shares.behind_arm = static_cast<double>(hidden) / (kGrid * kGrid);
  }
  return shares;
}

}  // namespace tubetwin

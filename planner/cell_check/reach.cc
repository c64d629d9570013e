#include <algorithm>
#include <array>
#include <cmath>

#include "planner/cell_check/cell_check.h"
#include "planner/grasp/placement.h"
#include "planner/motion/motion_planner.h"

namespace tubetwin {
namespace {

constexpr double kFromWall_m = 0.05;    // at least: nearer, grasps lean or tubes are nudged
constexpr double kBesideWall_m = 0.01;  // of the open gripper
constexpr double kStep_m = 0.05;
constexpr int kMaxPlaces = 13;  // along each side
constexpr int kYaws = 8;        // over a whole turn: a scanner at the flange has its side
constexpr double kLean_deg = 20.0;
constexpr int kTilts = 12;
constexpr double kTilt_deg = 45.0;
constexpr double kSideRoom_m = 0.01;   // of the open fingers beside a tube
constexpr double kFingers_m = 0.0005;  // they end 2 mm over the floor
constexpr double kOthers_m = 0.002;
/// Along lines 0.02 is refused; what is over it here leaves something for leaning and turning.
constexpr double kManipulability = 0.03;
constexpr double kLift_m = 0.15;  // grasped tubes are lifted at least so high from there

/// Places along a side of that half length, `from_wall_m` from its ends.
std::vector<double> Places(double half_m, double from_wall_m) {
  const double reach_m = std::max(0.0, half_m - from_wall_m);
  const int count =
      std::clamp(1 + static_cast<int>(std::ceil(2.0 * reach_m / kStep_m)), 1, kMaxPlaces);
  std::vector<double> places;
  for (int i = 0; i < count; ++i) {
    places.push_back(count == 1 ? 0.0 : reach_m * (2.0 * i / (count - 1) - 1.0));
  }
  return places;
}

class Reach {
 public:
  explicit Reach(const CellCheckInput& input)
      : input_(input),
        planner_(input.model, input.bin),
        opening_m_(
            std::min(input.model.gripper.stroke_m, 2.0 * (input.part.radius_m + kSideRoom_m))) {}

  bool Gets(const RigidTransform& X_BE) const {
    const auto q = planner_.Reach(X_BE);
    if (!q) return false;
    if (Manipulability(input_.model.arm, *q, input_.model.layout.X_FE) < kManipulability) {
      return false;
    }
    const auto near = planner_.clearance().Check(*q, opening_m_);
    return near.fingers.clearance_m >= kFingers_m && near.others.clearance_m >= kOthers_m;
  }

  /// At a place of the frame of a surface, with the tool as it grasps or places there.
  bool GetsAt(const RigidTransform& X_BSurface, double x, double y, double lean_rad) const {
    const double radius_m = input_.part.radius_m;
    const GripperSpec& gripper = input_.model.gripper;
    const double height_m = radius_m + GraspHeightOverAxis(radius_m, gripper);
    for (int k = 0; k < kYaws; ++k) {
      const Matrix3 upright = VerticalTool(2.0 * kPi * k / kYaws);
      for (const double lean : {lean_rad, -lean_rad}) {
        const Matrix3 R = upright * RotX(lean);
        // Leaning, the lower finger would reach deeper.
        const double deeper_m =
            0.5 * (opening_m_ + 2.0 * gripper.finger_thickness_m) * std::sin(std::abs(lean));
        RigidTransform X_BE = MakeTransform(R, X_BSurface * Vector3(x, y, height_m + deeper_m));
        X_BE = X_BE * Translation(0, 0, PadRetreat(gripper, 2.0 * radius_m));
        if (Gets(X_BE) && Gets(Translation(0, 0, kLift_m) * X_BE)) return true;
        if (lean == 0.0) break;
      }
    }
    return false;
  }

  void Floor(ReachShares& shares) const {
    const double from_wall_m = std::max(kFromWall_m, HalfWidth_m() + kBesideWall_m);
    int places = 0, upright = 0, leaning = 0;
    for (const double x : Places(input_.bin.half_x_m(), from_wall_m)) {
      for (const double y : Places(input_.bin.half_y_m(), from_wall_m)) {
        ++places;
        const bool gets = GetsAt(input_.bin.X_BN, x, y, 0.0);
        if (!gets && upright == places - 1) shares.first_missed_N = Vector3(x, y, 0);
        upright += gets ? 1 : 0;
        leaning += GetsAt(input_.bin.X_BN, x, y, Radians(kLean_deg)) ? 1 : 0;
      }
    }
    shares.floor_upright = static_cast<double>(upright) / places;
    shares.floor_leaning = static_cast<double>(leaning) / places;
  }

  void Tray(ReachShares& shares) const {
    const CellLayout& layout = input_.model.layout;
    const std::vector<Vector3> slots = Slots(layout, layout.tray_size_m);
    const auto gets = std::count_if(slots.begin(), slots.end(), [&](const Vector3& slot_T) {
      return GetsAt(layout.X_BT, slot_T.x(), slot_T.y(), 0.0);
    });
    shares.tray = static_cast<double>(gets) / static_cast<double>(slots.size());
  }

  void Station(ReachShares& shares) const {
    int gets = 0;
    for (int k = 0; k < kTilts; ++k) {
      const double way = 2.0 * kPi * k / kTilts;
      const Vector3 axis(std::cos(way), std::sin(way), 0.0);
      const Matrix3 tilt = Eigen::AngleAxisd(Radians(kTilt_deg), axis).toRotationMatrix();
      bool any = false;
      for (int yaw = 0; yaw < kYaws && !any; ++yaw) {
        any = Gets(MakeTransform(tilt * VerticalTool(2.0 * kPi * yaw / kYaws),
                                 input_.model.layout.p_BTilt));
      }
      gets += any ? 1 : 0;
    }
    shares.station = static_cast<double>(gets) / kTilts;
  }

  void Views(ReachShares& shares) const {
    const auto gets = std::count_if(
        input_.views_BS.begin(), input_.views_BS.end(),
        [&](const RigidTransform& X_BS) { return Gets(planner_.PoseOfEForScan(X_BS)); });
    shares.views = input_.views_BS.empty()
                       ? 0.0
                       : static_cast<double>(gets) / static_cast<double>(input_.views_BS.size());
  }

 private:
  /// Of the open gripper along its closing direction.
  double HalfWidth_m() const {
    const GripperSpec& gripper = input_.model.gripper;
    double half_m = 0.5 * opening_m_ + gripper.finger_thickness_m;
    for (const GripperSpec::Link& link : gripper.links) {
      const RigidTransform X_ELink = LinkPose(link, opening_m_, +1);
      const Vector3 reach = X_ELink.linear().cwiseAbs() * HalfExtent(link.shape);
      half_m = std::max(half_m, X_ELink.translation().y() + reach.y());
    }
    return half_m;
  }

  const CellCheckInput& input_;
  MotionPlanner planner_;
  double opening_m_;
};

}  // namespace

ReachShares ReachOf(const CellCheckInput& input) {
  const Reach reach(input);
  ReachShares shares;
  reach.Floor(shares);
  reach.Tray(shares);
  reach.Station(shares);
  reach.Views(shares);
  return shares;
}

}  // namespace tubetwin

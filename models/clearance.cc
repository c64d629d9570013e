#include "models/clearance.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <array>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr int kNumBodies = 8;         // base, links 1 to 6, flange
constexpr double kPlateHalf_m = 2.0;  // the plate goes on as floor
constexpr double kSlab_m = 0.10;      // floor, tray and plate are at least this thick

std::shared_ptr<fcl::CollisionGeometryd> Geometry(const Shape& shape) {
  const Vector3& s = shape.size_m;
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return std::make_shared<fcl::Boxd>(2 * s.x(), 2 * s.y(), 2 * s.z());
    case Shape::Kind::kCapsule:
      return std::make_shared<fcl::Capsuled>(s.x(), 2 * s.y());
    case Shape::Kind::kCylinder:
      return std::make_shared<fcl::Cylinderd>(s.x(), 2 * s.y());
    case Shape::Kind::kSphere:
      break;
  }
  return std::make_shared<fcl::Sphered>(s.x());
}

/// A shape with its FCL twin; moving ones are placed anew at each check.
struct Solid {
  Shape shape;
  std::shared_ptr<const fcl::CollisionGeometryd> geometry;
  Vector3 half_extent_m;

  explicit Solid(Shape s)
      : shape(std::move(s)), geometry(Geometry(shape)), half_extent_m(HalfExtent(shape)) {}
};

struct Placed {
  const Solid* solid = nullptr;
  RigidTransform X_BShape;
  Vector3 half_B_m;  // of the axis-aligned box in B

  Placed(const Solid& s, const RigidTransform& X_BBody)
      : solid(&s), X_BShape(X_BBody * s.shape.X_LinkShape) {
    half_B_m = X_BShape.linear().cwiseAbs() * s.half_extent_m;
  }
};

/// Distance of the boxes around two shapes: never more than the shapes' own.
double LowerBound(const Placed& a, const Placed& b) {
  const Vector3 gap =
      (a.X_BShape.translation() - b.X_BShape.translation()).cwiseAbs() - a.half_B_m - b.half_B_m;
  return gap.cwiseMax(0.0).norm();
}

double Distance(const Placed& a, const Placed& b) {
  fcl::DistanceRequestd request;
  request.enable_signed_distance = true;
  request.distance_tolerance = 1e-5;
  fcl::DistanceResultd result;
  fcl::distance(a.solid->geometry.get(), a.X_BShape, b.solid->geometry.get(), b.X_BShape, request,
                result);
  return result.min_distance;
}

Shape BoxShape(const char* name, const RigidTransform& X, const Vector3& half_m) {
  return {Shape::Kind::kBox, name, 0, X, half_m, false};
}

/// The smallest distance of one kind of pair so far.
struct Best {
  double clearance_m;
  const Solid* moving = nullptr;
  const Solid* obstacle = nullptr;

  void Try(const Placed& a, const Placed& b) {
    if (LowerBound(a, b) >= clearance_m) return;
    const double distance = Distance(a, b);
    if (distance >= clearance_m) return;
    clearance_m = distance;
    moving = a.solid;
    obstacle = b.solid;
  }
  ClearanceChecker::Nearest Named() const {
    ClearanceChecker::Nearest out;
    out.clearance_m = clearance_m;
    if (moving != nullptr) out.moving = moving->shape.name;
    if (obstacle != nullptr) out.obstacle = obstacle->shape.name;
    return out;
  }
};

}  // namespace

struct ClearanceChecker::Impl {
  const CellModel& model;
  std::array<std::vector<Solid>, kNumBodies> bodies;
  Solid finger;
  std::vector<Solid> links;  // of a finger, beside its bar
  std::vector<Solid> bin_solids, other_solids;
  std::vector<Placed> bin_obstacles, other_obstacles;

  Impl(const CellModel& m, const Bin& bin) : model(m), finger(FingerShape(m.gripper)) {
    for (Shape& shape : MovingShapes(model)) bodies[shape.link].emplace_back(std::move(shape));
    for (const GripperSpec::Link& link : model.gripper.links) links.emplace_back(link.shape);
    AddBin(bin);
    const CellLayout& layout = model.layout;
    const double tray_half_m = 0.5 * layout.tray_size_m;
    other_solids.emplace_back(BoxShape("tray", layout.X_BT * Translation(0, 0, -0.5 * kSlab_m),
                                       Vector3(tray_half_m, tray_half_m, 0.5 * kSlab_m)));
    other_solids.emplace_back(BoxShape("cell plate",
                                       Translation(0, 0, layout.plate_z_m - 0.5 * kSlab_m),
                                       Vector3(kPlateHalf_m, kPlateHalf_m, 0.5 * kSlab_m)));
    for (Shape& shape : StandingShapes(model)) other_solids.emplace_back(std::move(shape));
    for (const Solid& s : bin_solids) bin_obstacles.emplace_back(s, RigidTransform::Identity());
    for (const Solid& s : other_solids) other_obstacles.emplace_back(s, RigidTransform::Identity());
  }

  static Shape FingerShape(const GripperSpec& gripper) {
    return {Shape::Kind::kBox,
            "finger",
            kFlangeBody,
            RigidTransform::Identity(),
            0.5 * Vector3(gripper.pad_width_m, gripper.finger_thickness_m, gripper.finger_length_m),
            false};
  }

  void AddBin(const Bin& bin) {
    const double x = bin.half_x_m(), y = bin.half_y_m(), t = Bin::kWallThickness_m;
    const double h = 0.5 * bin.wall_m();
    const auto add = [&](const char* name, const Vector3& centre_N, const Vector3& half_m) {
      bin_solids.emplace_back(BoxShape(name, bin.X_BN * Translation(centre_N), half_m));
    };
    add("bin floor", {0, 0, -0.5 * kSlab_m}, {x + t, y + t, 0.5 * kSlab_m});
    add("bin wall +x", {x + 0.5 * t, 0, h}, {0.5 * t, y + t, h});
    add("bin wall -x", {-x - 0.5 * t, 0, h}, {0.5 * t, y + t, h});
    add("bin wall +y", {0, y + 0.5 * t, h}, {x + t, 0.5 * t, h});
    add("bin wall -y", {0, -y - 0.5 * t, h}, {x + t, 0.5 * t, h});
  }

  std::array<Placed, 2> PlaceFingers(const RigidTransform& X_BE, double opening_m) const {
    const GripperSpec& gripper = model.gripper;
    const double y = 0.5 * (opening_m + gripper.finger_thickness_m);
    const double z =
        -PadRetreat(gripper, opening_m) + 0.5 * (gripper.pad_height_m - gripper.finger_length_m);
    return {Placed(finger, X_BE * Translation(0, y, z)),
            Placed(finger, X_BE * Translation(0, -y, z))};
  }

  void PlaceLinks(const RigidTransform& X_BE, double opening_m, std::vector<Placed>& out) const {
    for (std::size_t i = 0; i < links.size(); ++i) {
      for (const int side : {+1, -1}) {
        out.emplace_back(links[i], X_BE * LinkPose(model.gripper.links[i], opening_m, side));
      }
    }
  }
};

ClearanceChecker::ClearanceChecker(const CellModel& model, const Bin& bin)
    : impl_(std::make_unique<Impl>(model, bin)) {}
ClearanceChecker::~ClearanceChecker() = default;

ClearanceChecker::Result ClearanceChecker::Check(const JointVector& q, double opening_m,
                                                 double enough_m) const {
  const ArmModel& arm = impl_->model.arm;
  const auto X_BL = LinkPoses(arm, q);
  const RigidTransform X_BF = X_BL[kNumJoints] * arm.X_6F;
  const RigidTransform X_BE = X_BF * impl_->model.layout.X_FE;
  std::array<std::vector<Placed>, kNumBodies> bodies;
  for (int body = 0; body < kNumBodies; ++body) {
    bodies[body].reserve(impl_->bodies[body].size() + 2);
    for (const Solid& solid : impl_->bodies[body]) {
      bodies[body].emplace_back(solid, body == kFlangeBody ? X_BF : X_BL[body]);
    }
  }
  impl_->PlaceLinks(X_BE, opening_m, bodies[kFlangeBody]);
  const std::array<Placed, 2> fingers = impl_->PlaceFingers(X_BE, opening_m);

  Best fingers_best{enough_m}, others_best{enough_m};
  for (const Placed& finger : fingers) {
    for (const Placed& obstacle : impl_->bin_obstacles) fingers_best.Try(finger, obstacle);
  }
  for (int body = 2; body < kNumBodies; ++body) {  // base and shoulder stand on the plate
    for (const Placed& moving : bodies[body]) {
      for (const Placed& obstacle : impl_->bin_obstacles) others_best.Try(moving, obstacle);
    }
  }
  bodies[kFlangeBody].insert(bodies[kFlangeBody].end(), fingers.begin(), fingers.end());
  for (int body = 2; body < kNumBodies; ++body) {
    for (const Placed& moving : bodies[body]) {
      for (const Placed& obstacle : impl_->other_obstacles) others_best.Try(moving, obstacle);
    }
  }
  for (const auto& [a, b] : arm.self_pairs) {
    for (const Placed& moving : bodies[a]) {
      for (const Placed& other : bodies[b]) others_best.Try(moving, other);
    }
  }
  Result result;
  result.fingers = fingers_best.Named();
  result.others = others_best.Named();
  const Nearest& nearest =
      result.fingers.clearance_m < result.others.clearance_m ? result.fingers : result.others;
  static_cast<Nearest&>(result) = nearest;
  return result;
}

namespace {

/// Outside of the bin, walls and floor.
Shape WholeBin(const Bin& bin) {
  const double t = Bin::kWallThickness_m;
  const double height_m = bin.wall_m() + t;
  return BoxShape("bin", bin.X_BN * Translation(0, 0, 0.5 * height_m - t),
                  {bin.half_x_m() + t, bin.half_y_m() + t, 0.5 * height_m});
}

/// The block from the plate up to the tray's surface.
Shape WholeTray(const CellLayout& layout) {
  const double half_m = 0.5 * layout.tray_size_m;
  const double down_m = std::max(1e-3, 0.5 * (layout.X_BT.translation().z() - layout.plate_z_m));
  return BoxShape("tray", layout.X_BT * Translation(0, 0, -down_m), {half_m, half_m, down_m});
}

}  // namespace

std::vector<StandingPair> StandingClearances(const CellModel& model, const Bin& bin) {
  const CellLayout& layout = model.layout;
  const Solid bin_solid(WholeBin(bin)), tray_solid(WholeTray(layout));
  const RigidTransform identity = RigidTransform::Identity();
  std::vector<StandingPair> pairs;
  const auto add = [&](const Solid& a, const Solid& b, const RigidTransform& X_BBodyOfB,
                       const char* key) {
    pairs.push_back(
        {a.shape.name, b.shape.name, Distance(Placed(a, identity), Placed(b, X_BBodyOfB)), key});
  };
  constexpr const char* kBinKey = "bin.X_BN, bin.size_m";
  constexpr const char* kTrayKey = "tray.X_BT, tray.size_m";
  add(bin_solid, tray_solid, identity, kBinKey);
  const double t = Bin::kWallThickness_m;
  // A bin may stand on the plate itself.
  const double over_plate_m = bin.X_BN.translation().z() - t - layout.plate_z_m;
  if (over_plate_m < 0.0) pairs.push_back({"bin", "cell plate", over_plate_m, kBinKey});
  pairs.push_back(
      {"tray", "cell plate", layout.X_BT.translation().z() - layout.plate_z_m, kTrayKey});
  // The base does not move, and the first link turns about its own axis.
  const auto X_BL = LinkPoses(model.arm, JointVector::Zero());
  for (const Shape& shape : MovingShapes(model)) {
    if (shape.link > 1) continue;
    const Solid solid(shape);
    add(bin_solid, solid, X_BL[shape.link], kBinKey);
    add(tray_solid, solid, X_BL[shape.link], kTrayKey);
  }
  for (const Shape& shape : StandingShapes(model)) {
    const Solid solid(shape);
    add(bin_solid, solid, identity, kBinKey);
    add(tray_solid, solid, identity, kTrayKey);
  }
  return pairs;
}

}  // namespace tubetwin

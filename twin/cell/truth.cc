#include "twin/cell/truth.h"

#include <algorithm>
#include <vector>

#include "twin/cell/gripper_body.h"
#include "twin/cell/twin_cell_impl.h"

namespace tubetwin {
namespace {

constexpr double kAtRest_m_s = 0.02;
/// This far below the lower of bin floor and tray a tube has left both.
constexpr double kBelow_m = 0.01;

/// Who touches whom now.
struct Touching {
  std::vector<bool> left_pad, right_pad, gripper, support;  ///< Per tube.
  std::vector<std::vector<int>> tubes;                      ///< Tubes that touch a tube.
};

bool BelongsToGripper(const mjModel& model, int geom) {
  // Palm and fingers all hang below the body of the wrist's sensor site.
  const int tool = model.site_bodyid[IdOf(model, mjOBJ_SITE, "wrist")];
  for (int body = model.geom_bodyid[geom]; body > 0; body = model.body_parentid[body]) {
    if (body == tool) return true;
  }
  return false;
}

Touching FindTouching(const CellWorld& world, std::size_t tubes) {
  const mjModel& model = world.model();
  const mjData& data = world.data();
  const int left = IdOf(model, mjOBJ_GEOM, kPadLeftGeom);
  const int right = IdOf(model, mjOBJ_GEOM, kPadRightGeom);
  Touching touching;
  touching.left_pad.assign(tubes, false);
  touching.right_pad = touching.gripper = touching.support = touching.left_pad;
  touching.tubes.resize(tubes);
  const auto note = [&](int tube, int other_geom) {
    if (tube < 0) return;
    const int other = world.TubeOfGeom(other_geom);
    if (other >= 0) {
      if (other != tube) touching.tubes[tube].push_back(other);
    } else if (BelongsToGripper(model, other_geom)) {
      touching.gripper[tube] = true;
      if (other_geom == left) touching.left_pad[tube] = true;
      if (other_geom == right) touching.right_pad[tube] = true;
    } else {
      touching.support[tube] = true;
    }
  };
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    note(world.TubeOfGeom(contact.geom[0]), contact.geom[1]);
    note(world.TubeOfGeom(contact.geom[1]), contact.geom[0]);
  }
  return touching;
}

/// Tubes that hang: reached from the gripper through tubes that rest on nothing else.
std::vector<bool> FindHanging(const Touching& touching) {
  std::vector<bool> hangs(touching.gripper.size(), false);
  std::vector<int> open;
  const auto reach = [&](int tube) {
    if (hangs[tube] || touching.support[tube]) return;
    hangs[tube] = true;
    open.push_back(tube);
  };
  for (std::size_t tube = 0; tube < hangs.size(); ++tube) {
    if (touching.gripper[tube]) reach(static_cast<int>(tube));
  }
  while (!open.empty()) {
    const int tube = open.back();
    open.pop_back();
    for (const int other : touching.tubes[tube]) reach(other);
  }
  return hangs;
}

bool Inside(const Vector3& p, double half_x_m, double half_y_m) {
  return std::abs(p.x()) <= half_x_m && std::abs(p.y()) <= half_y_m;
}

}  // namespace

Truth::Truth(const TwinCell& cell) : cell_(cell) {}

std::vector<Truth::Tube> Truth::Tubes() const {
  const TwinCell::Impl& impl = *cell_.impl_;
  const Pile& start = impl.start_pile;
  const CellLayout& layout = impl.model.layout;
  const Bin& bin = start.bin;
  const mjModel& model = impl.world.model();
  const mjData& data = impl.world.data();
  const Touching touching = FindTouching(impl.world, start.tubes.size());
  const std::vector<bool> hanging = FindHanging(touching);
  const double lowest_m =
      std::min(bin.X_BN.translation().z(), layout.X_BT.translation().z()) - kBelow_m;

  std::vector<Tube> tubes(start.tubes.size());
  for (std::size_t k = 0; k < tubes.size(); ++k) {
    Tube& tube = tubes[k];
    const TubeBody& body = impl.world.tubes()[k];
    const double radius_m = start.tubes[k].radius_m;
    tube.id = start.tubes[k].id;
    tube.centerline_B = body.Centerline_W(data);
    tube.centre_of_mass_B = body.CentreOfMass_W(model, data);
    tube.speed_m_s = body.MaxSpeed(model, data);
    tube.touches_pads = touching.left_pad[k] && touching.right_pad[k];
    tube.hangs = hanging[k];
    const double half_tray_m = 0.5 * layout.tray_size_m;
    tube.over_tray =
        Inside(layout.X_BT.inverse() * tube.centre_of_mass_B, half_tray_m, half_tray_m);
    bool below = false;
    for (const Vector3& p_B : Resample(tube.centerline_B, radius_m)) {
      tube.over_bin = tube.over_bin || Inside(bin.X_BN.inverse() * p_B, bin.half_x_m() + radius_m,
                                              bin.half_y_m() + radius_m);
      below = below || p_B.z() - radius_m < lowest_m;
    }
    const bool centre_in_bin =
        Inside(bin.X_BN.inverse() * tube.centre_of_mass_B, bin.half_x_m(), bin.half_y_m());
    const bool rests = !tube.hangs && tube.speed_m_s < kAtRest_m_s;
    tube.outside = below || (rests && !tube.over_tray && !centre_in_bin);
  }
  return tubes;
}

int Truth::Held() const {
  int held = 0;
  for (const Tube& tube : Tubes()) held += tube.hangs ? 1 : 0;
  return held;
}

Pile Truth::CurrentPile() const {
  const TwinCell::Impl& impl = *cell_.impl_;
  Pile pile = impl.start_pile;
  const mjData& data = impl.world.data();
  bool settled = true;
  for (std::size_t k = 0; k < pile.tubes.size(); ++k) {
    const TubeBody& body = impl.world.tubes()[k];
    pile.tubes[k] = body.Current(data);
    settled = settled && body.MaxSpeed(impl.world.model(), data) < kAtRest_m_s;
  }
  pile.settled = settled;
  return pile;
}

RigidTransform Truth::X_BS() const { return cell_.impl_->scanner.TrueX_BS(); }

}  // namespace tubetwin

#include "scenes/bin_body.h"

#include "scenes/engine/mj_handles.h"
#include "scenes/engine/surface.h"

namespace tubetwin {
namespace {

mjsGeom* AddGeom(mjSpec& spec, const std::string& name, mjtGeom type, const RigidTransform& X_WG,
                 const Vector3& half_size_m, const BinBodyOptions& options) {
  mjsGeom* geom = mjs_addGeom(mjs_findBody(&spec, "world"), nullptr);
  SetName(geom->element, name);
  geom->type = type;
  SetPose(X_WG, geom->pos, geom->quat);
  for (int k = 0; k < 3; ++k) {
    geom->size[k] = half_size_m[k];
    geom->rgba[k] = static_cast<float>(options.colour_rgb[k]);
  }
  geom->rgba[3] = 1.0f;
  // The bin's friction and not the larger of both sides.
  SetSurface(*geom, options.friction, 1, options.contact_time_s);
  return geom;
}

}  // namespace

void AddBin(mjSpec& spec, const Bin& bin, const BinBodyOptions& options) {
  const double half = 0.5 * Bin::kWallThickness_m;
  const double x = bin.half_x_m(), y = bin.half_y_m();
  const auto add = [&](const std::string& name, const Vector3& centre_N, const Vector3& size) {
    AddGeom(spec, name, mjGEOM_BOX, options.X_WN * Translation(centre_N), size, options);
  };
  add("bin_floor", {0, 0, -half}, {x, y, half});
  // From the floor's lower face to the rim; the x walls are as long as the bin outside.
  const double middle = 0.5 * bin.wall_m() - half, tall = 0.5 * bin.wall_m() + half;
  for (const double side : {1.0, -1.0}) {
    const std::string sign = side > 0 ? "+" : "-";
    add("bin_wall_x" + sign, {side * (x + half), 0, middle}, {half, y + 2 * half, tall});
    add("bin_wall_y" + sign, {0, side * (y + half), middle}, {x, half, tall});
  }
}

void AddGround(mjSpec& spec, const RigidTransform& X_WP, const BinBodyOptions& options) {
  AddGeom(spec, "ground", mjGEOM_PLANE, X_WP, {2.0, 2.0, 0.1}, options);
}

}  // namespace tubetwin

#include "twin/round/records/tolerance.h"

#include "models/base/config/config.h"
#include "models/base/json.h"

namespace tubetwin {

void PlacementTolerance::Visit(ConfigVisitor& v) {
  v.Field("position_mm",
          "in_tolerance: most that a placed tube's centre of mass may lie from its slot's centre, "
          "horizontally",
          position_mm, {0.0, 1000.0});
  v.Field("yaw_deg",
          "in_tolerance: most that its first principal axis may be turned from the slot's yaw, "
          "modulo 180 degrees; 90 allows all",
          yaw_deg, {0.0, 90.0});
}

Json ToJson(const PlacementTolerance& tolerance) {
  return Json{{"position_mm", tolerance.position_mm}, {"yaw_deg", tolerance.yaw_deg}};
}

PlacementTolerance ToleranceFromJson(const JsonView& view) {
  return {view.Field("position_mm").AsNumber(), view.Field("yaw_deg").AsNumber()};
}

}  // namespace tubetwin

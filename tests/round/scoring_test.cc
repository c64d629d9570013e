#include "twin/round/scoring.h"

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Ids = std::vector<int>;

Truth::Tube OnTray(int id, double speed_m_s) {
  Truth::Tube tube;
  tube.id = id;
  tube.over_tray = true;
  tube.speed_m_s = speed_m_s;
  return tube;
}

TEST_CASE("A tube counts as placed once it rests, and stays so while a new one makes it rock",
          "[unit]") {
  TrayCount tray = CountTray({OnTray(1, 0.5), OnTray(2, 0.001)}, {});
  CHECK(tray.placed_ids == Ids{2});
  CHECK(tray.arrived_ids == Ids{1, 2});
  tray = CountTray({OnTray(1, 0.001), OnTray(2, 0.5)}, tray);
  CHECK(tray.placed_ids == Ids{1, 2});
}

TEST_CASE("A tube in the fingers, half over the bin or off the tray is not placed", "[unit]") {
  Truth::Tube pinched = OnTray(1, 0.0), hanging = OnTray(2, 0.0), leaning = OnTray(3, 0.0),
              off = OnTray(4, 0.0);
  pinched.touches_pads = true;
  hanging.hangs = true;
  leaning.over_bin = true;
  off.over_tray = false;
  const TrayCount all{{1, 2, 3, 4}, {1, 2, 3, 4}};
  CHECK(CountTray({pinched, hanging, leaning, off}, all).placed_ids.empty());
  CHECK(CountTray({pinched, hanging, leaning, off}, all).arrived_ids.empty());
}

}  // namespace
}  // namespace tubetwin

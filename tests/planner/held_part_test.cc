#include "planner/grasp/held_part.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

Part Hose() {
  Part part = LoadPart("hose_b");
  part.mass_kg = 0.11;
  part.length_m = 0.40;
  part.bending_stiffness_Nm2 = 0.15;
  return part;
}

TEST_CASE("A hose held at its end sags and swings as a cantilever", "[unit]") {
  const Part part = Hose();
  const Polyline line_E = StraightLine({0, 0, 0.009}, {0.4, 0, 0.009});
  const HeldPart held = HeldPartOf(line_E, part);
  const double weight_N_m = 0.11 / 0.4 * kGravity;
  CHECK(held.sag_m == Approx(weight_N_m * std::pow(0.4, 4) / (8 * 0.15)));
  const double speed_rad_s = 1.875104 * 1.875104 * std::sqrt(0.15 / (0.275 * std::pow(0.4, 4)));
  CHECK(held.period_s == Approx(2 * kPi / speed_rad_s).epsilon(1e-4));
  const Polyline sagged = Sagged(line_E, part);
  CHECK(sagged.front().z() == line_E.front().z());
  CHECK(sagged.back().z() - 0.009 == Approx(held.sag_m));
}

TEST_CASE("Held in the middle each half gives way by itself", "[unit]") {
  const Part part = Hose();
  const Polyline line_E = {{-0.2, 0, 0.009}, {0.0, 0, 0.009}, {0.2, 0, 0.009}};
  const HeldPart middle = HeldPartOf(line_E, part);
  const HeldPart end = HeldPartOf(StraightLine({0, 0, 0.009}, {0.4, 0, 0.009}), part);
  CHECK(middle.sag_m == Approx(end.sag_m / 16));
  CHECK(middle.period_s == Approx(end.period_s / 4));
  const Polyline sagged = Sagged(line_E, part);
  CHECK(sagged.front().z() == Approx(0.009 + middle.sag_m));
  CHECK(sagged[1].z() == 0.009);
  CHECK(sagged.back().z() == Approx(0.009 + middle.sag_m));
}

TEST_CASE("What hangs straight down does not sag, and rigid parts never do", "[unit]") {
  const Polyline down_E = StraightLine({0, 0, 0.0}, {0, 0, 0.3});
  const Polyline sagged = Sagged(down_E, Hose());
  for (std::size_t i = 0; i < down_E.size(); ++i) CHECK(sagged[i] == down_E[i]);
  const Part rigid = LoadPart("pvc_a");
  const Polyline line_E = StraightLine({0, 0, 0.009}, {0.5, 0, 0.009});
  CHECK(HeldPartOf(line_E, rigid).period_s == 0.0);
  CHECK(Sagged(line_E, rigid).back() == line_E.back());
}

}  // namespace
}  // namespace tubetwin

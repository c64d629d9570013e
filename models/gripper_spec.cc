#include "models/gripper_spec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tubetwin {
namespace {

struct Row {
  double opening_m, advance_m;
};
// Public model's linkage (two parallel cranks of 57.5 mm), crank angle 0.8 to 0 rad.
constexpr std::array<Row, 5> kAdvance = {
    {{0.0002, 0.0138}, {0.0231, 0.0136}, {0.0456, 0.0112}, {0.0666, 0.0066}, {0.0850, 0.0}}};
constexpr int kRows = static_cast<int>(kAdvance.size());

double Secant(int i) {
  return (kAdvance[i + 1].advance_m - kAdvance[i].advance_m) /
         (kAdvance[i + 1].opening_m - kAdvance[i].opening_m);
}

/// Slope at a row, Fritsch and Butland's harmonic mean: keeps the cubic monotone.
double Slope(int i) {
  if (i == 0) return Secant(0);
  if (i == kRows - 1) return Secant(kRows - 2);
  return 2 * Secant(i - 1) * Secant(i) / (Secant(i - 1) + Secant(i));
}

constexpr double kOverAxis_m = 0.009;   // pads' centre over the tube's axis: holds best there
constexpr double kOverFloor_m = 0.002;  // pads' lower edge over the floor

}  // namespace

double TipAdvance(double opening_m) {
  const double x = std::clamp(opening_m, kAdvance.front().opening_m, kAdvance.back().opening_m);
  int i = 0;
  while (i < kRows - 2 && x > kAdvance[i + 1].opening_m) ++i;
  const double width = kAdvance[i + 1].opening_m - kAdvance[i].opening_m;
  const double u = (x - kAdvance[i].opening_m) / width;
  const double rise = kAdvance[i + 1].advance_m - kAdvance[i].advance_m;
  const double a = width * Slope(i) - rise, b = rise - width * Slope(i + 1);
  return kAdvance[i].advance_m + u * rise + u * (1 - u) * ((1 - u) * a + u * b);
}

double GraspHeightOverAxis(double axis_height_m, const GripperSpec& spec) {
  const double lowest_E_m = kOverFloor_m + 0.5 * spec.pad_height_m;
  return std::max(kOverAxis_m, lowest_E_m - axis_height_m);
}

}  // namespace tubetwin

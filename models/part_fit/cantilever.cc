#include "models/part_fit/cantilever.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/frames.h"

namespace tubetwin {
namespace {

/// Slope at the clamp and height lost from there to the tip (in overhangs) of a beam whose tip
/// slopes by `tip`; `load` is w L^3 / EI. From the tip, where nothing bends, theta'' = -load u cos
/// theta, by the classical Runge-Kutta method.
struct Shot {
  double clamp = 0.0, sag = 0.0;
};

Shot FromTip(double tip, double load) {
  // Rises with the load: a heavy beam bends within a short piece at its clamp.
  const int steps = 200 + static_cast<int>(40.0 * std::cbrt(load));
  const double h = 1.0 / steps;
  double theta = tip, rate = 0.0;
  Shot shot;
  const auto bend = [load](double u, double angle) { return -load * u * std::cos(angle); };
  for (int i = 0; i < steps; ++i) {
    const double u = i * h;
    const double k1 = bend(u, theta), r1 = rate;
    const double k2 = bend(u + 0.5 * h, theta + 0.5 * h * r1), r2 = rate + 0.5 * h * k1;
    const double k3 = bend(u + 0.5 * h, theta + 0.5 * h * r2), r3 = rate + 0.5 * h * k2;
    const double k4 = bend(u + h, theta + h * r3), r4 = rate + h * k3;
    const double middle = theta + 0.5 * h * r2, next = theta + h * (r1 + 2 * r2 + 2 * r3 + r4) / 6;
    shot.sag += h * (std::sin(theta) + 4.0 * std::sin(middle) + std::sin(next)) / 6.0;
    rate += h * (k1 + 2 * k2 + 2 * k3 + k4) / 6;
    theta = next;
  }
  shot.clamp = theta;
  return shot;
}

/// Sag over overhang of a beam of this load.
double SagShare(double load) {
  // Below this the small deflection is exact to 1e-6.
  if (load < 1e-2) return load / 8.0;
  double low = 0.0, high = 0.5 * kPi;
  for (int i = 0; i < 60; ++i) {
    const double tip = 0.5 * (low + high);
    (FromTip(tip, load).clamp < 0.0 ? low : high) = tip;
  }
  return FromTip(0.5 * (low + high), load).sag;
}

}  // namespace

double CantileverSag(double weight_N_m, double overhang_m, double stiffness_Nm2) {
  TT_CHECK(weight_N_m > 0.0 && overhang_m > 0.0 && stiffness_Nm2 > 0.0);
  return overhang_m * SagShare(weight_N_m * overhang_m * overhang_m * overhang_m / stiffness_Nm2);
}

double StiffnessFromSag(double weight_N_m, double overhang_m, double sag_m) {
  TT_CHECK(weight_N_m > 0.0 && sag_m > 0.0 && sag_m < overhang_m);
  const double share = sag_m / overhang_m;
  // The beam is stiffer than its small deflection says when bent far: the load is above 8 shares.
  double low = 7.9 * share, high = 16.0 * share;
  while (SagShare(high) < share) high *= 2.0;
  for (int i = 0; i < 50; ++i) {
    const double load = std::sqrt(low * high);
    (SagShare(load) < share ? low : high) = load;
  }
  return weight_N_m * overhang_m * overhang_m * overhang_m / std::sqrt(low * high);
}

MeasuredStiffness StiffnessFromSags(double weight_N_m, const std::vector<MeasuredSag>& sags,
                                    double reading_m) {
  TT_CHECK(!sags.empty());
  MeasuredStiffness out;
  double weights = 0.0, logs = 0.0, max_low = 0.0, min_high = 1e300;
  out.low_Nm2 = 1e300;
  for (const MeasuredSag& sag : sags) {
    const auto with = [&](double error_m) {
      return StiffnessFromSag(weight_N_m, sag.overhang_m, sag.sag_m + error_m);
    };
    const MeasuredStiffness::Each each{with(0.0), with(reading_m), with(-reading_m)};
    const double width = std::log(each.high_Nm2 / each.low_Nm2);
    const double weight = width > 0.0 ? 1.0 / (width * width) : 1.0;
    weights += weight;
    logs += weight * std::log(each.stiffness_Nm2);
    out.low_Nm2 = std::min(out.low_Nm2, each.low_Nm2);
    out.high_Nm2 = std::max(out.high_Nm2, each.high_Nm2);
    max_low = std::max(max_low, each.low_Nm2);
    min_high = std::min(min_high, each.high_Nm2);
    out.each.push_back(each);
  }
  out.stiffness_Nm2 = std::exp(logs / weights);
  out.gap = max_low / min_high;
  return out;
}

}  // namespace tubetwin

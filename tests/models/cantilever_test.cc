#include "models/part_fit/cantilever.h"

#include <cmath>

#include <Eigen/Dense>

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

/// Sag of a chain of `links` stiff pieces with springs between them, clamped and weighed at the
/// pieces' middles: least energy by Newton's method. Another discretisation than the one under
/// test; its error falls with the square of the pieces' length.
double ChainSag(double load, int links) {
  const int n = links;
  const double h = 1.0 / n;
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(n);
  // Springs of stiffness 1/h between pieces, 2/h at the clamp (half a piece away).
  for (int loaded = 1; loaded <= 40; ++loaded) {
    const double w = load * loaded / 40.0;
    for (int newton = 0; newton < 30; ++newton) {
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
      Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
      for (int i = 0; i < n; ++i) {
        const double stiffness = (i == 0 ? 2.0 : 1.0) / h;
        const double turn = theta[i] - (i == 0 ? 0.0 : theta[i - 1]);
        gradient[i] += stiffness * turn;
        hessian(i, i) += stiffness;
        if (i > 0) {
          gradient[i - 1] -= stiffness * turn;
          hessian(i - 1, i - 1) += stiffness;
          hessian(i, i - 1) -= stiffness;
          hessian(i - 1, i) -= stiffness;
        }
        // Weight beyond this piece, and half of its own, sinks by h sin theta.
        const double beyond = w * (1.0 - (i + 0.5) * h) * h;
        gradient[i] -= beyond * std::cos(theta[i]);
        hessian(i, i) += beyond * std::sin(theta[i]);
      }
      const Eigen::VectorXd step = hessian.ldlt().solve(gradient);
      theta -= step;
      if (step.norm() < 1e-12) break;
    }
  }
  double sag = 0.0;
  for (int i = 0; i < n; ++i) sag += h * std::sin(theta[i]);
  return sag;
}

/// Both discretisations' errors fall with the square of the step: extrapolated to none.
double ExactSag(double load) { return (4.0 * ChainSag(load, 200) - ChainSag(load, 100)) / 3.0; }

TEST_CASE("A cantilever sags as a chain of springs of ever shorter pieces does", "[unit]") {
  constexpr double kShare = 2e-4;
  for (const double load : {0.05, 0.5, 2.0, 5.0, 8.0, 15.0, 40.0}) {
    INFO("w L^3 / EI = " << load);
    const double overhang_m = 0.4, weight_N_m = 3.0;
    const double stiffness_Nm2 = weight_N_m * std::pow(overhang_m, 3) / load;
    const double exact_m = overhang_m * ExactSag(load);
    CHECK(CantileverSag(weight_N_m, overhang_m, stiffness_Nm2) == Approx(exact_m).epsilon(kShare));
    CHECK(StiffnessFromSag(weight_N_m, overhang_m, exact_m) ==
          Approx(stiffness_Nm2).epsilon(10.0 * kShare));
  }
}

TEST_CASE("A small sag is that of the small deflection, a large one is not", "[unit]") {
  // Mass 110 g, 0.4 m: hose_b, half of it over an edge.
  const double weight_N_m = 0.110 * 9.80665 / 0.4;
  const double small_m = weight_N_m * std::pow(0.2, 4) / (8.0 * 0.15);
  CHECK(CantileverSag(weight_N_m, 0.2, 0.15) == Approx(small_m).epsilon(0.002));
  CHECK(small_m == Approx(0.0036).epsilon(0.01));
  // Bent by half of the overhang the small deflection would take it for stiffer.
  const double stiffness_Nm2 = StiffnessFromSag(3.0, 0.4, 0.2);
  CHECK(3.0 * std::pow(0.4, 4) / (8.0 * 0.2) > 1.1 * stiffness_Nm2);
  CHECK(CantileverSag(3.0, 0.4, stiffness_Nm2) == Approx(0.2).epsilon(1e-4));
}

TEST_CASE("The range of a stiffness is what the reading error allows", "[unit]") {
  const double weight_N_m = 2.7;
  const double a_m = CantileverSag(weight_N_m, 0.3, 0.15),
               b_m = CantileverSag(weight_N_m, 0.2, 0.15);
  const MeasuredStiffness one = StiffnessFromSags(weight_N_m, {{0.3, a_m}}, 0.001);
  CHECK(one.stiffness_Nm2 == Approx(0.15).epsilon(1e-3));
  CHECK(one.low_Nm2 == Approx(StiffnessFromSag(weight_N_m, 0.3, a_m + 0.001)));
  CHECK(one.high_Nm2 == Approx(StiffnessFromSag(weight_N_m, 0.3, a_m - 0.001)));
  CHECK(one.gap == Approx(one.low_Nm2 / one.high_Nm2));
  // The shorter overhang's reading is worth less: it widens the range and hardly moves the value.
  const MeasuredStiffness two =
      StiffnessFromSags(weight_N_m, {{0.3, a_m}, {0.2, 0.8 * b_m}}, 0.001);
  CHECK(two.each[1].stiffness_Nm2 == Approx(0.15 / 0.8).epsilon(0.01));
  CHECK(two.gap < 1.0);
  CHECK(two.stiffness_Nm2 == Approx(0.15).epsilon(0.03));
  CHECK(two.stiffness_Nm2 > one.stiffness_Nm2);
  CHECK(two.high_Nm2 > one.high_Nm2);
  CHECK(two.low_Nm2 < one.low_Nm2);
  // Exact readings that disagree: a gap between them.
  const MeasuredStiffness exact =
      StiffnessFromSags(weight_N_m, {{0.3, a_m}, {0.2, 0.5 * b_m}}, 1e-6);
  CHECK(exact.gap == Approx(2.0).epsilon(0.01));
}

}  // namespace
}  // namespace tubetwin

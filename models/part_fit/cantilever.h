#pragma once

#include <utility>
#include <vector>

namespace tubetwin {

/// Sag of the free end of a beam that is clamped level at one end and hangs under its own weight
/// (large deflections: the planar elastica EI theta'' = -w (L - s) cos theta, theta(0) = 0,
/// theta'(L) = 0, integrated; w L^4 / (8 EI) while the sag is small). `weight_N_m`: per metre of
/// length. All positive. The relative error of the result is below 1e-4.
double CantileverSag(double weight_N_m, double overhang_m, double stiffness_Nm2);

/// The bending stiffness EI with which a beam sags so. Precondition: 0 < sag < overhang.
double StiffnessFromSag(double weight_N_m, double overhang_m, double sag_m);

/// A sag as somebody measured it: how far the free end hangs below where a straight one would be.
struct MeasuredSag {
  double overhang_m = 0.0, sag_m = 0.0;
};

/// Bending stiffness from one or two measured sags.
struct MeasuredStiffness {
  double stiffness_Nm2 = 0.0;
  /// From the smallest to the largest value that the reading error of any sag allows.
  double low_Nm2 = 0.0, high_Nm2 = 0.0;
  struct Each {
    double stiffness_Nm2, low_Nm2, high_Nm2;
  };
  std::vector<Each> each;  ///< Every sag on its own.
  /// Factor between the sags' ranges: above 1 where they do not overlap and more than the reading
  /// is wrong.
  double gap = 0.0;
};

/// EI of each sag, their mean weighted by how exact each is (geometric: a ratio is what is wrong),
/// and the range of all. `reading_m`: by
/// how much a reading may be wrong. Preconditions: at least one sag; reading < sag, sag + reading <
/// overhang.
MeasuredStiffness StiffnessFromSags(double weight_N_m, const std::vector<MeasuredSag>& sags,
                                    double reading_m);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/base/json_fwd.h"
#include "models/base/polyline.h"

namespace tubetwin {

/// What a part file may say; importers keep to it.
inline constexpr double kMinMass_kg = 1e-4, kMaxMass_kg = 5.0;
inline constexpr double kMinStiffness_Nm2 = 0.005, kMaxStiffness_Nm2 = 50.0;
/// Of shape "fixed": how many points, and their least distance.
inline constexpr int kMaxShapePoints = 200;
inline constexpr double kMinShapePiece_m = 0.001;

/// How often another tube comes along, by the displacement that one roll-out predicts: a line from
/// `extra_quiet_m` on, between two bounds, that counts as `extra_prior_samples` samples. Table
/// [search] of a part file. The defaults were fitted to 164 lifts of hose_b
/// (tests/benchmark/lifts.sh, threaded piles, seeds 1 to 23): 0 of 34 below 5 cm, 1 of 32 to 10 cm,
/// 17 % to 20 cm, 50 % to 30 cm, 71 % to 50 cm, 89 % beyond. For other parts they are a default
/// that nobody measured.
struct PartSearch {
  std::string fitted_to = "hose_b";  ///< Name of the part that the numbers were measured with.
  double extra_per_m = 2.2, extra_quiet_m = 0.05, extra_min = 0.02, extra_max = 0.9;
  double extra_prior_samples = 5.0;
  /// After a motion that sheds by tilting, the displacement says nothing: a constant that counts as
  /// one sample.
  double extra_after_shedding = 0.15;
  void Visit(ConfigVisitor& v);
};

/// A kind of tube: what a user writes down in a part file (TOML).
struct Part {
  std::string name = "pvc_a";
  std::string kind = "rigid";  ///< "rigid" | "hose"
  double radius_m = 0.0125;    ///< Outer.
  double length_m = 0.50;      ///< Along the centerline, from tip to tip.
  double mass_kg = 0.055;
  double friction = 0.3;  ///< Tube on tube, on the bin and on the tray, nominal.
  std::vector<double> friction_range = {0.2, 0.5};  ///< Of each of the three.
  double bending_stiffness_Nm2 = 0.15;              ///< EI, hoses only.
  std::vector<double> bending_stiffness_range_Nm2 = {0.05, 0.30};
  /// Share of the elastic energy that a swing loses per radian, hoses only; twice the damping ratio
  /// of the first free bending mode.
  double loss_factor = 0.15;
  std::vector<double> loss_factor_range = {0.10, 0.20};
  int links = 10;  ///< Rigid links of a hose's chain, 8 to 40.
  /// How random shapes are drawn: "arcs" (planar bends over the whole length), "hooks" (a bend of
  /// total/2 near each end, radius 50 mm, planes turned), "polyline" (the public set's corners),
  /// "fixed" (every tube is bent like centerline_m).
  std::string shape = "arcs";
  std::vector<double> centerline_m;         ///< fixed: x y z of one point after another.
  std::vector<double> bends = {2, 4};       ///< arcs, polyline: number of bends, from and to.
  std::vector<double> bend_deg = {10, 70};  ///< Angle of one bend, from and to.
  std::vector<double> colour_rgb = {0.85, 0.85, 0.82};
  /// How much the surface mirrors, 0 matt to 1: what the scanner loses where it mirrors its
  /// projector.
  double gloss = 0.0;
  /// Where mass, friction, stiffness and shape come from, and what was fitted to what, for reports;
  /// empty: nobody said it.
  std::string source;
  PartSearch search;

  /// Share of light that the surface scatters back: mean of the colour.
  double albedo() const;
  bool is_hose() const { return kind == "hose"; }
  /// centerline_m as points.
  Polyline centerline() const;
  void Visit(ConfigVisitor& v);
};

/// Names of the parts that ship with the program, sorted.
std::vector<std::string> PartNames();

/// A shipped part by name, or a part file when `name_or_path` ends in ".toml".
/// Throws Error(kMissing) naming the nearest part, Error(kConfig) for a bad file (values outside
/// what physics and gripper can do included: radius 3 to 40 mm, length 0.05 to 2 m, mass 0.1 g to
/// 5 kg).
Part LoadPart(const std::string& name_or_path);

/// The part of a pile file: a name, or an object with the fields above.
Part PartFromJson(const JsonView& view);
Json PartToJson(const Part& part);

}  // namespace tubetwin

#pragma once

#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/base/json_fwd.h"
#include "models/base/polyline.h"

namespace tubetwin {

/// A kind of tube: what a user writes down in a part file (TOML).
struct Part {
  std::string name = "pvc_a";
  std::string kind = "rigid";  ///< "rigid" | "hose"
  double radius_m = 0.0125;    ///< Outer.
  double length_m = 0.50;      ///< Along the centerline.
  double mass_kg = 0.055;
  double friction = 0.3;  ///< Tube on tube and on the bin, nominal.
  std::vector<double> friction_range = {0.2, 0.5};
  double bending_stiffness_Nm2 = 0.15;  ///< EI, hoses only.
  std::vector<double> bending_stiffness_range_Nm2 = {0.05, 0.30};
  int links = 10;  ///< Rigid links of a hose's chain, 8 to 12.
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
/// what physics and gripper can do included: radius 3 to 40 mm, length 0.05 to 2 m, mass 1 g to 5
/// kg).
Part LoadPart(const std::string& name_or_path);

/// The part of a pile file: a name, or an object with the fields above.
Part PartFromJson(const JsonView& view);
Json PartToJson(const Part& part);

}  // namespace tubetwin

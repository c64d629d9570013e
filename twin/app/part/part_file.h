#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/part.h"
#include "models/part_fit/cantilever.h"
#include "perception/part_import/tube_of_mesh.h"

namespace tubetwin {

/// What `part import` was told besides the mesh.
struct PartImport {
  std::string mesh, units, name, material = "pvc_a";
  std::optional<double> mass_kg, density_kg_m3, wall_mm, sag_error_mm;
  std::vector<double> sag_mm, overhang_m;  ///< One of each, or two.

  /// By how much a sag may be misread.
  double reading_mm() const { return sag_error_mm.value_or(1.0); }
};

/// Throws Error(kUsage) for options that contradict one another or do not suffice: the message
/// names the options. `hose`: whether the material is one.
void CheckImportOptions(const PartImport& given, bool hose);

/// A part with the comments that its file begins with: where mass and stiffness come from.
struct ImportedPart {
  Part part;
  std::string mass_source;
  std::optional<MeasuredStiffness> stiffness;
  std::string stiffness_source;  ///< Empty for rigid parts.
};

/// The tube as a part of the given material. Its mass: as weighed; by density, of a wall as thick
/// as said or of what the mesh encloses; else of a wall as thick, in shares of the radius, as the
/// material's. Its stiffness: from the sags, else the material's. Throws Error(kUsage) where wall
/// or overhang do not go with the mesh, Error(kBadData) where the result is no part.
ImportedPart PartOfTube(const MeshTube& tube, const PartImport& given, const Part& material);

/// Points of a shape for a part file: the axis within `tolerance_m`, or as near as the number of
/// points that a part may have allows; points that follow too closely left out.
Polyline ShapePoints(const Polyline& axis, double tolerance_m);

/// "outer wall off this tube: rms 0.02 mm, ...".
std::string ResidualText(const MeshTube& tube);

/// The part file: comments that say where values come from, then every key.
std::string PartFileText(const ImportedPart& imported, const MeshTube& tube,
                         const PartImport& given);

}  // namespace tubetwin

#include "twin/app/part/part_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/frames.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

/// Nodes of the part's shape lie at most this share of the radius off the mesh's axis.
constexpr double kShapeTolerance = 0.08;
/// Points of a shape keep more than the least distance, so that rounding cannot break it.
constexpr double kApart = 1.5;
/// A wall that was said and one that the mesh has may differ by so much.
constexpr double kSameWall = 0.2;
/// Of the overhang: a sag beyond hardly says how stiff a hose is.
constexpr double kMaxSag = 0.9;
/// Sags that differ by more than their reading error and this factor are no sags of one hose.
constexpr double kContradiction = 2.0;

[[noreturn]] void Usage(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

/// To so many steps per unit: prints short.
double Rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit + 0.0;  // Never -0.
}

/// To so many significant digits.
double Significant(double value, int digits) {
  const double steps = std::pow(10.0, digits - 1 - std::floor(std::log10(value)));
  return std::round(value * steps) / steps;
}

std::string Short(double value) { return Number(Significant(value, 3)); }

std::string DefaultName(const std::string& mesh) {
  std::string name = std::filesystem::path(mesh).stem().string();
  bool any = false;
  for (char& c : name) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    any = any || letter;
    if (!letter && c != '-') c = '_';
  }
  return any ? name : "tube";
}

/// Centre of the curve, longest extent along x: where the mesh lay in its file means nothing.
Polyline Centred(Polyline line) {
  const Vector3 centre = CurveCentre(line);
  for (Vector3& p : line) p -= centre;
  return line;
}

/// Area of a pipe's cut of outer radius r and this wall.
double RingArea(double r, double wall_m) { return kPi * wall_m * (2.0 * r - wall_m); }

void SetMassByDensity(const MeshTube& tube, const PartImport& given, ImportedPart& out) {
  const double density = *given.density_kg_m3, r = tube.radius_m;
  const std::string by = "by density, " + Number(density) + " kg/m3 ";
  // The wall that the mesh itself has.
  const bool known = tube.volume_m3 && tube.hollow;
  const double area = known ? *tube.volume_m3 / tube.length_m : 0.0;
  const double mesh_wall_m = r - std::sqrt(std::max(0.0, r * r - area / kPi));
  if (given.wall_mm) {
    const double wall_m = *given.wall_mm / 1e3;
    if (wall_m > r) {
      Usage("--wall-mm " + Number(*given.wall_mm) + ": the tube's radius is " + Short(1e3 * r) +
            " mm; at most that");
    }
    if (known && std::abs(mesh_wall_m / wall_m - 1.0) > kSameWall) {
      Usage("--wall-mm " + Number(*given.wall_mm) + ": " + Printable(given.mesh) +
            " has a wall of " + Short(1e3 * mesh_wall_m) +
            " mm itself; leave --wall-mm out, or import a mesh without bore");
    }
    out.part.mass_kg = density * RingArea(r, wall_m) * tube.length_m;
    out.mass_source = by + "times a wall of " + Number(*given.wall_mm) + " mm";
  } else if (tube.volume_m3) {
    out.part.mass_kg = density * *tube.volume_m3;
    out.mass_source = by + "times the mesh's volume, " + Short(1e6 * *tube.volume_m3) + " cm3 (" +
                      (tube.hollow ? "wall of " + Short(1e3 * mesh_wall_m) + " mm"
                                   : "a full rod: for a pipe give --wall-mm") +
                      ")";
  } else {
    Usage("--density: " + Printable(given.mesh) +
          " is open and encloses no volume; give the thickness of its wall with --wall-mm");
  }
}

void SetMass(const MeshTube& tube, const PartImport& given, const Part& material,
             ImportedPart& out) {
  if (given.mass_kg) {
    out.part.mass_kg = *given.mass_kg;
    out.mass_source = "as weighed (--mass)";
    return;
  }
  if (given.density_kg_m3) {
    SetMassByDensity(tube, given, out);
  } else {
    const double thicker = tube.radius_m / material.radius_m;
    out.part.mass_kg = material.mass_kg * tube.length_m / material.length_m * thicker * thicker;
    out.mass_source = "an estimate from a wall in the proportion of " + Printable(given.material) +
                      "'s: weigh your tube";
  }
  out.part.mass_kg = Significant(out.part.mass_kg, 4);
  if (out.part.mass_kg >= kMinMass_kg && out.part.mass_kg <= kMaxMass_kg) return;
  throw Error(ErrorKind::kBadData, Printable(given.mesh) + ": its mass, " + out.mass_source +
                                       ", is " + Number(out.part.mass_kg) + " kg; allowed are " +
                                       Number(kMinMass_kg) + " to " + Number(kMaxMass_kg) +
                                       ": say it with --mass");
}

std::string SagsText(const PartImport& given) {
  std::string text;
  for (std::size_t i = 0; i < given.sag_mm.size(); ++i) {
    text += (i > 0 ? " and " : "") + Number(given.sag_mm[i]) + " mm at " +
            Number(given.overhang_m[i]) + " m";
  }
  return text;
}

void SetStiffness(const MeshTube& tube, const PartImport& given, ImportedPart& out) {
  if (given.sag_mm.empty()) {
    if (out.part.is_hose()) out.stiffness_source = "that of " + Printable(given.material);
    return;
  }
  std::vector<MeasuredSag> sags;
  for (std::size_t i = 0; i < given.sag_mm.size(); ++i) {
    sags.push_back({given.overhang_m[i], given.sag_mm[i] / 1e3});
    if (given.overhang_m[i] <= tube.length_m) continue;
    Usage("--overhang-m " + Number(given.overhang_m[i]) + ": the tube is " + Short(tube.length_m) +
          " m long; at most that");
  }
  const double weight_N_m = out.part.mass_kg * kGravity / tube.length_m;
  const double reading_m = given.reading_mm() / 1e3;
  const MeasuredStiffness found = StiffnessFromSags(weight_N_m, sags, reading_m);
  if (found.gap > kContradiction) {
    Usage("--sag-mm: " + SagsText(given) + " give stiffnesses of " +
          Short(found.each[0].stiffness_Nm2) + " and " + Short(found.each[1].stiffness_Nm2) +
          " N m2; of one hose they differ by less than a factor of two: measure again");
  }
  if (found.low_Nm2 < kMinStiffness_Nm2 || found.high_Nm2 > kMaxStiffness_Nm2) {
    throw Error(ErrorKind::kBadData,
                "--sag-mm: " + SagsText(given) + " and " + Number(out.part.mass_kg) +
                    " kg give a stiffness of " + Short(found.low_Nm2) + " to " +
                    Short(found.high_Nm2) + " N m2; allowed are " + Number(kMinStiffness_Nm2) +
                    " to " + Number(kMaxStiffness_Nm2) +
                    "; a part that hardly sags is \"rigid\" (--material pvc_a)");
  }
  out.part.bending_stiffness_Nm2 = Significant(found.stiffness_Nm2, 3);
  // Rounded outwards: the value stays within.
  out.part.bending_stiffness_range_Nm2 = {
      std::min(Significant(found.low_Nm2, 3), out.part.bending_stiffness_Nm2),
      std::max(Significant(found.high_Nm2, 3), out.part.bending_stiffness_Nm2)};
  out.stiffness_source = "from a sag of " + SagsText(given) + " under its own weight, readings +-" +
                         Number(given.reading_mm()) + " mm";
  if (found.each.size() > 1) {
    out.stiffness_source += "; alone they give " + Short(found.each[0].stiffness_Nm2) + " and " +
                            Short(found.each[1].stiffness_Nm2);
  }
  out.stiffness = found;
}

/// Points that follow the one before by less than `apart_m` left out, ends kept.
Polyline Apart(const Polyline& line, double apart_m) {
  Polyline out = {line.front()};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const bool room = (line[i] - out.back()).norm() >= apart_m;
    if (room && (line[i] - line.back()).norm() >= apart_m) out.push_back(line[i]);
  }
  out.push_back(line.back());
  return out;
}

}  // namespace

void CheckImportOptions(const PartImport& given, bool hose) {
  if (!given.name.empty() && !IsPlainUtf8(given.name)) {
    Usage("--name '" + Printable(given.name) + "': text (UTF-8) without control characters");
  }
  if (given.mass_kg && given.density_kg_m3) {
    Usage("--mass and --density both say the mass; give one of them");
  }
  if (given.wall_mm && !given.density_kg_m3) {
    Usage("--wall-mm needs --density: a wall alone weighs nothing");
  }
  if (given.sag_mm.size() != given.overhang_m.size() || given.sag_mm.size() > 2) {
    Usage("--sag-mm is given " + std::to_string(given.sag_mm.size()) + " times, --overhang-m " +
          std::to_string(given.overhang_m.size()) + "; one of each, or two of each");
  }
  if (given.sag_mm.empty()) {
    if (given.sag_error_mm) Usage("--sag-error-mm needs --sag-mm and --overhang-m");
    return;
  }
  if (!hose) {
    Usage("--sag-mm: " + Printable(given.material) +
          " is rigid and has no stiffness; give a hose as --material, such as hose_b");
  }
  if (!given.mass_kg && !given.density_kg_m3) {
    Usage("--sag-mm needs --mass or --density: the stiffness goes with the weight");
  }
  for (std::size_t i = 0; i < given.sag_mm.size(); ++i) {
    const double overhang_mm = 1e3 * given.overhang_m[i];
    if (given.sag_mm[i] <= given.reading_mm()) {
      Usage("--sag-mm " + Number(given.sag_mm[i]) + ": it must be above the reading error, " +
            Number(given.reading_mm()) + " mm (--sag-error-mm); let more hang over");
    }
    if (given.sag_mm[i] + given.reading_mm() >= kMaxSag * overhang_mm) {
      Usage("--sag-mm " + Number(given.sag_mm[i]) + ": at most 0.9 of the overhang, " +
            Number(Rounded(overhang_mm, 1e3)) + " mm");
    }
  }
  if (given.sag_mm.size() == 2 && given.overhang_m[0] == given.overhang_m[1]) {
    Usage("--overhang-m " + Number(given.overhang_m[0]) +
          " twice: a second sag tells more at another overhang");
  }
}

Polyline ShapePoints(const Polyline& axis, double tolerance_m) {
  for (;; tolerance_m *= 1.25) {
    Polyline line = Apart(Simplified(axis, tolerance_m), kApart * kMinShapePiece_m);
    if (line.size() <= static_cast<std::size_t>(kMaxShapePoints)) return line;
  }
}

ImportedPart PartOfTube(const MeshTube& tube, const PartImport& given, const Part& material) {
  ImportedPart out;
  out.part = material;
  Part& part = out.part;
  part.name = given.name.empty() ? DefaultName(given.mesh) : given.name;
  part.radius_m = Rounded(tube.radius_m, 1e6);
  part.length_m = Rounded(tube.length_m, 1e5);
  part.shape = "fixed";
  part.centerline_m.clear();
  for (const Vector3& p : Centred(ShapePoints(tube.line, kShapeTolerance * tube.radius_m))) {
    for (int k = 0; k < 3; ++k) part.centerline_m.push_back(Rounded(p[k], 1e5));
  }
  SetMass(tube, given, material, out);
  SetStiffness(tube, given, out);
  part.source = "Shape of " + Printable(std::filesystem::path(given.mesh).filename().string()) +
                "; mass " + out.mass_source +
                (out.stiffness_source.empty() ? "" : "; stiffness " + out.stiffness_source) +
                "; friction that of " + Printable(given.material);
  return out;
}

std::string ResidualText(const MeshTube& tube) {
  char text[240];
  int used =
      std::snprintf(text, sizeof text,
                    "outer wall off this tube: rms %.3f mm, largest %.3f mm, radius spread %.1f %%",
                    1e3 * tube.rms_m, 1e3 * tube.max_m, 100.0 * tube.radius_spread);
  if (tube.other_radius_share > 0.0) {
    std::snprintf(text + used, sizeof text - static_cast<std::size_t>(used),
                  "; radius %.2f to %.2f mm along it, over 5 %% off on %.0f %% of its length",
                  1e3 * tube.min_radius_m, 1e3 * tube.max_radius_m,
                  100.0 * tube.other_radius_share);
  }
  return text;
}

std::string PartFileText(const ImportedPart& imported, const MeshTube& tube,
                         const PartImport& given) {
  Part copy = imported.part;
  std::string text = "# Imported from " +
                     Printable(std::filesystem::path(given.mesh).filename().string()) +
                     (tube.hollow ? " (hollow; the outer wall counts).\n# " : ".\n# ") +
                     ResidualText(tube) + ".\n# Material of " + Printable(given.material) +
                     ".\n# mass_kg: " + imported.mass_source + ".\n";
  if (!imported.stiffness_source.empty()) {
    text += "# bending_stiffness_Nm2: " + imported.stiffness_source + ".\n";
  }
  return text + WriteToml([&copy](ConfigVisitor& v) { copy.Visit(v); }, false);
}

}  // namespace tubetwin

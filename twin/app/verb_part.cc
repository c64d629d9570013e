#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "models/gripper_spec.h"
#include "models/mesh/mesh.h"
#include "perception/part_import/tube_of_mesh.h"
#include "twin/app/common.h"
#include "twin/render/tube_fit_picture.h"

namespace tubetwin {
namespace {

void CheckGripperTakes(const Part& part, const std::string& source) {
  const GripperSpec gripper;
  if (2 * part.radius_m + 0.008 <= gripper.stroke_m) return;
  throw Error(ErrorKind::kBadData, source + ": radius_m = " + Number(part.radius_m) +
                                       ": the gripper opens " + Number(gripper.stroke_m) +
                                       " m; at most " + Number(0.5 * (gripper.stroke_m - 0.008)));
}

int CheckPart(const std::string& file, const Common& common) {
  const Part part = LoadPart(file);
  CheckGripperTakes(part, file);
  if (common.json) {
    std::printf("%s\n", PartToJson(part).dump(2).c_str());
    return 0;
  }
  const double weight_N = part.mass_kg * kGravity;
  std::printf("%s: %s, radius %s m, length %s m, %s kg\n", part.name.c_str(), part.kind.c_str(),
              Number(part.radius_m).c_str(), Number(part.length_m).c_str(),
              Number(part.mass_kg).c_str());
  std::printf("weight %.3f N = %.0f steps of the force sensor (1/40 N)\n", weight_N,
              weight_N * 40.0);
  if (part.is_hose()) {
    const double half = 0.5 * part.length_m;
    std::printf("held in the middle each half sags %.1f mm (beam, EI %s N m^2)\n",
                1e3 * weight_N / part.length_m * half * half * half * half /
                    (8 * part.bending_stiffness_Nm2),
                Number(part.bending_stiffness_Nm2).c_str());
  }
  if (weight_N < 10.0 / 40.0) {
    std::printf("warning: lighter than 10 sensor steps, one and two tubes may not be told apart\n");
  }
  return 0;
}

struct ImportOptions {
  std::string mesh, units, name, material = "pvc_a";
  double mass_kg = 0.0;  ///< 0: estimated.
};

/// Nodes of the part's shape lie at most this share of the radius off the mesh's axis.
constexpr double kShapeTolerance = 0.08;

/// Centre of the curve, longest extent along x: where the mesh lay in its file means nothing.
Polyline Centred(Polyline line) {
  const Vector3 centre = CurveCentre(line);
  for (Vector3& p : line) p -= centre;
  return line;
}

/// To so many steps per unit: prints short.
double Rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

std::string DefaultName(const std::string& mesh) {
  std::string name = std::filesystem::path(mesh).stem().string();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  }
  return name;
}

/// The tube as a part of the given material. Mass: of a wall as thick, in shares of the radius, as
/// the material's.
Part PartOf(const MeshTube& tube, const ImportOptions& given, const Part& material) {
  Part part = material;
  part.name = given.name.empty() ? DefaultName(given.mesh) : given.name;
  part.radius_m = Rounded(tube.radius_m, 1e6);
  part.length_m = Rounded(tube.length_m, 1e5);
  const double thicker = tube.radius_m / material.radius_m;
  part.mass_kg =
      given.mass_kg > 0.0
          ? given.mass_kg
          : Rounded(material.mass_kg * tube.length_m / material.length_m * thicker * thicker, 1e5);
  part.shape = "fixed";
  part.centerline_m.clear();
  for (const Vector3& p : Centred(Simplified(tube.line, kShapeTolerance * tube.radius_m))) {
    for (int k = 0; k < 3; ++k) part.centerline_m.push_back(Rounded(p[k], 1e5));
  }
  return part;
}

Json Figures(const MeshTube& tube) {
  return Json{
      {"radius_m", tube.radius_m}, {"length_m", tube.length_m},           {"rms_m", tube.rms_m},
      {"max_m", tube.max_m},       {"radius_spread", tube.radius_spread}, {"hollow", tube.hollow}};
}

std::string ResidualText(const MeshTube& tube) {
  char text[160];
  std::snprintf(text, sizeof text,
                "outer wall off this tube: rms %.3f mm, largest %.3f mm, radius spread %.1f %%",
                1e3 * tube.rms_m, 1e3 * tube.max_m, 100.0 * tube.radius_spread);
  return text;
}

std::string Headline(const Part& part, const MeshTube& tube) {
  char text[128];
  std::snprintf(text, sizeof text, ": radius %.2f mm, length %.1f mm%s", 1e3 * tube.radius_m,
                1e3 * tube.length_m, tube.hollow ? ", hollow" : "");
  return part.name + text;
}

std::string PartText(const Part& part, const MeshTube& tube, const ImportOptions& given) {
  Part copy = part;
  return "# Imported from " + std::filesystem::path(given.mesh).filename().string() +
         (tube.hollow ? " (hollow; the outer wall counts).\n# " : ".\n# ") + ResidualText(tube) +
         "\n# Material of " + given.material +
         (given.mass_kg > 0.0 ? ".\n"
                              : ". mass_kg is an estimate from its wall: weigh your tube.\n") +
         WriteToml([&copy](ConfigVisitor& v) { copy.Visit(v); }, false);
}

int Import(const ImportOptions& given, const Common& common) {
  if (!common.out.ends_with(".toml")) {
    throw Error(ErrorKind::kUsage, "--out '" + common.out + "': a name ending in .toml is needed");
  }
  const Part material = LoadPart(given.material);
  Mesh mesh = ReadMesh(given.mesh);
  ScaleToMetres(mesh, given.units, given.mesh, "--units");
  const MeshTube tube = FindTubeOfMesh(mesh, common.parallelism());
  if (tube.verdict != MeshVerdict::kTube) {
    throw Error(ErrorKind::kBadData, given.mesh + ": this is no tube: " + tube.reason);
  }
  const Part part = PartOf(tube, given, material);
  // Reads back as the checks of part files see it.
  const Json fields = PartToJson(part);
  PartFromJson(JsonView(fields, given.mesh));
  CheckGripperTakes(part, given.mesh);
  const std::string picture = std::filesystem::path(common.out).replace_extension(".png").string();
  // Neither file without the other: the picture is renamed when the part lies ready.
  WriteThroughTemporary(common.out, [&](const std::string& temporary) {
    WriteFileAtomically(temporary, PartText(part, tube, given));
    DrawTubeFit({tube.wall, tube.line, tube.radius_m, Headline(part, tube)}, picture);
  });
  if (common.json) {
    Json out = Figures(tube);
    out["part"] = fields;
    out["picture"] = picture;
    std::printf("%s\n", out.dump(2).c_str());
    return 0;
  }
  std::printf("%s, %zu nodes; %s\n", Headline(part, tube).c_str(), part.centerline_m.size() / 3,
              ResidualText(tube).c_str());
  Say(common, "wrote " + common.out + " and " + picture);
  return 0;
}

}  // namespace

void AddPartVerb(CLI::App& app, Common& common) {
  CLI::App* part = app.add_subcommand("part",
                                      "Example: tubetwin part import my_tube.stl --units mm --out "
                                      "my_tube.toml\n\nA user's own tube.");
  part->require_subcommand(1);
  auto file = std::make_shared<std::string>();
  CLI::App* check = part->add_subcommand(
      "check",
      "Example: tubetwin part check my_tube.toml\n\nReads a part, checks it, says what it "
      "means for sensor and gripper.");
  check->add_option("part", *file, "Part file (TOML) or name")->required();
  AddCommonOptions(*check, common, "", false);
  check->callback(
      [file, &common] { common.action = [file, &common] { return CheckPart(*file, common); }; });

  auto given = std::make_shared<ImportOptions>();
  CLI::App* import = part->add_subcommand(
      "import",
      "Example: tubetwin part import my_tube.stl --units mm --out my_tube.toml\n\n"
      "Finds axis and outer radius of a tube's mesh and writes a part file, with a picture\n"
      "(my_tube.png) beside it. What is no tube is refused with the reason. Weight and friction\n"
      "are the material's: check them in the file.");
  import->add_option("mesh", given->mesh, "STL, OBJ or PLY file")->required();
  import->add_option("--units", given->units, "Unit of the file; needed when metres cannot be")
      ->check(CLI::IsMember(MeshUnits()));
  import->add_option("--name", given->name, "Name of the part; default: the file's");
  import->add_option("--material", given->material,
                     "Part (name or file) whose kind, friction, stiffness, density and colour it "
                     "has; default pvc_a");
  import->add_option("--mass", given->mass_kg, "Mass of one tube in kg; default: an estimate")
      ->check(CLI::Range(0.001, 5.0));
  AddCommonOptions(*import, common, "Part file to write (.toml)", true);
  import->callback(
      [given, &common] { common.action = [given, &common] { return Import(*given, common);
};
}  // namespace tubetwin
);
}

}  // namespace tubetwin

#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "models/mesh/mesh.h"
#include "models/part_fit/part_fit.h"
#include "perception/part_import/tube_of_mesh.h"
#include "twin/app/common.h"
#include "twin/app/part/part_file.h"
#include "twin/render/tube_fit_picture.h"
#include "twin/round/scenario_check.h"

namespace tubetwin {
namespace {

/// One line a finding, and one for what to do.
void PrintFinding(const Finding& finding) {
  Print("%-10s  %s: %s; %s\n", ToString(finding.verdict), finding.what.c_str(),
        finding.found.c_str(), finding.allowed.c_str());
  if (!finding.remedy.empty()) Print("            -> %s\n", finding.remedy.c_str());
}

/// What a part is judged by (PartFitOf).
UsedKeys PartKeys() {
  return {"cell.model",
          "scan.resolution",
          "cycle.grip_force_N",
          "cycle.transfer_acceleration_m_s2",
          "physics.pad_friction",
          "physics.wrench_noise_counts",
          "physics.wrench_bias_walk_N"};
}

/// By the cell that --set asks for.
std::vector<Finding> Judged(const Part& part, const Common& common) {
  const Scenario scenario = LoadScenario({}, common);
  return JudgePart(part, PartFitOf(scenario, ScenarioModel(scenario)));
}

int CheckPart(const std::string& file, const Common& common) {
  const Part part = LoadPart(file);
  const std::vector<Finding> findings = Judged(part, common);
  const Finding::Verdict worst = WorstOf(findings);
  if (common.json) {
    PrintJson({{"part", PartToJson(part)},
               {"verdict", ToString(worst)},
               {"findings", FindingsJson(findings)}});
  } else {
    Print("%s: %s, radius %s m, length %s m, %s kg\n", part.name.c_str(), part.kind.c_str(),
          Number(part.radius_m).c_str(), Number(part.length_m).c_str(),
          Number(part.mass_kg).c_str());
    for (const Finding& finding : findings) PrintFinding(finding);
  }
  return worst == Finding::Verdict::kImpossible ? static_cast<int>(ErrorKind::kBadData) : 0;
}

Json Figures(const MeshTube& tube) {
  return Json{{"radius_m", tube.radius_m},
              {"length_m", tube.length_m},
              {"rms_m", tube.rms_m},
              {"max_m", tube.max_m},
              {"radius_spread", tube.radius_spread},
              {"min_radius_m", tube.min_radius_m},
              {"max_radius_m", tube.max_radius_m},
              {"other_radius_share", tube.other_radius_share},
              {"hollow", tube.hollow}};
}

std::string Headline(const Part& part, const MeshTube& tube) {
  char text[128];
  std::snprintf(text, sizeof text, ": radius %.2f mm, length %.1f mm%s", 1e3 * tube.radius_m,
                1e3 * tube.length_m, tube.hollow ? ", hollow" : "");
  return part.name + text;
}

void PrintImported(const ImportedPart& imported, const MeshTube& tube,
                   const std::vector<Finding>& findings) {
  const Part& part = imported.part;
  Print("%s, %zu nodes; %s\n", Headline(part, tube).c_str(), part.centerline_m.size() / 3,
        ResidualText(tube).c_str());
  Print("mass %s kg: %s\n", Number(part.mass_kg).c_str(), imported.mass_source.c_str());
  if (part.is_hose()) {
    Print("bending stiffness %s N m2, %s to %s: %s\n", Number(part.bending_stiffness_Nm2).c_str(),
          Number(part.bending_stiffness_range_Nm2[0]).c_str(),
          Number(part.bending_stiffness_range_Nm2[1]).c_str(), imported.stiffness_source.c_str());
  }
  for (const Finding& finding : findings) PrintFinding(finding);
}

int Import(const PartImport& given, const Common& common) {
  if (!common.out.ends_with(".toml")) {
    throw Error(ErrorKind::kUsage, "--out '" + common.out + "': a name ending in .toml is needed");
  }
  const Part material = LoadPart(given.material);
  CheckImportOptions(given, material.is_hose());
  Mesh mesh = ReadMesh(given.mesh);
  ScaleToMetres(mesh, given.units, given.mesh, "--units");
  const MeshTube tube = FindTubeOfMesh(mesh, common.parallelism());
  if (tube.verdict != MeshVerdict::kTube) {
    throw Error(ErrorKind::kBadData, given.mesh + ": this is no tube: " + tube.reason);
  }
  const ImportedPart imported = PartOfTube(tube, given, material);
  const Part& part = imported.part;
  // Reads back as the checks of part files see it.
  const Json fields = PartToJson(part);
  PartFromJson(JsonView(fields, given.mesh));
  const std::vector<Finding> findings = Judged(part, common);
  const std::string picture = std::filesystem::path(common.out).replace_extension(".png").string();
  // Neither file without the other: the picture is renamed when the part lies ready.
  WriteFileInPieces(common.out, [&](OutputFile& out) {
    out.Write(PartFileText(imported, tube, given));
    DrawTubeFit({tube.wall, tube.line, tube.radius_m, Headline(part, tube)}, picture);
  });
  if (common.json) {
    Json out = Figures(tube);
    out["part"] = fields;
    out["mass_source"] = imported.mass_source;
    out["stiffness_source"] = imported.stiffness_source;
    out["findings"] = FindingsJson(findings);
    out["picture"] = picture;
    PrintJson(out);
    return 0;
  }
  PrintImported(imported, tube, findings);
  Say(common, "wrote " + common.out + " and " + picture);
  return 0;
}

void AddImport(CLI::App& part, Common& common) {
  auto given = std::make_shared<PartImport>();
  CLI::App* verb = part.add_subcommand(
      "import",
      "Example: tubetwin part import my_tube.stl --units mm --out my_tube.toml\n"
      "Example: tubetwin part import my_hose.stl --units mm --material hose_b --mass 0.18 "
      "--sag-mm 31 --overhang-m 0.35 --out my_hose.toml\n\n"
      "Finds axis and outer radius of a tube's mesh and writes a part file, with a picture\n"
      "(my_tube.png) beside it. What is no tube is refused with the reason. Friction is the\n"
      "material's: check it in the file. Clamp a hose level at an edge so that a length\n"
      "hangs over: how far its end sags gives the bending stiffness.");
  verb->add_option("mesh", given->mesh, "STL, OBJ or PLY file")->required();
  verb->add_option("--units", given->units, "Unit of the file; needed when metres cannot be")
      ->check(CLI::IsMember(LengthUnits()));
  verb->add_option("--name", given->name, "Name of the part; default: the file's");
  verb->add_option("--material", given->material,
                   "Part (name or file) whose kind, friction, stiffness, density and colour it "
                   "has; default pvc_a");
  verb->add_option("--mass", given->mass_kg, "Mass of one tube in kg; default: an estimate")
      ->check(CLI::Range(kMinMass_kg, kMaxMass_kg));
  verb->add_option("--density", given->density_kg_m3,
                   "Density in kg/m3, for the mass of what the mesh encloses or of --wall-mm")
      ->check(CLI::Range(10.0, 25000.0));
  verb->add_option("--wall-mm", given->wall_mm, "Thickness of the wall, where the mesh has none")
      ->check(CLI::Range(0.01, 40.0));
  verb->add_option("--sag-mm", given->sag_mm,
                   "How far the end of a hose sags, clamped level; once or twice")
      ->check(CLI::Range(0.1, 2000.0))
      ->allow_extra_args(false);
  verb->add_option("--overhang-m", given->overhang_m,
                   "Length that hung over the edge; one for each --sag-mm")
      ->check(CLI::Range(0.02, 2.0))
      ->allow_extra_args(false);
  verb->add_option("--sag-error-mm", given->sag_error_mm,
                   "By how much a sag may be misread; default 1")
      ->check(CLI::Range(0.01, 50.0));
  AddCommonOptions(*verb, common, PartKeys(), "Part file to write (.toml)", true);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return Import(*given, common); }; });
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
      "Example: tubetwin part check my_tube.toml\n\nReads a part, checks it, says what gripper, "
      "wrist sensor and scanner make of it:\nok, doubtful or impossible (exit code 65), with the "
      "remedy.");
  check->add_option("part", *file, "Part file (TOML) or name")->required();
  AddCommonOptions(*check, common, PartKeys(), "", false);
  check->callback(
      [file, &common] { common.action = [file, &common] { return CheckPart(*file, common); }; });
  AddImport(*part, common);
}

}  // namespace tubetwin

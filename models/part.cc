#include "models/part.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/frames.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "models/files/embedded.h"
#include "models/files/json_visitor.h"

namespace tubetwin {
namespace {

constexpr const char kFolder[] = "parts/", kTomlSuffix[] = ".toml";
constexpr double kHookRadius_m = 0.05, kShortestEnd_m = 0.02;

// Name of a shipped part from the path of its file; empty for other files.
std::string NameOfText(const EmbeddedText& text) {
  if (!text.path.starts_with(kFolder) || !text.path.ends_with(kTomlSuffix)) return "";
  const std::size_t folder = sizeof kFolder - 1, suffix = sizeof kTomlSuffix - 1;
  return std::string(text.path.substr(folder, text.path.size() - folder - suffix));
}

void CheckOrder(const std::vector<double>& range, const char* key, ErrorKind kind,
                const std::string& source) {
  if (range[0] <= range[1]) return;
  throw Error(kind, source + ": " + key + " is [" + Number(range[0]) + ", " + Number(range[1]) +
                        "]; the first number must not be above the second");
}

// A fixed shape is a line that physics can build.
void CheckCenterline(const Part& part, ErrorKind kind, const std::string& source) {
  constexpr double kLargestDifference = 0.02;
  const std::size_t numbers = part.centerline_m.size();
  if (part.shape != "fixed") {
    if (numbers == 0) return;
    throw Error(kind, source + ": centerline_m is given, but shape is \"" + part.shape +
                          "\"; only \"fixed\" has one");
  }
  if (numbers < 6 || numbers % 3 != 0 || numbers > 3 * kMaxShapePoints) {
    throw Error(kind, source + ": centerline_m has " + std::to_string(numbers) +
                          " numbers; shape \"fixed\" needs x y z of 2 to 200 points");
  }
  const Polyline line = part.centerline();
  for (std::size_t i = 1; i < line.size(); ++i) {
    if ((line[i] - line[i - 1]).norm() >= kMinShapePiece_m) continue;
    throw Error(kind, source + ": centerline_m: points " + std::to_string(i - 1) + " and " +
                          std::to_string(i) + " are closer than 1 mm");
  }
  if (std::abs(Length(line) / part.length_m - 1.0) > kLargestDifference) {
    throw Error(kind, source + ": centerline_m is " + Number(Length(line)) +
                          " m long, but length_m is " + Number(part.length_m) +
                          "; they may differ by 2 %");
  }
}

// What no single field can say.
void CheckPart(const Part& part, ErrorKind kind, const std::string& source) {
  CheckOrder(part.friction_range, "friction_range", kind, source);
  CheckOrder(part.bending_stiffness_range_Nm2, "bending_stiffness_range_Nm2", kind, source);
  CheckOrder(part.loss_factor_range, "loss_factor_range", kind, source);
  CheckOrder(part.bends, "bends", kind, source);
  CheckOrder(part.bend_deg, "bend_deg", kind, source);
  CheckOrder({part.search.extra_min, part.search.extra_max}, "search.extra_min, extra_max", kind,
             source);
  if (part.name.empty()) throw Error(kind, source + ": name is empty; a part needs one");
  if (!IsPlainUtf8(part.name)) {
    throw Error(kind, source + ": name is '" + Printable(part.name) +
                          "'; allowed: UTF-8 without line breaks and other control characters");
  }
  if (!IsPlainUtf8(part.source)) {
    throw Error(kind, source + ": source is '" + Printable(part.source) +
                          "'; allowed: UTF-8 without line breaks and other control characters");
  }
  if (part.length_m < 4.0 * part.radius_m) {
    throw Error(kind, source + ": length_m " + Number(part.length_m) + " is below four radii (" +
                          Number(4.0 * part.radius_m) + "); that is no tube");
  }
  CheckCenterline(part, kind, source);
  const double hooks_m =
      2.0 * (kHookRadius_m * Radians(part.bend_deg[1]) + kShortestEnd_m) + kShortestEnd_m;
  if (part.shape == "hooks" && part.length_m < hooks_m) {
    throw Error(kind, source + ": length_m " + Number(part.length_m) +
                          " is too short for hooks of " + Number(part.bend_deg[1]) +
                          " degrees; at least " + Number(hooks_m));
  }
}

Part Shipped(const EmbeddedText& text) {
  ConfigSource source;
  source.AddText(std::string(text.text), std::string(text.path));
  Part part;
  source.ReadInto(part);
  CheckPart(part, ErrorKind::kConfig, std::string(text.path));
  return part;
}

}  // namespace

double Part::albedo() const {
  return std::accumulate(colour_rgb.begin(), colour_rgb.end(), 0.0) /
         static_cast<double>(colour_rgb.size());
}

void Part::Visit(ConfigVisitor& v) {
  v.Field("name", "what the part is called", name);
  v.Choice("kind", "rigid: one body; hose: a bending chain of links", kind, {"rigid", "hose"});
  v.Field("radius_m", "outer radius", radius_m, {0.003, 0.04});
  v.Field("length_m", "length along the centerline, from tip to tip", length_m, {0.05, 2.0});
  v.Field("mass_kg", "mass of one tube", mass_kg, {kMinMass_kg, kMaxMass_kg});
  v.Field("friction", "nominal friction, tube on tube, on the bin and on the tray", friction,
          {0.01, 3.0});
  v.Field("friction_range", "friction is drawn between these", friction_range, 2, {0.01, 3.0});
  v.Field("bending_stiffness_Nm2", "E times I, hoses only", bending_stiffness_Nm2,
          {kMinStiffness_Nm2, kMaxStiffness_Nm2});
  v.Field("bending_stiffness_range_Nm2", "bending stiffness is drawn between these",
          bending_stiffness_range_Nm2, 2, {kMinStiffness_Nm2, kMaxStiffness_Nm2});
  v.Field("loss_factor", "share of elastic energy that a swing loses per radian, hoses only",
          loss_factor, {0.0, 2.0});
  v.Field("loss_factor_range", "loss factor is drawn between these", loss_factor_range, 2,
          {0.0, 2.0});
  v.Field("links", "rigid links of a hose", links, {8, 40});
  v.Choice("shape",
           "how random shapes are drawn: arcs (planar bends), hooks (a bend near each end), "
           "polyline (corners), fixed (centerline_m)",
           shape, {"arcs", "hooks", "polyline", "fixed"});
  v.Field("centerline_m", "shape fixed: x y z of one point after another", centerline_m, 0,
          {-3.0, 3.0});
  v.Field("bends", "number of bends, from and to", bends, 2, {1, 20});
  v.Field("bend_deg", "angle of one bend, from and to", bend_deg, 2, {0, 170});
  v.Field("colour_rgb", "colour in pictures, 0 to 1; the mean is what the scanner's light meets",
          colour_rgb, 3, {0, 1});
  v.Field("gloss", "share of points that the scanner loses where the surface mirrors its light",
          gloss, {0, 1});
  v.Field("source",
          "where mass, friction, stiffness and shape come from, and what was fitted to what: shown "
          "in reports",
          source);
  v.Section("search", "how often another tube comes along, as the search among motions takes it",
            search);
}

void PartSearch::Visit(ConfigVisitor& v) {
  v.Field("fitted_to",
          "name of the part with which these numbers were measured; for other parts they are a "
          "default, not measured",
          fitted_to);
  v.Field("extra_per_m",
          "probability that another tube comes along, per metre of predicted displacement beyond "
          "extra_quiet_m (fitted to hose_b by 164 lifts; default for other parts, not measured)",
          extra_per_m, {0.0, 100.0});
  v.Field("extra_quiet_m", "displacement in metres that brings none along", extra_quiet_m,
          {0.0, 10.0});
  v.Field("extra_min", "smallest such probability", extra_min, {0.0, 1.0});
  v.Field("extra_max", "largest such probability", extra_max, {0.0, 1.0});
  v.Field("extra_prior_samples", "so many samples does that probability count as, of hoses",
          extra_prior_samples, {0.0, 1000.0});
  v.Field("extra_after_shedding", "that probability after a motion that sheds by tilting",
          extra_after_shedding, {0.0, 1.0});
}

Polyline Part::centerline() const {
  Polyline line;
  for (std::size_t i = 0; i + 2 < centerline_m.size(); i += 3) {
    line.push_back({centerline_m[i], centerline_m[i + 1], centerline_m[i + 2]});
  }
  return line;
}

std::vector<std::string> PartNames() {
  std::vector<std::string> names;
  for (const EmbeddedText& text : EmbeddedTexts()) {
    if (const std::string name = NameOfText(text); !name.empty()) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

Part LoadPart(const std::string& name_or_path) {
  if (name_or_path.ends_with(kTomlSuffix)) {
    ConfigSource source;
    source.AddFile(name_or_path);
    Part part;
    source.ReadInto(part);
    CheckPart(part, ErrorKind::kConfig, name_or_path);
    return part;
  }
  for (const EmbeddedText& text : EmbeddedTexts()) {
    if (NameOfText(text) == name_or_path && !name_or_path.empty()) return Shipped(text);
  }
  const std::string ending = LowerCase(std::filesystem::path(name_or_path).extension().string());
  if (ending == ".stl" || ending == ".obj" || ending == ".ply" || ending == ".step") {
    throw Error(ErrorKind::kBadData, Printable(name_or_path) +
                                         ": is a mesh; allowed: a part's name or a part file "
                                         "(.toml)\n(tubetwin part import MESH --out P.toml makes "
                                         "one)");
  }
  std::error_code ignored;  // What cannot be asked for is no file.
  if (std::filesystem::is_regular_file(name_or_path, ignored)) {
    throw Error(ErrorKind::kBadData, Printable(name_or_path) +
                                         ": is no part file, whose name ends in .toml; known "
                                         "parts: " +
                                         Join(PartNames()));
  }
  std::error_code code;
  const auto there = std::filesystem::status(name_or_path, code).type();
  if (code == std::errc::filename_too_long || there == std::filesystem::file_type::fifo ||
      there == std::filesystem::file_type::directory ||
      there == std::filesystem::file_type::character) {
    ReadFile(name_or_path);  // Throws: it says what is there instead.
  }
  throw Error(ErrorKind::kMissing, "no part is named '" + Printable(name_or_path.substr(0, 80)) +
                                       "'; nearest is '" + NearestName(name_or_path, PartNames()) +
                                       "'; known: " + Join(PartNames()) +
                                       ", or the path of a part file (.toml)");
}

Part PartFromJson(const JsonView& view) {
  if (view.IsString()) {
    try {
      return LoadPart(view.AsString());
    } catch (const Error& error) {
      // A missing name keeps its kind, and says which file asked for it.
      throw Error(error.kind(), view.source() + ": part: " + error.what());
    }
  }
  if (!view.IsObject()) view.Fail("must be a part's name or an object with its fields");
  Part part;
  ReadJsonInto(view, [&part](ConfigVisitor& v) { part.Visit(v); });
  CheckPart(part, ErrorKind::kBadData, view.source() + ": part");
  return part;
}

Json PartToJson(const Part& part) {
  const auto all_fields = [](Part copy) {
    return WriteJson([&copy](ConfigVisitor& v) { copy.Visit(v); });
  };
  Json fields = all_fields(part);
  const std::vector<std::string> shipped = PartNames();
  if (std::find(shipped.begin(), shipped.end(), part.name) != shipped.end() &&
      all_fields(LoadPart(part.name)) == fields) {
    return part.name;
  }
  return fields;
}

}  // namespace tubetwin

#include "models/scanner_spec.h"

#include <algorithm>
#include <cstdio>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/files/file_schema.h"
#include "models/model_file.h"

namespace tubetwin {
namespace {

/// Camera (side -1) or projector (side +1) in the housing, each turned towards the other.
RigidTransform AperturePose(const ScannerSpec& spec, double side) {
  return MakeTransform(RotY(-side * Radians(spec.toe_in_deg)),
                       Vector3(0.5 * side * spec.baseline_m, 0, 0));
}

struct ScannerEntry {
  ScannerSpec spec;
  std::array<double, 2> range_m = {kNotGiven, kNotGiven}, soft_range_m = {kNotGiven, kNotGiven};
  std::array<double, 2> projector_deg = {kNotGiven, kNotGiven};
  std::array<double, 3> housing_m = {kNotGiven, kNotGiven, kNotGiven};
  std::array<double, 3> inertia_box_m = {kNotGiven, kNotGiven, kNotGiven};

  ScannerEntry() {
    spec.focal_px = spec.baseline_m = spec.toe_in_deg = spec.sweet_spot_m = kNotGiven;
    spec.near_half_m = spec.near_width_m = spec.far_half_m = spec.far_width_m = kNotGiven;
    spec.sigma_m = spec.scan_time_s = spec.mass_kg = spec.mass_centre_m = kNotGiven;
  }
  void Visit(ConfigVisitor& v) {
    const Range distance{0.05, 20.0};
    v.Field("name", "for messages and reports", spec.name);
    v.Field("full_width", "columns of the full image", spec.full_width, {16, 16384});
    v.Field("full_height", "rows of the full image", spec.full_height, {16, 16384});
    v.Field("resolutions", "COLUMNSxROWS that a scan may have, the default first",
            spec.resolutions);
    v.Field("focal_px", "focal length in pixels of the full image", spec.focal_px, {10, 1e5});
    v.Field("baseline_m", "camera to projector", spec.baseline_m, {0.01, 5.0});
    v.Field("toe_in_deg", "camera towards projector, the projector alike", spec.toe_in_deg,
            {0.0, 60.0});
    v.Field("sweet_spot_m", "distance where it is best", spec.sweet_spot_m, distance);
    v.Field("range_m", "nearest and farthest distance of the data sheet", range_m, distance);
    v.Field("soft_range_m", "no points come back from beyond", soft_range_m, distance);
    v.Field("near_half_m", "distance before range_m where half of the points come back",
            spec.near_half_m, distance);
    v.Field("near_width_m", "of that drop", spec.near_width_m, {1e-4, 5.0});
    v.Field("far_half_m", "distance beyond range_m where half of the points come back",
            spec.far_half_m, distance);
    v.Field("far_width_m", "of that drop", spec.far_width_m, {1e-4, 5.0});
    v.Field("projector_deg", "whole angles that the projector lights, along and across",
            projector_deg, {1.0, 160.0});
    v.Field("sigma_m", "one sigma of depth at the sweet spot, normal incidence", spec.sigma_m,
            {1e-7, 0.1});
    v.Field("scan_time_s", "from trigger to cloud", spec.scan_time_s, {0.001, 60.0});
    v.Field("mass_kg", "with what holds it", spec.mass_kg, {0.01, 100.0});
    v.Field("mass_centre_m", "its centre of mass before the housing's front, so below 0",
            spec.mass_centre_m, {-5.0, 5.0});
    v.Field("inertia_box_m", "sides of the box whose inertia it has, as housing_m", inertia_box_m,
            {0.001, 5.0});
    v.Field("housing_m", "its length along the baseline, across, along the line of sight",
            housing_m, {0.001, 5.0});
  }
};

bool ParseSize(const std::string& text, ScanSize& size) {
  int end = 0;
  return std::sscanf(text.c_str(), "%5dx%5d%n", &size.width, &size.height, &end) == 2 &&
         end == static_cast<int>(text.size()) && size.width >= 16 && size.height >= 16;
}

void Check(const ScannerSpec& spec, const std::string& path) {
  if (spec.full_width == 0 || spec.full_height == 0) {
    RefuseFile(path, "full_width and full_height are needed, in pixels");
  }
  if (spec.resolutions.empty())
    RefuseFile(path, "resolutions is empty; at least one size is needed");
  for (const std::string& text : spec.resolutions) {
    ScanSize size;
    if (!ParseSize(text, size)) {
      RefuseFile(path,
                 "resolutions: '" + text + "' is no size; COLUMNSxROWS is needed, as in 1032x772");
    }
  }
  if (spec.range_min_m >= spec.range_max_m || spec.soft_min_m >= spec.soft_max_m ||
      spec.soft_min_m > spec.range_min_m || spec.soft_max_m < spec.range_max_m) {
    RefuseFile(path, "range_m [" + Number(spec.range_min_m) + ", " + Number(spec.range_max_m) +
                         "] must rise and lie within soft_range_m [" + Number(spec.soft_min_m) +
                         ", " + Number(spec.soft_max_m) + "]");
  }
}

}  // namespace

RigidTransform HousingPose(const ScannerSpec& spec) { return AperturePose(spec, -1).inverse(); }

RigidTransform ProjectorPose(const ScannerSpec& spec) {
  return HousingPose(spec) * AperturePose(spec, +1);
}

ScanSize SizeOfScan(const ScannerSpec& spec, const std::string& resolution) {
  const std::string& text = resolution.empty() ? spec.resolutions.front() : resolution;
  const auto& known = spec.resolutions;
  ScanSize size;
  if (std::find(known.begin(), known.end(), text) == known.end() || !ParseSize(text, size)) {
    throw Error(ErrorKind::kConfig, "scan.resolution: '" + text + "' is no size of the " +
                                        spec.name + "; allowed: " + Join(known));
  }
  return size;
}

Json ScannerFileSchema() {
  ScannerEntry entry;
  Json schema = TableSchema([&entry](ConfigVisitor& v) { entry.Visit(v); });
  schema["properties"]["resolutions"]["minItems"] = 1;
  return schema;
}

ScannerSpec ReadScanner(const ModelFile& file) {
  ScannerEntry entry;
  file.Source().ReadInto(entry);
  RequireGiven([&](ConfigVisitor& v) { entry.Visit(v); }, file.path);
  ScannerSpec& spec = entry.spec;
  spec.range_min_m = entry.range_m[0];
  spec.range_max_m = entry.range_m[1];
  spec.soft_min_m = entry.soft_range_m[0];
  spec.soft_max_m = entry.soft_range_m[1];
  spec.projector_width_deg = entry.projector_deg[0];
  spec.projector_height_deg = entry.projector_deg[1];
  spec.housing_x_m = entry.housing_m[0];
  spec.housing_y_m = entry.housing_m[1];
  spec.housing_z_m = entry.housing_m[2];
  spec.inertia_box_m =
      Vector3(entry.inertia_box_m[0], entry.inertia_box_m[1], entry.inertia_box_m[2]);
  Check(spec, file.path);
  return spec;
}

}  // namespace tubetwin

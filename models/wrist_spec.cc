#include "models/wrist_spec.h"

#include "models/files/file_schema.h"
#include "models/model_file.h"

namespace tubetwin {
namespace {

constexpr std::size_t kAxes = 6;

struct WristEntry {
  WristSpec spec;

  WristEntry() {
    spec.range.fill(kNotGiven);
    spec.count.fill(kNotGiven);
    spec.corner_Hz = spec.mass_kg = spec.inertia_side_m = spec.radius_m = kNotGiven;
  }
  void Visit(ConfigVisitor& v) {
    static_assert(std::tuple_size_v<decltype(spec.range)> == kAxes);
    v.Field("name", "for messages and reports", spec.name);
    v.Field("range", "largest reading of Fx Fy Fz in N, Tx Ty Tz in N m", spec.range, {1e-3, 1e6});
    v.Field("count", "one step of a reading, likewise", spec.count, {1e-9, 1e3});
    v.Field("corner_Hz", "of its low-pass", spec.corner_Hz, {0.1, 1e5});
    v.Field("mass_kg", "with its mounting plates", spec.mass_kg, {1e-3, 100.0});
    v.Field("inertia_side_m", "side of the square block, as high as it, whose inertia it has",
            spec.inertia_side_m, {1e-3, 1.0});
    v.Field("radius_m", "of its body", spec.radius_m, {1e-3, 1.0});
  }
};

}  // namespace

Json WristFileSchema() {
  WristEntry entry;
  return TableSchema([&entry](ConfigVisitor& v) { entry.Visit(v); });
}

WristSpec ReadWrist(const ModelFile& file) {
  WristEntry entry;
  file.Source().ReadInto(entry);
  RequireGiven([&](ConfigVisitor& v) { entry.Visit(v); }, file.path);
  return entry.spec;
}

}  // namespace tubetwin

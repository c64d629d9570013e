#include "twin/report/front/study_facts.h"

#include <cstdio>

#include "models/base/error.h"
#include "models/base/text.h"
#include "models/cell_model.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

constexpr const char* kRoles[] = {"arm", "gripper", "wrist", "scanner"};

std::string Millimetres(double metres) { return PlainNumber(1e3 * metres); }

/// "0.2 to 0.5"; a dash for anything but two numbers.
std::string RangeText(const Json& range) {
  if (!range.is_array() || range.size() != 2 || !range[0].is_number()) return kDash;
  return PlainNumber(range[0]) + " to " + PlainNumber(range[1]);
}
std::string RangeText(const std::vector<double>& range) { return RangeText(Json(range)); }

std::string NumberText(const Json& value, double scale = 1.0) {
  return value.is_number() ? PlainNumber(scale * value.get<double>()) : kDash;
}

std::string TextOr(const Json& value, const std::string& other) {
  return value.is_string() && !value.get<std::string>().empty() ? value.get<std::string>() : other;
}

std::string PartText(const StudySetup& setup) {
  if (!setup.part) return kDash;
  const Part& part = *setup.part;
  return part.name + ", " + (part.is_hose() ? "flexible" : "rigid") + ", diameter " +
         Millimetres(2.0 * part.radius_m) + " mm, length " + Millimetres(part.length_m) + " mm, " +
         PlainNumber(1e3 * part.mass_kg) + " g";
}

std::string BinText(const StudySetup& setup) {
  std::array<double, 3> size_m = Bin().size_m;
  const Json given = KeyOf(setup, "bin/size_m");
  if (setup.bin) {
    size_m = setup.bin->size_m;
  } else if (given.is_array() && given.size() == 3) {
    size_m = given.get<std::array<double, 3>>();
  } else if (setup.config.is_null() || !TextOr(KeyOf(setup, "bin/mesh"), "").empty() ||
             !TextOr(KeyOf(setup, "pile/file"), "").empty()) {
    return kDash;  // A file says it that is not here.
  }
  return Millimetres(size_m[0]) + " x " + Millimetres(size_m[1]) + " mm inside, walls " +
         Millimetres(size_m[2]) + " mm";
}

std::string StartText(const StudySetup& setup) {
  const std::string parts = std::to_string(setup.tubes) + " parts a bin";
  if (const std::string file = TextOr(KeyOf(setup, "pile/file"), ""); !file.empty()) {
    return parts + ", as in " + file;
  }
  return parts + ", " + TextOr(KeyOf(setup, "pile/arrangement"), kDash);
}

std::string CellText(const StudySetup& setup) {
  if (setup.config.is_null()) return kDash;
  // Results of before 0.3 do not say it: there was one cell.
  const std::string name = TextOr(KeyOf(setup, "cell/model"), "leao2020");
  try {
    const CellModel model = LoadCellModel(name);
    const bool flange = model.layout.scanner_mount == CellLayout::ScannerMount::kFlange;
    return model.name + ": " + model.arm.name + " arm, " + model.gripper.name + " gripper, " +
           model.wrist.name + " force/torque sensor, " + model.scanner.name +
           (flange ? " on the flange" : " fixed over the bin");
  } catch (const Error&) {
    return "as in " + name;  // A user's file that is no longer where it was.
  }
}

std::string DevicesText(const StudySetup& setup) {
  if (setup.config.is_null()) return kDash;
  if (IsSimulated(setup)) return "all simulated";
  std::vector<std::string> devices;
  for (const char* role : kRoles) {
    const std::string driver =
        TextOr(KeyOf(setup, "cell/" + std::string(role) + "/driver"), "twin");
    devices.push_back(std::string(role) + " " + (driver == "twin" ? "simulated" : driver));
  }
  return Join(devices);
}

std::string ScanText(const StudySetup& setup) {
  const Json overhead = KeyOf(setup, "scan/overhead_m");
  const std::string size = TextOr(KeyOf(setup, "scan/resolution"), kDash);
  if (overhead.is_number() && overhead.get<double>() > 0.0) {
    return "one from " + PlainNumber(overhead) + " m over the bin, " + size + " points";
  }
  const Json fixed = KeyOf(setup, "calibration/X_BS");
  if (fixed.is_array() && !fixed.empty()) return "one from the stand, " + size + " points";
  const Json views = KeyOf(setup, "scan/views");
  if (!views.is_number()) return kDash;
  const bool all = KeyOf(setup, "scan/rescan_all") == true;
  return NumberText(views) + " views, " + size + " points; later looks of a round " +
         (all ? "all of them again" : "only where something may have moved");
}

std::string FrictionText(const StudySetup& setup, bool drawn) {
  const Json given = KeyOf(setup, "physics/tube_friction");
  if (given.is_array() && given.size() == 2) return RangeText(given);
  if (!setup.part) return kDash;
  return drawn ? RangeText(setup.part->friction_range) : PlainNumber(setup.part->friction);
}

std::string StiffnessText(const StudySetup& setup, bool drawn) {
  if (!setup.part) return kDash;
  if (!setup.part->is_hose()) return "none: rigid";
  const Json given = KeyOf(setup, "physics/bending_stiffness_Nm2");
  const std::string text = given.is_array() && given.size() == 2 ? RangeText(given)
                           : drawn ? RangeText(setup.part->bending_stiffness_range_Nm2)
                                   : PlainNumber(setup.part->bending_stiffness_Nm2);
  return text + " N m\xc2\xb2";
}

}  // namespace

std::string PlainNumber(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

bool IsSimulated(const StudySetup& setup) {
  for (const char* role : kRoles) {
    if (TextOr(KeyOf(setup, "cell/" + std::string(role) + "/driver"), "twin") != "twin") {
      return false;
    }
  }
  return true;
}

FactTexts StudyFacts(const StudySetup& setup) {
  return {{"Part", PartText(setup)},
          {"Bin", BinText(setup)},
          {"Start", StartText(setup)},
          {"Cell", CellText(setup)},
          {"Devices", DevicesText(setup)},
          {"Scans", ScanText(setup)},
          {"Pipeline", TextOr(KeyOf(setup, "profile"), kDash)}};
}

FactTexts StudyAssumptions(const StudySetup& setup) {
  if (!IsSimulated(setup)) {
    return {{"Physics", "those of the cell: its devices are not simulated, nothing was drawn"}};
  }
  const bool drawn = KeyOf(setup, "physics/randomize") != false;
  const auto key = [&](const char* name) { return KeyOf(setup, "physics/" + std::string(name)); };
  FactTexts out = {{"Physics", drawn ? "each round draws its own within the ranges below, evenly"
                                     : "nominal in every round, nothing is drawn"},
                   {"Friction, part on part and bin", FrictionText(setup, drawn)},
                   {"Bending stiffness", StiffnessText(setup, drawn)}};
  if (drawn) {
    out.insert(out.end(), {{"Friction of the pads", RangeText(key("pad_friction"))},
                           {"Mass", RangeText(key("mass_scale")) + " of the nominal"},
                           {"Scanner's noise",
                            RangeText(key("depth_noise_scale")) + " times the data sheet's"}});
  }
  out.insert(
      out.end(),
      {{"Hand-eye error", NumberText(key("hand_eye_error_m"), 1e3) + " mm, " +
                              NumberText(key("hand_eye_error_deg")) + "\xc2\xb0 (one sigma)"},
       {"Force sensor", "drift " + NumberText(key("wrench_bias_walk_N")) +
                            " N in ten minutes, cross talk " +
                            NumberText(key("wrench_cross_talk"), 100.0) + " %"},
       {"Speeds", "transfers " + NumberText(KeyOf(setup, "cycle/transfer_speed_m_s")) +
                      " m/s, lifting " + NumberText(KeyOf(setup, "planner/lift_speed_m_s")) +
                      " m/s, grip " + NumberText(KeyOf(setup, "cycle/grip_force_N")) + " N"}});
  return out;
}

FactTexts StudyGrounds(const StudySetup& setup) {
  FactTexts out;
  if (setup.part) {
    const Part& part = *setup.part;
    const std::string& fitted_to = part.search.fitted_to;
    out = {{"Part's numbers", part.source.empty()
                                  ? "their source is not said (key source of the part file)"
                                  : part.source},
           {"Search among motions", fitted_to == part.name
                                        ? "how often another comes along was fitted to this part"
                                        : "how often another comes along was fitted to " +
                                              fitted_to + ", not to this part"}};
  }
  if (!IsSimulated(setup)) return out;
  const bool drawn = KeyOf(setup, "physics/randomize") != false;
  const Json pads = KeyOf(setup, "physics/pad_friction");
  out.emplace_back(drawn ? "Drawn for each round" : "The same in every round",
                   "friction of parts " + FrictionText(setup, drawn) +
                       (drawn ? ", of the pads " + RangeText(pads) : "") + ", bending stiffness " +
                       StiffnessText(setup, drawn));
  return out;
}

const std::vector<std::string>& NotModelled() {
  static const std::vector<std::string> kList = {
      "Changing bin and tray, and stops by people or machines around the cell: the hours are those "
      "of picking.",
      "The arm's flexibility, play and temperature, cables, brakes, safety controllers. Its "
      "acceleration, jerk and masses are assumed where the vendor publishes none.",
      "How real parts differ beyond mass, friction and stiffness: dents, set, ovality, dirt, cut "
      "ends with a bore.",
      "Stick and adhesion: friction is dry and the same in all directions. Hoses bend, but do not "
      "stretch, shear or flatten.",
      "In the scanner: transparency, ambient light, warm-up; light that bounces is a share of "
      "false "
      "points, not traced."};
  return kList;
}

}  // namespace tubetwin

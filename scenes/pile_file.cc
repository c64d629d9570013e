#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/foreign/content.h"
#include "models/base/json.h"
#include "models/base/json_text.h"
#include "models/base/text.h"
#include "scenes/pile.h"
#include "scenes/pile_text.h"

namespace tubetwin {
namespace {

constexpr const char kDefaultPart[] = "leao2022";
constexpr std::array<double, 3> kDefaultBinSize_m = {0.80, 0.60, 0.20};
constexpr std::uint64_t kMaxPileBytes = std::uint64_t{64} << 20;
constexpr double kSameLength = 0.01;  // Relative; then a tube weighs what the part says.

// Mass of a tube of its own length.
double MassOf(const Part& part, const Polyline& line) {
  const double ratio = Length(line) / part.length_m;
  return std::abs(ratio - 1.0) < kSameLength ? part.mass_kg : part.mass_kg * ratio;
}

// Gives a tube what a part says beyond its shape.
void ApplyPart(const Part& part, PileTube& tube) {
  tube.radius_m = part.radius_m;
  tube.mass_kg = MassOf(part, tube.centerline_N);
  if (!part.is_hose()) tube.rest_centerline_N.reset();
  const int links = static_cast<int>(tube.centerline_N.size()) - 1;
  // A curve that was no chain of links becomes one; a degenerate one is left for ValidatePile.
  if (part.is_hose() && !tube.rest_centerline_N && links != part.links && links >= 1) {
    tube.centerline_N = ResampleCount(tube.centerline_N, part.links + 1);
  }
}

PileTube TubeFromJson(const JsonView& view, const Part& part) {
  PileTube tube;
  tube.id = CountFromJson(view.Field("id"));
  tube.centerline_N = view.Field("centerline_m").AsPolyline();
  const auto radius = view.Optional("radius_m");
  tube.radius_m = radius ? radius->AsNumber() : part.radius_m;
  const auto mass = view.Optional("mass_kg");
  tube.mass_kg = mass ? mass->AsNumber() : MassOf(part, tube.centerline_N);
  if (const auto rest = view.Optional("rest_centerline_m")) {
    tube.rest_centerline_N = rest->AsPolyline();
  }
  return tube;
}

/// Tells what of a file's own figures a part replaced.
class Replaced {
 public:
  Replaced(const PileOverrides& overrides, std::string source)
      : tell_(overrides.tell), source_(std::move(source)) {}

  void Compare(const PileTube& said, const PileTube& now) {
    Add("radius", "m", said.radius_m, now.radius_m, radii_);
    Add("mass", "kg", said.mass_kg, now.mass_kg, masses_);
  }
  void Tell(const Part& part) const {
    if (!tell_ || (radii_.empty() && masses_.empty())) return;
    const std::string both = radii_.empty() || masses_.empty() ? "" : ", ";
    tell_(source_ + ": part " + part.name + " replaces what the file says: " + radii_ + both +
          masses_);
  }

 private:
  static void Add(const char* what, const char* unit, double said, double now, std::string& text) {
    if (said == now || !text.empty()) return;  // One tube's figures stand for all.
    text = std::string(what) + " " + Number(said) + " " + unit + " by " + Number(now) + " " + unit;
  }

  const std::function<void(const std::string&)>& tell_;
  std::string source_, radii_, masses_;
};

Pile PileFromJson(const JsonView& document, const PileOverrides& overrides) {
  RequireSchema(document, "pile");
  Pile pile;
  pile.bin = BinFromJson(document.Field("bin"));
  pile.part = overrides.part ? LoadPart(*overrides.part) : PartFromJson(document.Field("part"));
  const JsonView tubes = document.Field("tubes");
  Replaced replaced(overrides, document.source());
  for (std::size_t i = 0; i < tubes.Size(); ++i) {
    const PileTube said = TubeFromJson(tubes.Item(i), pile.part);
    pile.tubes.push_back(said);
    if (!overrides.part) continue;
    ApplyPart(pile.part, pile.tubes.back());
    replaced.Compare(said, pile.tubes.back());
  }
  replaced.Tell(pile.part);
  if (const auto seed = document.Optional("seed")) {
    pile.seed = static_cast<std::uint64_t>(seed->AsInteger());
  }
  if (const auto settled = document.Optional("settled")) pile.settled = settled->AsBool();
  return pile;
}

/// Throws Error(kBadData) for coordinates that are millimetres if they are anything.
void RefuseMillimetres(const std::vector<TextTube>& tubes, const std::string& path) {
  double largest = 0.0;
  for (const TextTube& tube : tubes) {
    for (const Vector3& p : tube.centerline_N) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  constexpr double kSmallest_mm = 50.0, kLargest_mm = 3000.0;
  if (!(largest >= kSmallest_mm && largest <= kLargest_mm)) return;
  throw Error(ErrorKind::kBadData,
              path + ": x y z: the largest is " + Number(largest) +
                  ", allowed are -3 to 3 m of the bin's frame: is it in millimetres?\n"
                  "(tubetwin pile import FILE --units mm --out F.json reads it so)");
}

Pile PileFromText(const std::vector<TextTube>& tubes, const PileOverrides& overrides,
                  const std::string& path) {
  if (!overrides.unit_m) RefuseMillimetres(tubes, path);
  Pile pile;
  pile.part = LoadPart(overrides.part.value_or(kDefaultPart));
  pile.bin.size_m = kDefaultBinSize_m;
  Replaced replaced(overrides, path);
  for (const TextTube& text : tubes) {
    PileTube tube;
    tube.id = text.id;
    tube.centerline_N = text.centerline_N;
    ApplyPart(pile.part, tube);
    // The file's own radius stands unless the caller asked for a part.
    if (text.radius_m > 0) {
      PileTube said = tube;
      said.radius_m = text.radius_m;
      if (!overrides.part) tube.radius_m = text.radius_m;
      replaced.Compare(said, tube);
    }
    pile.tubes.push_back(tube);
  }
  replaced.Tell(pile.part);
  return pile;
}

/// Whether a first line names columns, or is a comment or Excel's "sep=" before such a line.
bool LooksLikeCsv(std::string_view line) {
  if (line[0] == '#' || line.starts_with("sep=")) return true;
  const bool letters =
      std::all_of(line.begin(), line.end(), [](unsigned char c) { return c >= 0x20 || c == '\t'; });
  return letters && line.find_first_of(",;\t ") != std::string_view::npos;
}

}  // namespace

Pile LoadPile(const std::string& path, const PileOverrides& overrides) {
  const std::string text = ReadFile(path, kMaxPileBytes);
  std::size_t start = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
  start = text.find_first_not_of(" \t\r\n", start);
  if (start == std::string::npos) {
    throw Error(ErrorKind::kBadData, path + ": is empty; a pile is needed");
  }
  const std::string_view first =
      std::string_view(text).substr(start, text.find_first_of("\r\n", start) - start);
  const std::string other = MistakenContent(std::string_view(text).substr(0, 64));
  Pile pile;
  if (first[0] == '{' || first[0] == '[') {
    if (overrides.unit_m) {
      throw Error(ErrorKind::kUsage,
                  path + ": --units is for CSV and text; pile.json is in metres");
    }
    const Json json = ParseJson(text, path);
    pile = PileFromJson(JsonView(json, path), overrides);
  } else if (first.find_first_not_of("0123456789. \t") == std::string_view::npos) {
    pile = PileFromText(ParsePileConfiguration(text, path, overrides.unit_m), overrides, path);
  } else if ((other.empty() || other == "is a pile in CSV") && LooksLikeCsv(first)) {
    pile = PileFromText(ParsePileCsv(text, path, overrides.unit_m), overrides, path);
  } else {
    throw Error(ErrorKind::kBadData,
                path + ": " +
                    (other.empty() ? "byte " + std::to_string(start) + ": '" +
                                         Printable(first.substr(0, 1)) + "' begins no pile"
                                   : "no pile: it " + other) +
                    "; allowed: JSON (tubetwin/pile/1), CSV with the header tube,index,x,y,z, or "
                    "the public set's tube_configurations text");
  }
  if (overrides.bin_size_m) pile.bin.size_m = *overrides.bin_size_m;
  ValidatePile(pile, path);
  RequireInBin(pile, path);
  return pile;
}

Json ToJson(const Pile& pile) {
  Json json;
  json["schema"] = "tubetwin/pile/1";
  json["bin"] = ToJson(pile.bin);
  json["part"] = PartToJson(pile.part);
  Json tubes = Json::array();
  for (const PileTube& tube : pile.tubes) {
    Json entry;
    entry["id"] = tube.id;
    entry["centerline_m"] = ToJson(tube.centerline_N);
    entry["radius_m"] = tube.radius_m;
    entry["mass_kg"] = tube.mass_kg;
    if (tube.rest_centerline_N) entry["rest_centerline_m"] = ToJson(*tube.rest_centerline_N);
    tubes.push_back(std::move(entry));
  }
  json["tubes"] = std::move(tubes);
  json["seed"] = pile.seed;
  json["settled"] = pile.settled;
  return json;
}

void SavePile(const Pile& pile, const std::string& path) { WriteJsonFile(ToJson(pile), path); }

}  // namespace tubetwin

#include <cmath>
#include <set>

#include "models/base/error.h"
#include "models/base/text.h"
#include "scenes/pile.h"

namespace tubetwin {
namespace {

constexpr double kClosestNodes_m = 0.001;
constexpr double kFarthest_m = 3.0;  // From the bin's floor centre, any coordinate.
constexpr std::size_t kMaxTubes = 200, kMaxNodes = 2000;

[[noreturn]] void Fail(const std::string& source, const std::string& problem) {
  throw Error(ErrorKind::kBadData, source + ": " + problem);
}

void CheckRange(const std::string& where, const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;  // False for NaN.
  Fail(where, std::string(name) + " is " + Number(value) + "; allowed: " + Number(low) + " to " +
                  Number(high));
}

void CheckLine(const std::string& where, const char* name, const Polyline& line, bool hose) {
  const std::size_t fewest = hose ? 3 : 2;
  if (line.size() < fewest || line.size() > kMaxNodes) {
    Fail(where, std::string(name) + " has " + std::to_string(line.size()) + " nodes; allowed: " +
                    std::to_string(fewest) + " to " + std::to_string(kMaxNodes));
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::string node = std::string(name) + "[" + std::to_string(i) + "]";
    for (int k = 0; k < 3; ++k) {
      if (std::abs(line[i][k]) <= kFarthest_m) continue;  // False for NaN.
      Fail(where, node + " is at " + Number(line[i][k]) +
                      " m; allowed: -3 to 3 in x, y and z of the bin's frame");
    }
    if (i == 0) continue;
    const double gap_m = (line[i] - line[i - 1]).norm();
    if (gap_m < kClosestNodes_m) {
      Fail(where, node + " is " + Number(gap_m) + " m from the node before; allowed: at least " +
                      Number(kClosestNodes_m));
    }
    if (i < 2) continue;
    const double cosine =
        (line[i] - line[i - 1]).normalized().dot((line[i - 1] - line[i - 2]).normalized());
    if (cosine < std::cos(Radians(175))) {
      Fail(where, node + " turns straight back; allowed: bends below 175 degrees at a node");
    }
  }
}

void CheckTube(const std::string& where, const PileTube& tube, const Pile& pile) {
  const bool hose = pile.part.is_hose();
  // The line first: where the mass follows from it, a bad line makes a bad mass.
  CheckLine(where, "centerline_m", tube.centerline_N, hose);
  CheckRange(where, "radius_m", tube.radius_m, 0.003, 0.04);
  CheckRange(where, "mass_kg", tube.mass_kg, 0.001, 5.0);
  const Vector3 size(pile.bin.size_m[0], pile.bin.size_m[1], pile.bin.size_m[2]);
  if (const double length_m = Length(tube.centerline_N); length_m > size.norm()) {
    Fail(where, "is " + Number(length_m) + " m long; allowed: up to the bin's diagonal, " +
                    Number(size.norm()) + " m");
  }
  if (!tube.rest_centerline_N) return;
  if (!hose) Fail(where, "has rest_centerline_m; allowed: hoses only, and the part is rigid");
  CheckLine(where, "rest_centerline_m", *tube.rest_centerline_N, hose);
  if (tube.rest_centerline_N->size() != tube.centerline_N.size()) {
    Fail(where, "rest_centerline_m has " + std::to_string(tube.rest_centerline_N->size()) +
                    " nodes; allowed: as many as centerline_m, " +
                    std::to_string(tube.centerline_N.size()));
  }
}

}  // namespace

void ValidatePile(const Pile& pile, const std::string& source) {
  if (pile.tubes.empty() || pile.tubes.size() > kMaxTubes) {
    Fail(source, "has " + std::to_string(pile.tubes.size()) + " tubes; allowed: 1 to " +
                     std::to_string(kMaxTubes));
  }
  std::set<int> ids;
  for (std::size_t i = 0; i < pile.tubes.size(); ++i) {
    const PileTube& tube = pile.tubes[i];
    const std::string where =
        source + ": tubes[" + std::to_string(i) + "] (id " + std::to_string(tube.id) + ")";
    if (!ids.insert(tube.id).second) Fail(where, "id comes twice; ids must differ");
    CheckTube(where, tube, pile);
  }
}

}  // namespace tubetwin

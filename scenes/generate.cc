#include <algorithm>
#include <cmath>
#include <optional>

#include "models/base/error.h"
#include "models/base/text.h"
#include "scenes/arrange.h"
#include "scenes/coverage.h"
#include "scenes/pile_scene.h"

namespace tubetwin {
namespace arrange {

PileTube MakeTube(const Part& part, int id, const Polyline& shape, const RigidTransform& X_NShape) {
  PileTube tube;
  tube.id = id;
  tube.centerline_N = Transformed(X_NShape, shape);
  tube.radius_m = part.radius_m;
  tube.mass_kg = part.mass_kg;
  if (part.is_hose()) tube.rest_centerline_N = shape;
  return tube;
}

Part SpecimenPart(const Order& order, int id) {
  const Specimen specimen = order.physics.SpecimenOf(id);
  Part part = order.part;
  part.radius_m *= specimen.radius;
  part.length_m *= specimen.length;
  part.mass_kg *= specimen.mass;
  return part;
}

Pile EmptyPile(const Order& order) {
  Pile pile;
  pile.bin = order.bin;
  pile.part = order.part;
  return pile;
}

}  // namespace arrange

namespace {

constexpr int kTries = 20;
// So many tries insist on the best result (nothing over the walls; threaded: no free tube).
constexpr int kStrictTries = 12;

// What is left to wish for, 0 for nothing; compares tries.
int Shortfall(const SettleResult& result, bool threaded) {
  if (result.status != SettleStatus::kSettled) return 1000;
  int shortfall = threaded ? CountFree(result.pile) : 0;
  for (const PileTube& tube : result.pile.tubes) {
    if (PlaceOf(tube, result.pile.bin) == Place::kOverhangs) shortfall += 100;
  }
  return shortfall;
}

void CheckOrder(const Part& part, const Bin& bin, int count, const std::string& arrangement) {
  const std::vector<std::string> known = {"dropped", "stirred", "threaded"};
  if (std::find(known.begin(), known.end(), arrangement) == known.end()) {
    throw Error(ErrorKind::kUsage, "arrangement is '" + arrangement + "'; allowed: " + Join(known) +
                                       "; nearest is '" + NearestName(arrangement, known) + "'");
  }
  if (count < 1 || count > 40) {
    throw Error(ErrorKind::kUsage,
                "count is " + std::to_string(count) + "; allowed: 1 to 40 tubes");
  }
  const double diagonal_m = Vector3(bin.size_m[0], bin.size_m[1], bin.size_m[2]).norm();
  if (part.length_m > diagonal_m) {
    throw Error(ErrorKind::kBadData, "part '" + part.name + "' is " + Number(part.length_m) +
                                         " m long; allowed: up to the bin's diagonal, " +
                                         Number(diagonal_m) + " m");
  }
}

}  // namespace

SettleResult GeneratePile(const Part& part, const Bin& bin, int count,
                          const std::string& arrangement, std::uint64_t seed,
                          const RoundPhysics& physics) {
  CheckOrder(part, bin, count, arrangement);
  const arrange::Order order{part, bin, count, physics};
  const bool threaded = arrangement == "threaded";
  const RandomStream stream(seed, 0, "pile " + arrangement);
  std::optional<SettleResult> best;
  int best_shortfall = 0;
  for (int i = 0; i < kTries; ++i) {
    const RandomStream sub = stream.Fork("try", static_cast<std::uint64_t>(i));
    SettleResult result = threaded                   ? arrange::Thread(order, sub)
                          : arrangement == "stirred" ? arrange::Stir(order, sub)
                                                     : arrange::Drop(order, sub);
    const int shortfall = Shortfall(result, threaded);
    if (!best || shortfall < best_shortfall) {
      best = std::move(result);
      best_shortfall = shortfall;
    }
    if (best_shortfall == 0 || (i + 1 >= kStrictTries && best_shortfall < 1000)) break;
  }
  best->pile.seed = seed;
  return *best;
}

}  // namespace tubetwin

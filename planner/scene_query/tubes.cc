#include "planner/scene_query/tubes.h"

#include <algorithm>

#include "models/base/error.h"

namespace tubetwin {

const PerceivedTube& TubeOf(const TubeScene& scene, int id) {
  const auto found = std::find_if(scene.tubes.begin(), scene.tubes.end(),
                                  [id](const PerceivedTube& tube) { return tube.id == id; });
  TT_CHECK(found != scene.tubes.end());
  return *found;
}

std::vector<Crossing> CoversOf(const TubeScene& scene, int id) {
  std::vector<Crossing> covers;
  for (const Crossing& crossing : scene.crossings) {
    if (crossing.under == id) covers.push_back(crossing);
  }
  std::stable_sort(covers.begin(), covers.end(), [](const Crossing& a, const Crossing& b) {
    return a.at_under_m < b.at_under_m;
  });
  return covers;
}

Vector3 ChordDirection(const PerceivedTube& tube) {
  const Vector3 chord = Flat(tube.centerline_N.back() - tube.centerline_N.front());
  return chord.norm() > 1e-3 ? chord.normalized() : Vector3(Vector3::UnitX());
}

}  // namespace tubetwin

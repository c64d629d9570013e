#pragma once

#include <string>
#include <vector>

#include "scenes/engine/mj_handles.h"
#include "scenes/pile.h"
#include "scenes/tube_body.h"

namespace tubetwin {

/// Spec of a pile by itself: bin, ground 0.1 m below its floor, tubes `tubeID`. World frame: N.
struct PileSpec {
  MjSpec spec;
  std::vector<TubeBody> tubes;  ///< In the pile's order; Bind after compiling.
};
PileSpec MakePileSpec(const Pile& pile, const RoundPhysics& physics,
                      const EngineOptions& engine = {});

/// A pile in its own physics world, for settling and generating. World frame: N. One thread.
class PileScene {
 public:
  PileScene(const Pile& pile, const RoundPhysics& physics, const EngineOptions& engine = {});
  /// From a spec that the caller added to.
  PileScene(PileSpec parts, const Pile& pile, const std::string& what);

  mjModel& model() { return *model_; }
  const mjModel& model() const { return *model_; }
  mjData& data() { return *data_; }
  const mjData& data() const { return *data_; }
  const std::vector<TubeBody>& tubes() const { return tubes_; }

  /// Recomputes what derives from the state; the readers below need it after stepping.
  void Refresh();
  /// The tubes as they lie now.
  Pile Current() const;
  /// Largest speed of any tube's node, m/s.
  double MaxSpeed() const;
  /// Top of the highest capsule, m over the floor; 0 without tubes.
  double Top() const;
  /// Takes over the motion of another scene whose tubes are the first of this one's.
  void CopyStateOfFirst(const PileScene& other);

 private:
  MjModel model_;
  MjData data_;
  std::vector<TubeBody> tubes_;
  Pile pile_;
};

/// Where a tube lies with respect to its bin.
enum class Place { kInside, kOverhangs, kOutside };
/// outside: centre of mass beyond the inner walls or below the floor; overhangs: some node beyond
/// the inner walls.
Place PlaceOf(const PileTube& tube, const Bin& bin);

/// Steps until nothing moves faster than 5 mm/s for 0.25 s, a tube has fallen out, or `limit_s` of
/// simulated time went by. `data` ends refreshed.
SettleResult StepUntilSettled(PileScene& scene, double limit_s);

}  // namespace tubetwin

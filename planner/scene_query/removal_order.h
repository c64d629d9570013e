#pragma once

#include <vector>

#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// What stands against taking a tube out, and what it brings, by the graph of who lies over whom.
struct RemovalRank {
  int tube = 0;
  int covers = 0;  ///< Crossings under other tubes.
  int blockers =
      0;  ///< Tubes over it, directly or through others: all that would have to go first.
  /// Other tubes that could then be taken one after the other, each free when its turn comes, and
  /// could not while this one lies there.
  int released = 0;
};

/// The scene's tubes in the order in which to try them: the fewest covers first, then the fewest
/// blockers (in a pile where tubes hold each other, those on top of it), then the most that are
/// released, then the scene's order. Crossings whose ids the scene does not have are left out.
std::vector<RemovalRank> RemovalOrder(const TubeScene& scene);

}  // namespace tubetwin

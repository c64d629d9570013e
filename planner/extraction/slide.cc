#include "planner/extraction/generators.h"
#include "planner/extraction/way_out.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {

MotionSet MakeSlides(const ExtractionInput& input) {
  MotionSet set;
  const TubeObstacles around(input.scene, input.tube);
  if (!around.Covered(Vector3::Zero())) return set;
  const Vector3 chord = ChordDirection(input.tube);
  AddWayOut(input, around, FindWayOut(input, around, input.tube, chord), "slide", "slide+", set);
  AddWayOut(input, around, FindWayOut(input, around, input.tube, -chord), "slide", "slide-", set);
  return set;
}

}  // namespace tubetwin

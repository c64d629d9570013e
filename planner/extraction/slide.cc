#include "planner/extraction/clearing_slide.h"
#include "planner/extraction/generators.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {

MotionSet MakeSlides(const ExtractionInput& input) {
  MotionSet set;
  const TubeObstacles around(input.scene, input.tube);
  if (!around.Covered(Vector3::Zero())) return set;
  const Vector3 chord = ChordDirection(input.tube);
  AddClearingSlide(input, around, FindClearingSlide(input, around, input.tube, chord), "slide",
                   "slide+", set);
  AddClearingSlide(input, around, FindClearingSlide(input, around, input.tube, -chord), "slide",
                   "slide-", set);
  return set;
}

}  // namespace tubetwin

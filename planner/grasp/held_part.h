#pragma once

#include "models/base/polyline.h"
#include "models/part.h"

namespace tubetwin {

/// How a held part bends and swings: each side of the grasp is a cantilever of the part's nominal
/// bending stiffness and mass per length, clamped between the pads (Euler and Bernoulli's beam).
struct HeldPart {
  double sag_m = 0.0;     ///< Of the longer side's end under its own weight; 0: rigid.
  double period_s = 0.0;  ///< Of the longer side's first mode; 0: rigid.
};

/// `line_E`: the part's centerline, frame E: origin between the pads, z out of the tool. The sides
/// are counted from the line's nearest point to E's z axis, by arc length. No line: as rigid.
HeldPart HeldPartOf(const Polyline& line_E, const Part& part);

/// The line as it hangs from an upright tool: every point is lower (along E's +z) by what a level
/// cantilever bends there, less where the way out to it is steep: a hanging stretch does not sag.
/// Rigid parts: unchanged.
Polyline Sagged(const Polyline& line_E, const Part& part);

}  // namespace tubetwin

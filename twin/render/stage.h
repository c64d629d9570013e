#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenes/engine/mj_handles.h"
#include "scenes/pile.h"
#include "twin/render/recording.h"

namespace tubetwin {

inline constexpr int kPictureWidth = 1280, kPictureHeight = 720;

/// Stills take what looks best; films what software rendering draws 30 times per second (their
/// edges are smoothed afterwards, see SmoothEdges).
enum class StageQuality { kStill, kFilm };

/// Floor, colours, lights and smoothness of all pictures; lights of the scene itself are
/// replaced. Shadows fall within `reach_m` of `centre_B`. Changes looks only, never bodies or
/// coordinates.
void DressStage(mjSpec& spec, const Vector3& centre_B, double reach_m, StageQuality quality);

/// A recorded cell with its visuals, dressed. `source` names the recording in errors. Throws
/// Error(kBadData) when the XML does not parse or compile or lacks a visual's body.
MjModel CompileStage(const Recording& recording, const std::string& source, StageQuality quality);

/// Red, green, blue of a pile's tube in its picture.
std::array<double, 3> PileColour(int tube);

/// The bin with its tubes at rest in `colours` (one for each), dressed. Frame B.
MjModel CompileStage(const Pile& pile, const std::vector<std::array<double, 3>>& colours);

}  // namespace tubetwin
